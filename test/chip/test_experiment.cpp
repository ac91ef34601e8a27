#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "refusal.h"
#include "three_pads.h"

// What commands do to a chip, and which are refused.

namespace dmf::chip {
namespace {

using namespace testing;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

}  // namespace
}  // namespace dmf::chip
