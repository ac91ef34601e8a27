// What angle is commanded, that angle the droplet shows. Seeds that the calibration has not seen.
#include <fmt/format.h>

#include "chip/configuration.h"
#include "engine/wettability.h"
#include "runs.h"
#include "tools/sessile.h"

namespace dmf::tools {
namespace {

TEST(Droplet, ShowsTheCommandedAngleWithinThreeDegrees) {
  const engine::ContactAngleCurve curve =
      engine::ContactAngleCurve::load(chip::find_config("calibration", "water_like"));
  const double angles[] = {50, 70, 90, 110, 130, 145};
  const auto label = [](double angle) { return fmt::format("angle={}", angle); };
  std::vector<Case> cases;
  for (const double angle : angles)
    cases.push_back({label(angle), [=, &curve](std::uint64_t seed) {
                       SessileRun run;
                       run.attraction = curve.attraction(angle);
                       run.starting_angle = angle;
                       run.seed = seed;
                       return std::vector<double>{run_sessile(run).angle};
                     }});
  const Results results =
      run_cases("contact_angle", {"angle"}, cases, two_at_a_time("contact_angle", 2), 201);
  for (const double angle : angles) {
    const double shown = results.mean(label(angle), "angle").mean;
    EXPECT_NEAR(shown, angle, 3.0);
    RecordProperty(fmt::format("shown_at_{}", angle), fmt::format("{:.2f}", shown));
  }
}

}  // namespace
}  // namespace dmf::tools
