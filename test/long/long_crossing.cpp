// Lan's droplets on their gradient. His times are single runs; ours come with their own spread.
#include <fmt/format.h>

#include "runs.h"
#include "tools/crossing.h"

namespace dmf::tools {
namespace {

TEST(DropletOfRadiusFive, CrossesTheGradientInLansTimeWithinAQuarter) {
  const chip::Scene scene = chip::load_scene("gradient_R5");
  const Results results = run_cases(
      "crossing", {"to_40"},
      {{"",
        [&scene](std::uint64_t seed) {
          return std::vector<double>{run_crossing(scene, seed, scene.default_duration).passed.at(40)};
        }}},
      two_at_a_time("crossing", 4), 401);
  const MeanAndSpread total = results.mean("", "to_40");
  RecordProperty("mean_crossing_time", fmt::format("{:.0f}", total.mean));
  // 2,973 in the paper. Why ours is faster: docs/validation/droplets.md.
  EXPECT_NEAR(total.mean, 2973, 0.25 * 2973);
  // The stochastic spread of one run is a few percent; a mean that moves by more has another cause.
  EXPECT_LT(total.deviation, 0.1 * total.mean);
}

}  // namespace
}  // namespace dmf::tools
