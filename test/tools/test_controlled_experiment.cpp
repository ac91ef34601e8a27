#include <gtest/gtest.h>

#include <map>

#include "chip/configuration.h"
#include "refusal.h"
#include "tools/controlled_experiment.h"

namespace dmf::tools {
namespace {

/// Four coarse electrodes in a line and a droplet on the first.
const char* const kLine = R"(
integrator: baoab
time_step: 0.03
domain: {lower: [-14, -6, 0], upper: [14, 6, 12]}
wettability: {rest_angle: 110}
chip:
  gap: 1
  grids: [{origin: [-9, 0], columns: 4, rows: 1, pitch: 6}]
  electrowetting: {reference_voltage: 63, reference_angle: 60, saturation_angle: 55}
droplets: [{center: [-9, 0], radius: 3.5}]
)";

controller::Protocol move_to(ControlledExperiment& controlled, int target) {
  return controller::parse_protocol(
      "voltage: 63 V\nlimits: {retries: 0, step_timeout: 3 s}\nsteps: [{move: {channel: 0, to: " +
          std::to_string(target) + "}}]\n",
      "move", controlled.coordinator().layout(), 80);
}

double droplet_x(ControlledExperiment& controlled) {
  return controlled.experiment().observe()->droplets.at(0).centroid.x();
}

TEST(ControlledExperiment, ADropletIsMovedByWhatItsCapacitanceTells) {
  ControlledExperiment controlled(chip::parse_scene(kLine, "line"), {1, "auto"}, 1);
  controller::ProtocolRun run(move_to(controlled, 2), controlled.coordinator());
  controlled.finish(run, 20);
  EXPECT_EQ(run.status().state, controller::State::succeeded) << run.status().text;
  EXPECT_NEAR(droplet_x(controlled), 3, 2.5) << "on the third electrode, 5 r_c wide";
  EXPECT_LT(controlled.time(), 10);
}

TEST(ControlledExperiment, FaultsOfTheChipAreNamedFromOutside) {
  const std::map<std::string, chip::Command> faults{
      {"electrode 1 does not answer", chip::InjectFault{"stuck_off", 1, 0, false}},
      {"electrode 1 is disabled", chip::SetDisabledChannels{{1}}},
      {"does not", chip::InjectFault{"weak", 1, 0.1, false}}};
  for (const auto& [name, fault] : faults) {
    ControlledExperiment controlled(chip::parse_scene(kLine, "line"), {1, "auto"}, 1);
    ASSERT_TRUE(controlled.experiment().apply(fault).success);
    controller::ProtocolRun run(move_to(controlled, 2), controlled.coordinator());
    controlled.finish(run, 20);
    EXPECT_EQ(run.status().state, controller::State::failed);
    EXPECT_TRUE(holds(run.status().text, name));
    EXPECT_LT(droplet_x(controlled), -6) << "where it was";
  }
}

TEST(ControlledExperiment, AHaltOfTheBoardEndsAProtocolByName) {
  ControlledExperiment controlled(chip::parse_scene(kLine, "line"), {1, "auto"}, 1);
  controller::ProtocolRun run(move_to(controlled, 3), controlled.coordinator());
  for (int k = 0; k < 20; ++k) controlled.advance(&run);
  controlled.experiment().apply(chip::Halt{"for a test"});
  controlled.finish(run, 1);
  EXPECT_TRUE(holds(run.status().text, "the high-voltage rail is off"));
}

TEST(ControlledExperiment, AShortedPadHaltsTheRailAndTheProtocolSaysSo) {
  ControlledExperiment controlled(chip::parse_scene(kLine, "line"), {1, "auto"}, 1);
  ASSERT_TRUE(controlled.experiment().apply(chip::InjectFault{"short", 1, 0, false}).success);
  controller::ProtocolRun run(move_to(controlled, 2), controlled.coordinator());
  controlled.finish(run, 20);
  EXPECT_EQ(run.status().state, controller::State::failed);
  EXPECT_TRUE(holds(run.status().text, "the high-voltage rail is off"));
  bool halted = false;
  for (const chip::BoardEvent& event : controlled.experiment().take_board_events())
    halted |= event.kind == chip::BoardEvent::Kind::halted && holds(event.message, "channel 1");
  EXPECT_TRUE(halted);
}

TEST(ControlledExperiment, AChipThatIsUnpluggedOnTheWayIsADropletThatIsLost) {
  ControlledExperiment controlled(chip::parse_scene(kLine, "line"), {1, "auto"}, 1);
  controller::ProtocolRun run(move_to(controlled, 3), controlled.coordinator());
  for (int k = 0; k < 20; ++k) controlled.advance(&run);
  ASSERT_TRUE(controlled.experiment().apply(chip::InjectFault{"disconnected", 0, 0, false}).success);
  controlled.finish(run, 5);
  EXPECT_EQ(run.status().state, controller::State::failed);
  EXPECT_TRUE(holds(run.status().text, "the droplet is lost"));
}

TEST(ControlledExperiment, AnElectrodeThatIsStuckOnIsNamedAndNotTheOneAfterIt) {
  ControlledExperiment controlled(chip::parse_scene(kLine, "line"), {1, "auto"}, 1);
  ASSERT_TRUE(controlled.experiment().apply(chip::InjectFault{"stuck_on", 1, 0, false}).success);
  controller::ProtocolRun run(move_to(controlled, 3), controlled.coordinator());
  controlled.finish(run, 30);
  EXPECT_EQ(run.status().state, controller::State::failed);
  EXPECT_TRUE(holds(run.status().text, "electrode 1 does not let go"));
  EXPECT_TRUE(controlled.coordinator().dead().empty());
}

TEST(ControlledExperiment, TheSameSeedGivesTheSameRun) {
  const auto hash = [] {
    ControlledExperiment controlled(chip::parse_scene(kLine, "line"), {1, "auto"}, 4);
    controller::ProtocolRun run(move_to(controlled, 1), controlled.coordinator());
    controlled.finish(run, 20);
    engine::ObserveRequest request;
    request.hash = true;
    return controlled.experiment().observe(request)->state_hash;
  };
  EXPECT_EQ(hash(), hash());
}

}  // namespace
}  // namespace dmf::tools
