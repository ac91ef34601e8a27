#include <fmt/format.h>

#include <algorithm>
#include "tools/cases.h"
#include "tools/floating.h"
#include "tools/saved_run.h"

namespace dmf::tools {

Findings study_microparticle_angle(const StudyOptions& options) {
  const double radius = options.radius_or(1);
  const std::vector<double> attractions =
      options.quick ? std::vector<double>{-10, -8}
                    : std::vector<double>{-15, -13, -12, -11, -10, -9, -8, -7, -6, -5, -4, -3, -2};
  const auto label = [](double attraction) { return fmt::format("A={}", attraction); };
  double time_step = 0;
  std::vector<Case> cases;
  for (const double attraction : attractions) {
    FloatingRun run;
    run.attraction = attraction;
    run.radius = radius;
    apply(options, run.parameters);
    if (options.quick) run.settle = run.measure = 20;
    time_step = run.parameters.time_step;
    cases.push_back(
        {label(attraction), [run](std::uint64_t seed) {
           FloatingRun seeded = run;
           seeded.seed = seed;
           const FloatingResult r = run_floating(seeded);
           return std::vector<double>{r.angle, r.height, r.height_deviation, r.effective_radius, r.immersion};
         }});
  }
  const Results results =
      run_cases("microparticle_angle",
                {"angle", "height", "height_deviation", "effective_radius", "immersion"}, cases, options);
  Findings findings;
  std::string points;
  std::size_t runs = 0;
  double previous = -1;
  for (const double attraction : attractions) {
    Finding angle = results.finding(label(attraction), "angle", "contact angle, floating (degrees)", 1);
    const MeanAndSpread mean = angle.mean();
    // Swallowed or thrown off, be it by one seed: no angle to command. A curve must rise.
    const bool floats = !angle.values.empty() && std::all_of(angle.values.begin(), angle.values.end(),
                                                             [](double one) { return one > 0 && one < 180; });
    if (floats && mean.mean > previous) {
      previous = mean.mean;
      runs = angle.values.size();
      points += fmt::format("  - [{}, {:.2f}, {:.2f}]\n", attraction, mean.mean, mean.standard_error);
    }
    findings.push_back(std::move(angle));
    findings.push_back(
        results.finding(label(attraction), "height", "height of the centre over the film (r_c)", 3));
    findings.push_back(
        results.finding(label(attraction), "effective_radius", "radius that the liquid sees (r_c)", 3));
    findings.push_back(results.finding(label(attraction), "immersion", "immersed share of its beads", 2));
  }
  if (options.recorded || !options.only.empty()) return findings;
  replace_file(
      options.output + "/microparticle.yaml",
      fmt::format("description: contact angle of a microparticle of radius {} that floats in a film over its "
                  "attraction A_ls, mean and standard error of {} seeds\n"
                  "command: dmf_study microparticle_angle --seeds {} --radius {} --time-step {}\n"
                  "# A_ls (k_BT / r_c), angle (degrees), standard error (degrees)\n"
                  "points:\n{}",
                  radius, runs, runs, radius, time_step, points));
  return findings;
}

}  // namespace dmf::tools
