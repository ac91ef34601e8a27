// The shipped protocols through the controller, on coarse electrodes. ctest runs the groups side by side.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "chip/configuration.h"
#include "tools/controlled_experiment.h"
#include "tools/protocol_trial.h"

namespace dmf::tools {
namespace {

TEST(Protocols, EveryShippedOneFitsItsScenesAndIsTried) {
  std::size_t read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(chip::config_directory() + "/protocols")) {
    for (const bool coarse : {true, false}) {
      const auto trials = protocol_trials(coarse);
      const auto trial = std::find_if(trials.begin(), trials.end(), [&](const ProtocolTrial& any) {
        return any.protocol == entry.path().stem().string();
      });
      ASSERT_NE(trial, trials.end()) << entry.path();
      const chip::Scene scene = chip::load_scene(trial->scene);
      const controller::Layout layout(describe_board(scene));
      EXPECT_NO_THROW(
          controller::load_protocol(entry.path().string(), layout, scene.electrowetting.max_voltage))
          << entry.path();
    }
    ++read;
  }
  EXPECT_GE(read, 11u);
}

class Protocol : public testing::TestWithParam<const char*> {};

TEST_P(Protocol, LeavesLiquidAndMicroparticlesWhereItSays) {
  const auto trials = protocol_trials(true);
  const auto trial =
      std::find_if(trials.begin(), trials.end(), [](const auto& any) { return any.name == GetParam(); });
  ASSERT_NE(trial, trials.end());
  const TrialResult result = run_trial(*trial, 1);
  EXPECT_TRUE(result.worked) << describe(*trial, result);
  RecordProperty("clock_seconds", std::to_string(result.clock));
}

const auto kName = [](const testing::TestParamInfo<const char*>& info) { return std::string(info.param); };

INSTANTIATE_TEST_SUITE_P(Walks, Protocol,
                         testing::Values("move_line", "round_hole", "cross", "deliver", "manual"), kName);
INSTANTIATE_TEST_SUITE_P(Volumes, Protocol, testing::Values("merge", "mix", "split", "dispense"), kName);
INSTANTIATE_TEST_SUITE_P(Dilution, Protocol, testing::Values("serial_dilution"), kName);
INSTANTIATE_TEST_SUITE_P(Washing, Protocol, testing::Values("wash_microparticle"), kName);

}  // namespace
}  // namespace dmf::tools
