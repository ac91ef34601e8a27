#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "tools/floating.h"
#include "tools/study.h"

namespace dmf::tools {

void study_microparticle_angle(const StudyOptions& options) {
  const double radius = options.radius > 0 ? options.radius : 1;
  const std::vector<double> attractions =
      options.quick ? std::vector<double>{-10, -8}
                    : std::vector<double>{-15, -13, -12, -11, -10, -9, -8, -7, -6, -5, -4, -3, -2};
  ResultTable table(options.output + "/microparticle_angle_runs.csv",
                    {"angle", "height", "height_deviation", "effective_radius", "immersion"});
  const auto key = [&](double attraction, int seed) {
    return fmt::format("A={} R={} dt={} seed={}", attraction, radius, options.time_step, seed);
  };
  std::vector<Job> jobs;
  for (int seed = 1; seed <= options.seeds; ++seed)
    for (const double attraction : attractions)
      jobs.push_back({key(attraction, seed), [=, &options] {
                        FloatingRun run;
                        run.attraction = attraction;
                        run.radius = radius;
                        run.seed = static_cast<std::uint64_t>(seed);
                        run.parameters.time_step = options.time_step;
                        if (options.lambda > 0) run.parameters.integrator_lambda = options.lambda;
                        if (options.quick) run.settle = run.measure = 20;
                        const FloatingResult result = run_floating(run);
                        return std::vector<double>{result.angle, result.height, result.height_deviation,
                                                   result.effective_radius, result.immersion};
                      }});
  run_jobs("microparticle_angle", jobs, options, table);

  fmt::print("{:>8} {:>8} {:>6} {:>8} {:>8} {:>10} {:>10}\n", "A_ls", "angle", "+-", "height", "radius",
             "immersion", "Lan (2.39)");
  std::string points;
  double previous = -1;
  for (const double attraction : attractions) {
    std::vector<double> column[5];
    for (int seed = 1; seed <= options.seeds; ++seed)
      for (int k = 0; k < 5; ++k) column[k].push_back(table.row(key(attraction, seed))[k]);
    const MeanAndSpread angle = mean_and_spread(column[0]);
    fmt::print("{:8.2f} {:8.1f} {:6.1f} {:8.3f} {:8.3f} {:10.2f} {:10.1f}\n", attraction, angle.mean,
               angle.deviation, mean_and_spread(column[1]).mean, mean_and_spread(column[3]).mean,
               mean_and_spread(column[4]).mean,
               (552.125 - (attraction + 1.211) * (attraction + 1.211)) / 3.30033);
    // Swallowed or thrown off, be it by one seed: no angle to command. A curve must rise.
    const bool floats =
        std::all_of(column[0].begin(), column[0].end(), [](double one) { return one > 0 && one < 180; });
    if (!floats || angle.mean <= previous) continue;
    previous = angle.mean;
    points += fmt::format("  - [{}, {:.2f}, {:.2f}]\n", attraction, angle.mean, angle.standard_error);
  }
  const std::string file = options.output + "/microparticle.yaml";
  std::ofstream(file) << fmt::format(
      "description: contact angle of a microparticle of radius {} that floats in a film over its attraction "
      "A_ls, mean and standard error of {} seeds\n"
      "command: dmf_study microparticle_angle --seeds {} --radius {} --time-step {}\n"
      "# A_ls (k_BT / r_c), angle (degrees), standard error (degrees)\n"
      "points:\n{}",
      radius, options.seeds, options.seeds, radius, options.time_step, points);
  fmt::print("written: {}\n", file);
}

}  // namespace dmf::tools
