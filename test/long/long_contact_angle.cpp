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
  ResultTable table(fresh_table("contact_angle"), {"angle"});
  std::vector<Job> jobs;
  const auto key = [](double angle, int seed) { return fmt::format("{} seed {}", angle, seed); };
  const double angles[] = {50, 70, 90, 110, 130, 145};
  for (const double angle : angles)
    for (const int seed : {201, 202})
      jobs.push_back({key(angle, seed), [=, &curve] {
                        SessileRun run;
                        run.attraction = curve.attraction(angle);
                        run.starting_angle = angle;
                        run.seed = static_cast<std::uint64_t>(seed);
                        return std::vector<double>{run_sessile(run).angle};
                      }});
  run_jobs("contact angle", jobs, two_at_a_time(), table);
  for (const double angle : angles) {
    const double shown = 0.5 * (table.row(key(angle, 201))[0] + table.row(key(angle, 202))[0]);
    EXPECT_NEAR(shown, angle, 3.0);
    RecordProperty(fmt::format("shown_at_{}", angle), fmt::format("{:.2f}", shown));
  }
}

}  // namespace
}  // namespace dmf::tools
