#include "tools/splitting.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/cases.h"

namespace dmf::tools {
namespace {

struct Contrast {
  double rest, on;  ///< degrees
};

}  // namespace

Findings study_splitting(const StudyOptions& options) {
  const std::vector<Contrast> contrasts = options.quick
                                              ? std::vector<Contrast>{{120, 50}}
                                              : std::vector<Contrast>{{120, 50}, {120, 70}, {120, 85}};
  const std::vector<double> pitches =
      options.quick ? std::vector<double>{10} : std::vector<double>{6, 7, 8, 9, 10, 12, 14};
  const auto label = [](const Contrast& contrast, double pitch) {
    return fmt::format("rest={} on={} gap=3 pitch={}", contrast.rest, contrast.on, pitch);
  };
  std::vector<Case> cases;
  for (const Contrast& contrast : contrasts)
    for (const double pitch : pitches)
      cases.push_back({label(contrast, pitch), [=, &options](std::uint64_t seed) {
                         SplittingRun run;
                         run.rest_angle = contrast.rest;
                         run.on_angle = contrast.on;
                         run.pitch = pitch;
                         run.seed = seed;
                         run.time_step = options.time_step_or(run.time_step);
                         const SplittingResult r = run_splitting(run);
                         return std::vector<double>{r.time.value_or(NAN), r.smaller_share, r.liquid_height};
                       }});
  const Results results = run_cases("splitting", {"time", "smaller_share", "liquid_height"}, cases, options);
  Findings findings;
  for (const Contrast& contrast : contrasts) {
    const double necking = largest_splitting_height(contrast.rest, contrast.on);
    double splits_up_to = NAN;  // every run
    for (const double pitch : pitches) {
      Finding time = results.finding(label(contrast, pitch), "time", "split after (tau)", 0);
      if (time.values.empty()) continue;
      const double height = results.mean(label(contrast, pitch), "liquid_height").mean / pitch;
      if (time.happened() == static_cast<int>(time.values.size()))
        splits_up_to = std::fmax(splits_up_to, height);
      findings.push_back(results.derived(label(contrast, pitch), "height_over_pitch",
                                         "height of the liquid over the pitch", 3, {height}));
      findings.push_back(std::move(time));
      findings.push_back(
          results.finding(label(contrast, pitch), "smaller_share", "share of the smaller one", 2));
    }
    findings.push_back(results
                           .derived(fmt::format("rest={} on={}", contrast.rest, contrast.on), "splits_up_to",
                                    "always splits up to a height over pitch of", 3, {splits_up_to})
                           .against_theory(reference(necking, 3, "necking, Cho, Moon and Kim"))
                           .within(0.15));
  }
  return findings;
}

}  // namespace dmf::tools
