#include "tools/splitting.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/study.h"

namespace dmf::tools {
namespace {

struct Contrast {
  double rest, on;  ///< degrees
};

}  // namespace

void study_splitting(const StudyOptions& options) {
  const std::vector<Contrast> contrasts = options.quick
                                              ? std::vector<Contrast>{{120, 50}}
                                              : std::vector<Contrast>{{120, 50}, {120, 70}, {120, 85}};
  const std::vector<double> pitches =
      options.quick ? std::vector<double>{10} : std::vector<double>{6, 7, 8, 9, 10, 12, 14};
  ResultTable table(options.output + "/splitting_runs.csv", {"time", "smaller_share", "liquid_height"});
  const auto key = [&](const Contrast& contrast, double pitch, int seed) {
    return fmt::format("rest={} on={} gap=3 pitch={} dt={} seed={}", contrast.rest, contrast.on, pitch,
                       options.time_step, seed);
  };
  std::vector<Job> jobs;
  for (int seed = 1; seed <= options.seeds; ++seed)
    for (const Contrast& contrast : contrasts)
      for (const double pitch : pitches)
        jobs.push_back({key(contrast, pitch, seed), [=, &options] {
                          SplittingRun run;
                          run.rest_angle = contrast.rest;
                          run.on_angle = contrast.on;
                          run.pitch = pitch;
                          run.seed = static_cast<std::uint64_t>(seed);
                          run.time_step = options.time_step;
                          const SplittingResult result = run_splitting(run);
                          return std::vector<double>{result.time.value_or(NAN), result.smaller_share,
                                                     result.liquid_height};
                        }});
  run_jobs("splitting", jobs, options, table);

  for (const Contrast& contrast : contrasts) {
    const double threshold = largest_splitting_height(contrast.rest, contrast.on);
    fmt::print("{} -> {} degrees: Cho, Moon and Kim's necking splits up to height / pitch = {:.3f}\n",
               contrast.rest, contrast.on, threshold);
    for (const double pitch : pitches) {
      std::vector<double> times, shares;
      double height = 0;
      for (int seed = 1; seed <= options.seeds; ++seed) {
        const std::vector<double>& row = table.row(key(contrast, pitch, seed));
        height = row[2];
        if (std::isfinite(row[0])) times.push_back(row[0]), shares.push_back(row[1]);
      }
      const std::string split =
          times.empty() ? ""
                        : fmt::format(", after {:.0f} +- {:.0f} tau, the smaller one has {:.2f} +- {:.2f}",
                                      mean_and_spread(times).mean, mean_and_spread(times).deviation,
                                      mean_and_spread(shares).mean, mean_and_spread(shares).deviation);
      fmt::print("  pitch {:4}  height / pitch {:.3f}  gap / pitch {:.3f}  split {} of {}{}\n", pitch,
                 height / pitch, 3 / pitch, times.size(), options.seeds, split);
    }
  }
}

}  // namespace dmf::tools
