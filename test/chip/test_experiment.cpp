#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "chip/experiment.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Three pads, a droplet small enough to simulate in a blink, and a row of commands of its own.
const char* const kScene = R"(
domain: {lower: [-20, -8, 0], upper: [20, 8, 10]}
wettability: {calibration: lan2016, rest_angle: 110}
chip:
  gap: 2
  grids: [{origin: [-12, 0], columns: 3, rows: 1, pitch: 12}]
  electrowetting: {reference_voltage: 63, reference_angle: 60, saturation_angle: 55, max_voltage: 80}
droplets: [{center: [-12, 0], radius: 2}]
patterns:
  walk:
    - {at: 0, set_hv: {voltage: 63 V}}
    - {at: 0, set_electrodes: {channels: [1]}}
    - {at: 0.05, set_electrodes: {channels: [2]}}
  crowd:
    - {at: 0, dispense_droplet: {x: -12, y: 0, radius: 2}}
  stop: []
)";

Scene scene(const std::string& more = "") { return parse_scene(kScene + more, "scene.yaml"); }

Experiment start(const std::string& more = "") {
  return Experiment(scene(more), engine::Execution{1, "auto"});
}

std::uint64_t hash(const Experiment& experiment) {
  engine::ObserveRequest request;
  request.hash = true;
  return experiment.observe(request)->state_hash.value();
}

void run(Experiment& experiment, int steps) {
  for (int i = 0; i < steps; ++i) experiment.step();
}

TEST(ShippedScenes, AllStart) {
  for (const char* name : {"droplet_gradient", "gradient_R5", "sessile", "electrode_line", "electrode_array",
                           "delivery_line", "two_plates"}) {
    const Scene shipped = load_scene(name);
    Experiment experiment(shipped, {});
    experiment.step();
    EXPECT_EQ(experiment.observe()->droplets.size(), shipped.droplets.size()) << name;
    EXPECT_EQ(experiment.observe()->microparticles.size(), shipped.microparticles.size()) << name;
    EXPECT_EQ(experiment.observe()->vapour_beads, 0u) << name;
  }
}

/// Everything of an experiment that a refused command must leave as it is.
std::string state_of(const Experiment& experiment) {
  return experiment.save() + std::to_string(hash(experiment));
}

TEST(Pads, VoltageIsTheRailsWhereTheChannelIsOn) {
  Experiment chip = start();
  const Reply on = chip.apply(SetElectrodes{{1}});
  EXPECT_EQ(on.applied_channels, (std::vector<std::uint32_t>{1}));
  EXPECT_TRUE(holds(on.message, "the rail is disabled"));
  EXPECT_EQ(chip.electrodes()[1].voltage, 0);
  ASSERT_TRUE(chip.apply(SetHv{63, 1000, true}).success);
  EXPECT_EQ(chip.electrodes()[0].voltage, 0);
  EXPECT_EQ(chip.electrodes()[1].voltage, 63);
  EXPECT_NEAR(chip.electrodes()[1].contact_angle, 60, 1e-9);
  EXPECT_EQ(chip.electrodes()[0].contact_angle, 110);
  ASSERT_TRUE(chip.apply(SetHv{63, 1000, false}).success);
  EXPECT_EQ(chip.electrodes()[1].voltage, 0);
  EXPECT_TRUE(chip.electrodes()[1].on) << "switched to a rail that is off";
}

TEST(Pads, OwnVoltageHoldsUntilTheNextSetElectrodes) {
  Experiment chip = start();
  chip.apply(SetHv{63, 0, true});
  chip.apply(SetElectrodes{{1}});
  ASSERT_TRUE(chip.apply(SetElectrodeVoltages{{0, 1}, {20, 0}}).success);
  ASSERT_TRUE(chip.apply(SetElectrodeVoltages{{2}, {30}}).success);
  chip.apply(SetHv{40, 0, true});
  EXPECT_EQ(chip.electrodes()[0].voltage, 20);
  EXPECT_EQ(chip.electrodes()[1].voltage, 0) << "its own 0 V, not the rail's";
  EXPECT_EQ(chip.electrodes()[2].voltage, 30);
  chip.apply(SetElectrodes{{1}});
  EXPECT_EQ(chip.electrodes()[0].voltage, 0);
  EXPECT_EQ(chip.electrodes()[1].voltage, 40);
  EXPECT_EQ(chip.electrodes()[2].voltage, 0);
}

TEST(Plate, AngleRampsAcrossTheGapBetweenPads) {
  Experiment chip = start();
  chip.apply(SetHv{63, 0, true});
  chip.apply(SetElectrodes{{1}});
  EXPECT_NEAR(chip.commanded_angle(0, 0), 60, 1e-9);
  EXPECT_NEAR(chip.commanded_angle(6, 0), 85, 1e-9) << "halfway to a pad at rest";
  EXPECT_NEAR(chip.commanded_angle(0, 6), 85, 1e-9) << "halfway to the bare plate";
  EXPECT_EQ(chip.commanded_angle(12, 0), 110);
  EXPECT_EQ(chip.commanded_angle(0, 7.5), 110);
}

TEST(Plate, ProgramOverridesTheVoltagesUntilTheNextOfThem) {
  for (const Command& next : {Command(SetElectrodes{{1}}), Command(SetHv{63, 0, true}),
                              Command(SetElectrodeVoltages{{0}, {0}}), Command(LoadPattern{"walk"})}) {
    Experiment chip = start();
    chip.apply(SetHv{63, 0, true});
    chip.apply(SetElectrodes{{1}});
    const double r_c = chip.scene().units.length_m;
    ASSERT_TRUE(chip.apply(SetWettability{{-10 * r_c, 10 * r_c}, {140, 60}}).success);
    EXPECT_NEAR(chip.commanded_angle(5, 0), 80, 1e-9);
    EXPECT_EQ(chip.commanded_angle(-15, 3), 140) << "constant beyond the ends";
    EXPECT_EQ(chip.commanded_angle(15, 3), 60);
    EXPECT_NEAR(chip.electrodes()[1].contact_angle, 100, 1e-9);
    EXPECT_EQ(chip.electrodes()[1].voltage, 63) << "a program leaves the voltages alone";
    ASSERT_TRUE(chip.apply(next).success);
    EXPECT_NEAR(chip.commanded_angle(0, 0), 60, 1e-9) << name_of(next);
  }
}

TEST(Plate, SceneMayStartWithAProgram) {
  const Experiment chip(
      parse_scene("domain: {lower: [0, 0, 0], upper: [20, 8, 10]}\n"
                  "wettability: {program: {positions: [0, 20], contact_angles: [140, 100]}}\n",
                  "s.yaml"),
      {});
  EXPECT_NEAR(chip.commanded_angle(10, 4), 120, 1e-9);
}

/// A sphere at rest on the plate at (x, 0), m.
AddMicroparticle body(double x, double radius) {
  AddMicroparticle command;
  command.x = x;
  command.radius = radius;
  return command;
}

/// A sound one but for one member.
template <typename Member, typename Value>
AddMicroparticle with(Member AddMicroparticle::*member, Value value) {
  AddMicroparticle command = body(0, 1e-5);
  command.*member = value;
  return command;
}

TEST(RefusedCommands, SayWhatIsWrongAndChangeNotOneBit) {
  Experiment chip = start();
  chip.apply(SetHv{63, 0, true});
  chip.apply(SetElectrodes{{0}});
  run(chip, 30);
  const std::string before = state_of(chip);
  const auto history = chip.history().size();
  const struct {
    Command command;
    const char* message;
  } cases[]{
      {SetElectrodes{{9}}, "channel 9 does not exist; channels are 0-2"},
      {SetElectrodes{{1, 2, 1}}, "channels: 1 given twice"},
      {SetHv{120, 0, true}, "voltage 120 V: allowed 0 to 80 V"},
      {SetHv{-1, 0, false}, "voltage -1 V: allowed 0 to 80 V"},
      {SetHv{kNan, 0, true}, "voltage nan V: allowed 0 to 80 V"},
      {SetHv{kInfinity, 0, true}, "voltage inf V: allowed 0 to 80 V"},
      {SetHv{10, -1, true}, "frequency -1 Hz: allowed 0 to 100000 Hz"},
      {SetHv{10, kNan, true}, "frequency nan Hz"},
      {SetHv{10, 1e6, true}, "frequency 1000000 Hz"},
      {SetElectrodeVoltages{{0, 1}, {5}}, "channels: 2 given but 1 voltages"},
      {SetElectrodeVoltages{{}, {}}, "channels: none given"},
      {SetElectrodeVoltages{{0, 0}, {5, 5}}, "channels: 0 given twice"},
      {SetElectrodeVoltages{{0, 7}, {5, kNan}},
       "channel 7 does not exist; channels are 0-2; voltage nan V: allowed"},
      {SetWettability{{0, 1e-5}, {100, 90, 80}}, "positions: 2 given but 3 contact angles"},
      {SetWettability{{}, {}}, "positions: none given"},
      {SetWettability{{1e-5, 0}, {100, 90}}, "positions: 0 m after 1e-05 m, allowed: rising"},
      {SetWettability{{1e-5, 1e-5}, {100, 90}}, "allowed: rising"},
      {SetWettability{{0, 1}, {100, 90}},
       "position 1000 mm (100000 r_c): allowed -0.2 mm (-20 r_c) to 0.2 mm"},
      {SetWettability{{kNan, 0}, {100, 90}}, "position nan mm"},
      {SetWettability{{0, 1e-5}, {100, 10}}, "contact angle 10 degrees: allowed 40 to 150 degrees"},
      {SetWettability{{0, 1e-5}, {kInfinity, 100}}, "contact angle inf degrees"},
      {LoadPattern{"jump"}, "pattern `jump` does not exist; patterns are crowd, stop, walk"},
      {DispenseDroplet{-1.2e-4, 0, 3e-14}, "occupied"},
      {DispenseDroplet{1, 0, 3e-14}, "centre's x 1000 mm (100000 r_c): allowed"},
      {DispenseDroplet{0, 7e-5, 3e-14}, "centre's y 0.07 mm (7 r_c): allowed"},
      {DispenseDroplet{0, 0, 1e-9}, "radius 0.62035 mm (62.035 r_c): allowed up to"},
      {DispenseDroplet{0, 0, 1e-20}, "beads, allowed"},
      {DispenseDroplet{0, 0, 0}, "volume 0 m^3: allowed more than 0"},
      {DispenseDroplet{0, 0, -1e-14}, "volume -1e-14 m^3"},
      {DispenseDroplet{0, 0, kNan}, "volume nan m^3"},
      {DispenseDroplet{kNan, kInfinity, 1e-14}, "x nan m: allowed: a finite number; y inf m"},
      {Remove{42}, "droplet 42 does not exist"},
      {Remove{0}, "droplet 0 and microparticle 0: allowed the id of one"},
      {Remove{1, 1}, "droplet 1 and microparticle 1: allowed the id of one"},
      {body(kNan, 1e-5), "x nan m: allowed: a finite number"},
      {body(0, 0), "radius 0 m: allowed more than 0 m"},
      {body(0, kInfinity), "radius inf m"},
      {with(&AddMicroparticle::height, -1e-6), "height -1e-06 m: allowed 0 m or more"},
      {with(&AddMicroparticle::mass, -1e-13), "mass -1e-13 kg: allowed more than 0 kg"},
      {with(&AddMicroparticle::contact_angle_deg, 20.0), "contact angle: 20 degrees, allowed: "},
      {body(-1.2e-4, 1e-5), "to the liquid"},
      {body(1.95e-4, 1e-5), "center's x 19.5, allowed: -19 to 19"},
      {body(0, 3e-4), "allowed: 0.5 to 20"},
      {with(&AddMicroparticle::attraction, 5.0), "attraction: 5, allowed"},
      {with(&AddMicroparticle::attraction, kNan), "attraction: nan, allowed"},
      {with(&AddMicroparticle::static_friction, -0.1), "static_friction: -0.1, allowed"},
      {with(&AddMicroparticle::kinetic_friction, 0.3), "kinetic_friction: 0.3, allowed"},
      {with(&AddMicroparticle::rolling_friction, kInfinity), "rolling_friction: inf, allowed"},
      {with(&AddMicroparticle::beads, 613), "beads: 613, allowed"},
      {Remove{0, 42}, "microparticle 42 does not exist"},
      {SetBodyForces{{1e12, 0, 0}, {}}, "gravity"},
      {SetBodyForces{{0, kNan, 0}, {kInfinity, 0, 0}},
       "gravity's y nan m/s^2: allowed: a finite number; magnetic force's x inf N"},
  };
  for (const auto& [command, message] : cases) {
    const Reply reply = chip.apply(command);
    EXPECT_FALSE(reply.success) << to_json(command);
    EXPECT_TRUE(holds(reply.message, message));
    EXPECT_EQ(reply.step, 30u);
    ASSERT_TRUE(state_of(chip) == before) << to_json(command);
  }
  EXPECT_EQ(chip.history().size(), history);
}

TEST(RefusedCommands, MoreBeadsThanAllowedAreRefused) {
  Experiment chip = start("max_beads: 300\n");
  const std::string before = state_of(chip);
  const Reply reply = chip.apply(DispenseDroplet{0, 0, 3.4e-14});
  EXPECT_FALSE(reply.success);
  EXPECT_TRUE(holds(reply.message, "max_beads"));
  EXPECT_TRUE(state_of(chip) == before);
}

TEST(Droplets, AreDispensedAndRemoved) {
  Experiment chip = start();
  ASSERT_EQ(chip.observe()->droplets.size(), 1u);
  const Reply dispensed = chip.apply(DispenseDroplet{0, 0, 3.4e-14});
  ASSERT_TRUE(dispensed.success) << dispensed.message;
  run(chip, 40);
  ASSERT_EQ(chip.observe()->droplets.size(), 2u);
  const auto droplet = chip.observe()->droplets[1];
  EXPECT_NEAR(droplet.centroid.x(), 0, 0.3);
  EXPECT_NEAR(droplet.volume, 34, 6) << "3.4e-14 m^3 where r_c is 10 um";
  ASSERT_TRUE(chip.apply(Remove{droplet.id}).success);
  run(chip, 20);
  EXPECT_EQ(chip.observe()->droplets.size(), 1u);
}

TEST(Microparticles, AreAddedAndRemoved) {
  Experiment chip = start();
  const Reply added = chip.apply(body(0, 1e-5));
  ASSERT_TRUE(added.success) << added.message;
  EXPECT_EQ(added.microparticle, 1u);
  EXPECT_EQ(added.message, "microparticle 1 added");
  EXPECT_FALSE(chip.apply(body(0.5e-5, 1e-5)).success) << "the place is taken";
  EXPECT_EQ(chip.apply(with(&AddMicroparticle::height, 3e-5)).microparticle, 2u) << "above it there is room";
  run(chip, 20);
  const auto seen = chip.observe()->microparticles;
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_NEAR(seen[0].position.z(), 1, 0.02) << "rests on the plate";
  EXPECT_NEAR(seen[1].position.z(), 4, 0.02);
  EXPECT_EQ(seen[0].beads, 612u);
  EXPECT_NEAR(seen[0].mass, 612, 1e-9);
  ASSERT_TRUE(chip.apply(Remove{0, 1}).success);
  EXPECT_TRUE(holds(chip.apply(Remove{0, 1}).message, "microparticle 1 does not exist"));
  ASSERT_EQ(chip.observe()->microparticles.size(), 1u);
  EXPECT_EQ(chip.apply(body(0, 1e-5)).microparticle, 3u) << "no id is given twice";
  EXPECT_NO_THROW(run(chip, 20));
}

TEST(Microparticles, OfASceneAreThereFromTheStart) {
  const std::string schedule =
      "microparticles: [{center: [2, 0], radius: 1, contact_angle: 109}]\n"
      "body_forces: {gravity: [0, 0, -0.01]}\n"
      "schedule:\n"
      "  - {at: 0.02, add_microparticle: {x: 80 um, y: 0, radius: 1, magnetic: true}}\n"
      "  - {at: 0.04, set_body_forces: {magnetic: [1 nN, 0, 0]}}\n"
      "  - {at: 0.06, remove: {microparticle: 1}}\n";
  Experiment chip = start(schedule);
  ASSERT_EQ(chip.observe()->microparticles.size(), 1u);
  EXPECT_DOUBLE_EQ(chip.observe()->microparticles[0].attraction,
                   load_microparticle_curve(chip.scene()).attraction(109));
  EXPECT_EQ(chip.simulation().body_forces().gravity.z(), -0.01);
  run(chip, 3);
  ASSERT_EQ(chip.observe()->microparticles.size(), 2u);
  EXPECT_NEAR(chip.observe()->microparticles[1].position.x(), 8, 1e-3);
  run(chip, 4);
  ASSERT_EQ(chip.observe()->microparticles.size(), 1u);
  EXPECT_EQ(chip.observe()->microparticles[0].id, 2u);
  EXPECT_NEAR(chip.simulation().body_forces().magnetic.x() * chip.scene().units.force_N(), 1e-9, 1e-20);
  EXPECT_TRUE(chip.simulation().body_forces().gravity.isZero(0)) << "all of it is set anew";
  const std::uint64_t later = hash(chip);
  ASSERT_TRUE(chip.apply(Reset{}).success);
  EXPECT_EQ(chip.simulation().body_forces().gravity.z(), -0.01);
  run(chip, 7);
  EXPECT_EQ(hash(chip), later);
  EXPECT_TRUE(holds(refusal([] { start("microparticles: [{center: [-12, 0], radius: 1}]\n"); }),
                    "scene.yaml: microparticles[0]: microparticle at (-12"));
}

TEST(BodyForces, AMagnetMovesOnlyWhatIsMagnetic) {
  Experiment chip = start();
  AddMicroparticle ball = with(&AddMicroparticle::magnetic, true);
  ball.static_friction = ball.rolling_friction = 0;
  ball.height = 2e-5;
  ASSERT_TRUE(chip.apply(ball).success);
  ball.magnetic = false;
  ball.x = 6e-5;
  ASSERT_TRUE(chip.apply(ball).success);
  EXPECT_TRUE(holds(chip.apply(SetBodyForces{{}, {0, 0, 1}}).message, "magnetic")) << "1 N throws it off";
  const engine::Units& units = chip.scene().units;
  ASSERT_TRUE(chip.apply(SetBodyForces{{}, {6.12 * units.force_N(), 0, 0}}).success);
  run(chip, 100);
  const auto seen = chip.observe()->microparticles;
  EXPECT_NEAR(seen.at(0).velocity.x(), 0.01, 1e-4) << "6.12 k_BT / r_c on 612 beads for one tau";
  EXPECT_NEAR(seen.at(1).velocity.x(), 0, 1e-9);
  ASSERT_TRUE(chip.apply(SetBodyForces{}).success);
  run(chip, 10);
  EXPECT_NEAR(chip.observe()->microparticles.at(0).velocity.x(), 0.01, 1e-4) << "switched off";
}

TEST(Droplets, ChannelsUnderAFootprintAreThoseItOverlaps) {
  const Experiment chip = start();
  engine::DropletObservation droplet;
  EXPECT_TRUE(chip.channels_under(droplet).empty()) << "a droplet in the air";
  droplet.footprint = {{-8, -1}, {-4, -1}, {-4, 1}, {-8, 1}};
  EXPECT_EQ(chip.channels_under(droplet), (std::vector<std::uint32_t>{0, 1}));
  droplet.footprint = {{-6.9f, -1}, {-5.1f, -1}, {-6, 1}};
  EXPECT_TRUE(chip.channels_under(droplet).empty()) << "in the gap";
}

TEST(Schedule, TakesEffectAtItsStepAfterSettling) {
  Experiment chip = start(
      "settle_time: 0.1\n"
      "schedule:\n"
      "  - {at: 0, set_hv: {voltage: 50}}\n"
      "  - {at: 0.05, set_electrodes: {channels: [2]}}\n");
  run(chip, 10);
  EXPECT_FALSE(chip.rail().enabled) << "due before the step that follows";
  run(chip, 1);
  EXPECT_EQ(chip.rail().voltage, 50);
  run(chip, 4);
  EXPECT_FALSE(chip.electrodes()[2].on);
  run(chip, 1);
  EXPECT_TRUE(chip.electrodes()[2].on);
  const auto replies = chip.take_scheduled_replies();
  ASSERT_EQ(replies.size(), 2u);
  EXPECT_EQ(replies[0].reply.step, 10u);
  EXPECT_EQ(replies[1].reply.step, 15u);
  EXPECT_TRUE(chip.history().empty()) << "it follows from the scene";
}

TEST(Pattern, IsTimedFromWhenItWasLoaded) {
  Experiment chip = start();
  run(chip, 7);
  ASSERT_TRUE(chip.apply(LoadPattern{"walk"}).success);
  EXPECT_TRUE(chip.electrodes()[1].on) << "its time 0 is now";
  run(chip, 5);
  EXPECT_FALSE(chip.electrodes()[2].on);
  run(chip, 1);
  EXPECT_TRUE(chip.electrodes()[2].on);
  ASSERT_EQ(chip.history().size(), 1u);
  EXPECT_EQ(chip.history()[0].step, 7u);
}

TEST(Pattern, AnotherOneTakesItsPlace) {
  Experiment chip = start();
  chip.apply(LoadPattern{"walk"});
  chip.apply(LoadPattern{"stop"});
  run(chip, 10);
  EXPECT_TRUE(chip.electrodes()[1].on);
  EXPECT_FALSE(chip.electrodes()[2].on);
}

TEST(Pattern, ACommandThatIsRefusedIsSkippedAndTold) {
  Experiment chip = start();
  const std::uint64_t before = hash(chip);
  ASSERT_TRUE(chip.apply(LoadPattern{"crowd"}).success);
  EXPECT_EQ(hash(chip), before);
  const auto replies = chip.take_scheduled_replies();
  ASSERT_EQ(replies.size(), 1u);
  EXPECT_FALSE(replies[0].reply.success);
  EXPECT_TRUE(holds(replies[0].reply.message, "occupied"));
}

/// Some steps with commands between them.
void drive(Experiment& chip) {
  run(chip, 5);
  chip.apply(SetHv{63, 1000, true});
  chip.apply(SetElectrodes{{7}});  // refused
  chip.apply(LoadPattern{"walk"});
  run(chip, 9);
  chip.apply(DispenseDroplet{1e-4, 0, 3.4e-14});
  chip.apply(with(&AddMicroparticle::contact_angle_deg, 109.0));
  run(chip, 10);
  chip.apply(SetBodyForces{{0, 0, -1e3 / 3}, {}});
  run(chip, 20);
}

TEST(History, AndSceneGiveTheSameRunAgain) {
  const std::string schedule =
      "schedule: [{at: 0.2, set_electrode_voltages: {channels: [0], voltages: [30]}}]\n";
  Experiment first = start(schedule);
  drive(first);
  Experiment again = start(schedule);
  for (const auto& [step, command] : first.history()) {
    while (again.steps() < step) again.step();
    ASSERT_TRUE(again.apply(command_from_json(to_json(command))).success);
  }
  while (again.steps() < first.steps()) again.step();
  EXPECT_EQ(hash(again), hash(first));
  EXPECT_TRUE(state_of(again) == state_of(first));
}

TEST(Reset, StartsTheSceneOverAndForgetsTheCommands) {
  Experiment chip = start("schedule: [{at: 0.03, set_hv: {voltage: 20}}]\n");
  const std::uint64_t at_start = hash(chip);
  drive(chip);
  const std::uint64_t at_end = hash(chip);
  const Reply reply = chip.apply(Reset{});
  EXPECT_TRUE(reply.success);
  EXPECT_EQ(reply.step, 0u);
  EXPECT_EQ(chip.steps(), 0u);
  EXPECT_EQ(hash(chip), at_start);
  EXPECT_FALSE(chip.rail().enabled);
  ASSERT_EQ(chip.history().size(), 1u);
  EXPECT_EQ(name_of(chip.history()[0].command), "reset");
  drive(chip);
  EXPECT_EQ(hash(chip), at_end);
}

TEST(Seed, IsTheScenesUnlessAnotherIsGiven) {
  Experiment one(scene("seed: 5\n"), {1, "auto"});
  Experiment two(scene(), {1, "auto"}, 5);
  Experiment other(scene(), {1, "auto"}, 6);
  for (Experiment* chip : {&one, &two, &other}) run(*chip, 10);
  EXPECT_EQ(hash(one), hash(two));
  EXPECT_NE(hash(one), hash(other));
  other.apply(Reset{});
  EXPECT_EQ(other.simulation().parameters().seed, 6u);
}

TEST(SavedRun, GoesOnWithTheSameBits) {
  Experiment chip(scene(), {1, "auto"}, 9);
  run(chip, 5);
  chip.apply(SetElectrodeVoltages{{0}, {12.345}});
  chip.apply(LoadPattern{"walk"});
  run(chip, 3);
  chip.apply(SetWettability{{-1e-4 / 3, 1e-4 / 3}, {120, 100}});
  const std::string saved = chip.save();
  Experiment other = start();
  run(other, 2);
  other.load(saved);
  EXPECT_EQ(other.steps(), 8u);
  EXPECT_TRUE(state_of(other) == state_of(chip));
  for (Experiment* each : {&chip, &other}) drive(*each);
  EXPECT_TRUE(state_of(other) == state_of(chip));
  EXPECT_EQ(other.history().size(), chip.history().size());
}

TEST(SavedRun, OfAnotherSceneOrDamagedIsRefusedUnchanged) {
  Experiment chip = start();
  run(chip, 3);
  const std::string saved = chip.save();
  run(chip, 3);
  const std::string before = state_of(chip);
  for (const std::string& bytes : {std::string(), std::string("{}\n"), saved.substr(0, saved.size() / 2),
                                   saved + "x", "x" + saved, saved.substr(0, 40), std::string("[1]\n")}) {
    EXPECT_THROW(chip.load(bytes), engine::InvalidInput);
    EXPECT_TRUE(state_of(chip) == before);
  }
  Experiment other(parse_scene(kScene, "other.yaml"), {1, "auto"});
  EXPECT_EQ(refusal([&] { other.load(saved); }), "saved run: of scene scene, allowed: other");
}

TEST(Fault, StopsTheRunUntilReset) {
  // Repulsion far beyond what the time step can follow.
  Experiment chip = start("liquid: {repulsion: 500, random_amplitude: 50}\ntime_step: 0.1\n");
  EXPECT_THROW(run(chip, 5000), engine::Instability);
  ASSERT_FALSE(chip.fault().empty());
  const std::uint64_t steps = chip.steps();
  EXPECT_THROW(chip.step(), engine::Instability);
  const Reply refused = chip.apply(SetElectrodes{{1}});
  EXPECT_FALSE(refused.success);
  EXPECT_TRUE(holds(refused.message, chip.fault()));
  EXPECT_TRUE(holds(refused.message, "allowed: reset"));
  EXPECT_EQ(chip.steps(), steps);
  EXPECT_TRUE(chip.apply(Reset{}).success);
  EXPECT_TRUE(chip.fault().empty());
  EXPECT_EQ(chip.steps(), 0u);
  EXPECT_NO_THROW(chip.step());
}

}  // namespace
}  // namespace dmf::chip
