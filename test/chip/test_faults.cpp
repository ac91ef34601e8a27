#include <gtest/gtest.h>

#include <limits>

#include "chip/experiment.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
using Channels = std::vector<std::uint32_t>;

// Three pads, 60 degrees at 63 V and 110 at rest; the droplet stands on channel 0.
const char* const kScene = R"(
domain: {lower: [-20, -8, 0], upper: [20, 8, 10]}
wettability: {calibration: lan2016, rest_angle: 110}
chip:
  gap: 2
  grids: [{origin: [-12, 0], columns: 3, rows: 1, pitch: 12}]
  electrowetting: {reference_voltage: 63, reference_angle: 60, saturation_angle: 55, max_voltage: 80KEYS}
  sensing: {noise: 0, offset: 10 fF}
  rail: {RAIL}
droplets: [{center: [-12, 0, 0], radius: 4}]
)";

Scene fault_scene(const std::string& keys = "", const std::string& rail = "", const std::string& more = "") {
  std::string text = kScene;
  text.replace(text.find("KEYS"), 4, keys);
  text.replace(text.find("RAIL"), 4, rail);
  return parse_scene(text + more, "scene.yaml");
}

Experiment start(const std::string& keys = "", const std::string& rail = "") {
  return Experiment(fault_scene(keys, rail), {1, "auto"});
}

/// On at 63 V: these channels.
struct Actuated : Experiment {
  explicit Actuated(const Channels& channels, const std::string& keys = "", const std::string& rail = "")
      : Experiment(fault_scene(keys, rail), {1, "auto"}) {
    EXPECT_TRUE(apply(SetHv{63, 1000, true}).success);
    EXPECT_TRUE(apply(SetElectrodes{channels}).success);
  }
};

std::vector<double> voltages(const Experiment& chip) {
  std::vector<double> all;
  for (const ElectrodeState& electrode : chip.electrodes()) all.push_back(electrode.voltage);
  return all;
}

std::vector<std::string> halts(Experiment& chip) {
  std::vector<std::string> all;
  for (const BoardEvent& event : chip.take_board_events())
    if (event.kind == BoardEvent::Kind::halted) all.push_back(event.message);
  return all;
}

std::string state_of(const Experiment& chip) {
  engine::ObserveRequest request;
  request.hash = true;
  return chip.save() + std::to_string(*chip.observe(request)->state_hash);
}

void run(Experiment& chip, int steps) {
  for (int k = 0; k < steps; ++k) chip.step();
}

TEST(InjectedFaults, StuckOnFollowsTheRailAndNotItsChannel) {
  Actuated chip({1});
  ASSERT_TRUE(chip.apply(InjectFault{fault::kStuckOn, 2}).success);
  EXPECT_EQ(voltages(chip), (std::vector<double>{0, 63, 63}));
  EXPECT_FALSE(chip.electrodes()[2].on) << "nobody switched it on";
  EXPECT_NEAR(chip.commanded_angle(12, 0), 60, 1e-9);
  chip.apply(SetElectrodes{});
  EXPECT_EQ(voltages(chip), (std::vector<double>{0, 0, 63}));
  chip.apply(SetHv{40, 0, true});
  EXPECT_EQ(voltages(chip), (std::vector<double>{0, 0, 40}));
  chip.apply(SetHv{40, 0, false});
  EXPECT_EQ(voltages(chip), (std::vector<double>{0, 0, 0}));
}

TEST(InjectedFaults, StuckOffAndWeakPadsLackVoltage) {
  Actuated chip({0, 1, 2});
  chip.apply(InjectFault{fault::kStuckOff, 0});
  chip.apply(InjectFault{fault::kWeak, 1, 0.5});
  EXPECT_EQ(voltages(chip), (std::vector<double>{0, 31.5, 63}));
  EXPECT_TRUE(chip.electrodes()[0].on) << "the board does not know";
  chip.apply(SetElectrodeVoltages{{0, 1}, {20, 20}});
  EXPECT_EQ(voltages(chip), (std::vector<double>{0, 10, 63}));
  chip.apply(InjectFault{fault::kStuckOn, 0});
  EXPECT_EQ(voltages(chip)[0], 0) << "faults add up";
  chip.apply(InjectFault{fault::kClear, 0});
  chip.apply(SetElectrodes{{0, 1}});
  EXPECT_EQ(voltages(chip), (std::vector<double>{63, 31.5, 0}));
  chip.apply(InjectFault{fault::kClear, 0, 1, true});
  EXPECT_EQ(voltages(chip), (std::vector<double>{63, 63, 0}));
}

TEST(InjectedFaults, ADisconnectedChipHasNoVoltageAndSensesNothing) {
  Actuated chip({0, 1});
  run(chip, 50);
  EXPECT_GT(chip.sense().capacitance[0], 50e-15) << "the droplet's footprint of some 50 r_c^2";
  ASSERT_TRUE(chip.apply(InjectFault{fault::kDisconnected}).success);
  EXPECT_EQ(voltages(chip), (std::vector<double>{0, 0, 0}));
  for (const double value : chip.sense().capacitance) EXPECT_DOUBLE_EQ(value, 10e-15);
  chip.apply(InjectFault{fault::kClear, 0, 1, true});
  EXPECT_EQ(voltages(chip), (std::vector<double>{63, 63, 0}));
}

TEST(InjectedFaults, APadThatIsNotSwitchedSensesNothing) {
  Experiment chip = start();
  run(chip, 50);
  const double sound = chip.sense().capacitance[0];
  chip.apply(InjectFault{fault::kWeak, 0, 0.25});
  EXPECT_NEAR(chip.sense().capacitance[0] - 10e-15, (sound - 10e-15) / 4, 1e-20);
  chip.apply(InjectFault{fault::kStuckOff, 0});
  EXPECT_DOUBLE_EQ(chip.sense().capacitance[0], 10e-15);
}

TEST(DisabledChannels, NeverCarryAVoltage) {
  Actuated chip({0, 1});
  const Reply disabled = chip.apply(SetDisabledChannels{{1, 2}});
  EXPECT_EQ(disabled.disabled_channels, (Channels{1, 2}));
  EXPECT_EQ(voltages(chip), (std::vector<double>{63, 0, 0}));
  const Reply reply = chip.apply(SetElectrodes{{0, 1}});
  EXPECT_TRUE(reply.success);
  EXPECT_EQ(reply.applied_channels, (Channels{0}));
  EXPECT_TRUE(holds(reply.message, "channels on: 0; all others off; disabled and left out: 1"));
  EXPECT_TRUE(chip.electrodes()[1].disabled);
  EXPECT_TRUE(holds(chip.apply(SetElectrodeVoltages{{2}, {30}}).message, "disabled and left out: 2"));
  chip.apply(InjectFault{fault::kStuckOn, 1});
  EXPECT_EQ(voltages(chip), (std::vector<double>{63, 0, 0}));
  EXPECT_TRUE(chip.apply(SetDisabledChannels{}).disabled_channels.empty());
  EXPECT_EQ(voltages(chip)[2], 0) << "who frees a channel does not switch it on";
  EXPECT_EQ(voltages(chip)[1], 63) << "but a switch that is stuck";
  chip.apply(InjectFault{fault::kClear, 1});
  EXPECT_EQ(voltages(chip)[1], 0);
}

TEST(Halt, SwitchesEverythingOffUntilTheRailIsEnabledAgain) {
  Actuated chip({1});
  chip.apply(SetElectrodeVoltages{{0}, {20}});
  const Reply halt = chip.apply(Halt{});
  ASSERT_TRUE(halt.success);
  EXPECT_TRUE(halt.applied_channels.empty());
  EXPECT_EQ(voltages(chip), (std::vector<double>{0, 0, 0}));
  EXPECT_FALSE(chip.rail().enabled);
  EXPECT_EQ(chip.rail().halted, "it was commanded");
  EXPECT_EQ(halts(chip).size(), 1u);
  const Reply on = chip.apply(SetElectrodes{{1}});
  EXPECT_TRUE(holds(on.message, "it was halted: it was commanded"));
  EXPECT_EQ(on.applied_channels, (Channels{1}));
  const Reply driven = chip.apply(SetElectrodeVoltages{{0}, {20}});
  EXPECT_FALSE(driven.success) << driven.message;
  EXPECT_TRUE(holds(driven.message, "the rail is halted, allowed: set_hv"));
  chip.apply(SetHv{63, 0, false});
  EXPECT_FALSE(chip.rail().halted.empty());
  chip.apply(SetHv{63, 0, true});
  EXPECT_TRUE(chip.rail().halted.empty());
  EXPECT_EQ(voltages(chip), (std::vector<double>{0, 63, 0}));
}

TEST(Shorts, AnEnergisedOneHaltsTheRailWheneverItIsTriedAgain) {
  Actuated chip({1});
  chip.apply(InjectFault{fault::kShort, 2});
  EXPECT_TRUE(halts(chip).empty()) << "it carries nothing";
  const Reply on = chip.apply(SetElectrodes{{1, 2}});
  EXPECT_TRUE(on.success);
  EXPECT_TRUE(on.applied_channels.empty());
  EXPECT_TRUE(
      holds(on.message, "the rail was halted, set_hv enables it again: over-current: channel 2 is shorted"));
  EXPECT_EQ(halts(chip), (std::vector<std::string>{"over-current: channel 2 is shorted"}));
  EXPECT_EQ(chip.rail().halted, "over-current: channel 2 is shorted");
  EXPECT_EQ(voltages(chip), (std::vector<double>{0, 0, 0}));
  chip.apply(SetElectrodes{{2}});
  EXPECT_TRUE(holds(chip.apply(SetHv{63, 1000, true}).message, "the rail was halted"));
  EXPECT_FALSE(chip.rail().enabled);
  chip.apply(SetDisabledChannels{{2}});
  chip.apply(SetHv{63, 1000, true});
  EXPECT_TRUE(chip.rail().enabled) << "the cause is out of the way";
  chip.apply(SetElectrodes{{1, 2}});
  EXPECT_EQ(voltages(chip), (std::vector<double>{0, 63, 0}));
}

TEST(Shorts, AreDetectedWhileTheRailIsOff) {
  Actuated chip({1});
  chip.apply(InjectFault{fault::kShort, 2});
  chip.apply(InjectFault{fault::kShort, 0});
  const ShortsReport refused = chip.detect_shorts();
  EXPECT_FALSE(refused.success);
  EXPECT_TRUE(holds(refused.message, "the rail is enabled, allowed: a rail that is off"));
  chip.apply(SetHv{0, 0, false});
  const ShortsReport found = chip.detect_shorts();
  EXPECT_TRUE(found.success);
  EXPECT_EQ(found.channels, (Channels{0, 2}));
  EXPECT_EQ(found.message, "channels shorted: 0, 2");
  chip.apply(InjectFault{fault::kDisconnected});
  EXPECT_TRUE(chip.detect_shorts().channels.empty()) << "nothing is there to draw a current";
  chip.apply(InjectFault{fault::kClear, 0, 1, true});
  EXPECT_EQ(chip.detect_shorts().message, "no channel is shorted");
}

TEST(Breakdown, ShortsThePadAndHaltsTheRail) {
  Actuated chip({1}, ", breakdown_voltage: 70");
  EXPECT_TRUE(chip.rail().halted.empty());
  const Reply reply = chip.apply(SetHv{75, 1000, true});
  EXPECT_TRUE(reply.success);
  EXPECT_TRUE(holds(reply.message, "the dielectric of channel 1 broke down: 75 V, allowed: up to 70 V"));
  EXPECT_EQ(voltages(chip), (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(chip.detect_shorts().channels, (Channels{1}));
  chip.apply(SetElectrodes{{1}});
  EXPECT_TRUE(holds(chip.apply(SetHv{10, 1000, true}).message, "channel 1 is shorted")) << "from then on";
  chip.apply(InjectFault{fault::kClear, 1});
  chip.apply(SetElectrodes{{1}});
  chip.apply(SetHv{60, 1000, true});
  EXPECT_EQ(voltages(chip)[1], 60);
  chip.apply(SetElectrodeVoltages{{0}, {70}});
  EXPECT_TRUE(chip.rail().halted.empty()) << "up to the limit all is well";
  chip.apply(SetElectrodeVoltages{{0}, {70.5}});
  EXPECT_FALSE(chip.rail().halted.empty()) << "past the rail as well";
}

// c = 2 * 0.072 (cos 60 - cos 110) / 63^2 = 3.05494e-5 F/m^2. At 63 V and 1 kHz a pad with A r_c^2 of liquid
// takes 2 pi 1000 * 3.05494e-15 A * 63: 1.2093e-9 A for each r_c^2.
TEST(OverCurrent, IsTwoPiFrequencyTimesCapacitanceTimesVoltage) {
  Actuated free({0});
  run(free, 100);
  const double area = (free.sense().capacitance[0] - 10e-15) / 3.05494e-15;
  EXPECT_NEAR(area, 50, 15) << "half a sphere of radius 4";
  const double current = 1.2093e-9 * area;
  const auto limit = [](double ampere) { return "current_limit: " + std::to_string(ampere * 1e9) + " nA"; };
  Actuated below({0}, "", limit(2 * current)), above({0}, "", limit(0.5 * current));
  run(below, 100);
  EXPECT_TRUE(below.rail().halted.empty());
  run(above, 100);
  EXPECT_TRUE(holds(above.rail().halted, "over-current: "));
  EXPECT_EQ(voltages(above)[0], 0);
  EXPECT_EQ(halts(above).size(), 1u);
  EXPECT_EQ(above.commanded_angle(-12, 0), 110) << "the wall shows it";
  above.apply(SetElectrodes{{0}});
  above.apply(SetHv{63, 100, true});
  EXPECT_TRUE(above.rail().halted.empty()) << "a tenth of the frequency takes a tenth of the current";
  EXPECT_TRUE(holds(above.apply(SetHv{63, 2000, true}).message, "the rail was halted")) << "at once";
}

TEST(Faults, AreInHistoryAndInASavedRun) {
  const auto drive = [](Experiment& chip) {
    run(chip, 3);
    chip.apply(SetHv{75, 1000, true});
    chip.apply(InjectFault{fault::kWeak, 0, 1.0 / 3});
    chip.apply(SetDisabledChannels{{2}});
    chip.apply(InjectFault{fault::kStuckOn, 2});
    run(chip, 4);
    chip.apply(SetElectrodes{{0, 2}});
    run(chip, 5);
    chip.apply(SetElectrodes{{0, 1}});  // breaks channel 1
    chip.apply(SetElectrodes{{0}});
    run(chip, 2);
  };
  Experiment chip = start(", breakdown_voltage: 70");
  drive(chip);
  EXPECT_EQ(chip.detect_shorts().channels, (Channels{1}));
  Experiment loaded = start(", breakdown_voltage: 70");
  loaded.load(chip.save());
  EXPECT_TRUE(state_of(loaded) == state_of(chip));
  EXPECT_EQ(loaded.rail().halted, chip.rail().halted);
  Experiment again = start(", breakdown_voltage: 70");
  for (const auto& [step, command] : chip.history()) {
    while (again.steps() < step) again.step();
    ASSERT_TRUE(again.apply(command_from_json(to_json(command))).success);
  }
  while (again.steps() < chip.steps()) again.step();
  EXPECT_TRUE(state_of(again) == state_of(chip));
  for (Experiment* each : {&chip, &loaded}) {
    each->apply(InjectFault{fault::kClear, 1});
    each->apply(SetHv{60, 0, true});
    run(*each, 20);
  }
  EXPECT_TRUE(state_of(loaded) == state_of(chip));
  EXPECT_EQ(voltages(chip), (std::vector<double>{20, 0, 0}));
  chip.apply(Reset{});
  EXPECT_TRUE(chip.rail().halted.empty());
  EXPECT_TRUE(chip.detect_shorts().channels.empty());
}

TEST(Faults, MayBeOnASchedule) {
  Experiment chip(fault_scene("", "",
                              "schedule:\n"
                              "  - {at: 0.01, set_hv: {voltage: 63}}\n"
                              "  - {at: 0.02, inject_fault: {kind: stuck_on, channel: 1}}\n"
                              "  - {at: 0.03, set_disabled_channels: {channels: [0]}}\n"
                              "  - {at: 0.05, halt: {reason: enough}}\n"),
                  {1, "auto"});
  run(chip, 4);
  EXPECT_EQ(voltages(chip), (std::vector<double>{0, 63, 0}));
  EXPECT_TRUE(chip.electrodes()[0].disabled);
  run(chip, 2);
  EXPECT_EQ(chip.rail().halted, "enough");
  const auto events = chip.take_board_events();
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].message, "channel 1: stuck_on");
  EXPECT_EQ(events[0].step, 2u);
  EXPECT_EQ(events[1].step, 5u);
}

TEST(Faults, ThatAreWronglyDescribedAreRefusedAndChangeNothing) {
  Actuated chip({1});
  run(chip, 3);
  const std::string before = state_of(chip);
  const struct {
    Command command;
    const char* message;
  } cases[]{
      {InjectFault{"melted", 1},
       "kind `melted`: allowed stuck_on, stuck_off, short, weak, disconnected, clear"},
      {InjectFault{"", 1}, "kind ``: allowed"},
      {InjectFault{fault::kStuckOn, 9}, "channel 9 does not exist; channels are 0-2"},
      {InjectFault{fault::kClear, 9}, "channel 9 does not exist"},
      {InjectFault{fault::kWeak, 1, 1.5}, "strength 1.5: allowed 0 to 1"},
      {InjectFault{fault::kWeak, 1, -0.1}, "strength -0.1"},
      {InjectFault{fault::kWeak, 1, kNan}, "strength nan"},
      {InjectFault{fault::kShort, 1, 1, true}, "all with kind short: allowed with clear"},
      {SetDisabledChannels{{1, 1}}, "channels: 1 given twice"},
      {SetDisabledChannels{{0, 7}}, "channel 7 does not exist"},
  };
  for (const auto& [command, message] : cases) {
    const Reply reply = chip.apply(command);
    EXPECT_FALSE(reply.success) << to_json(command);
    EXPECT_TRUE(holds(reply.message, message));
    EXPECT_TRUE(state_of(chip) == before) << to_json(command);
  }
  EXPECT_TRUE(chip.take_board_events().empty());
  EXPECT_TRUE(holds(refusal([] { fault_scene("", "current_limit: -1 mA"); }),
                    "chip.rail.current_limit: -1 mA, allowed: at least 0 A"));
}

}  // namespace
}  // namespace dmf::chip
