#include <fmt/format.h>

#include <ctime>

#include "tools/protocol_trial.h"
#include "tools/saved_run.h"
#include "tools/study.h"

namespace dmf::tools {

namespace {

const std::vector<std::string> kColumns{"worked",  "claimed",  "steps_done",
                                        "clock_s", "droplets", "computing_s"};

/// Of the thread that asks, s: a trial runs on one.
double computing_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::vector<double> row_of(const ProtocolTrial& trial, std::uint64_t seed, const std::string& key) {
  const double start = computing_seconds();
  const TrialResult result = run_trial(trial, seed);
  if (!result.worked) fmt::print(stderr, "{}: {}\n", key, describe(trial, result));
  return {static_cast<double>(result.worked),          static_cast<double>(result.claimed),
          static_cast<double>(result.steps_done),      result.clock,
          static_cast<double>(result.droplets.size()), computing_seconds() - start};
}

}  // namespace

void study_protocols(const StudyOptions& options) {
  const std::vector<ProtocolTrial> all = protocol_trials(options.quick);
  std::vector<std::string> names;
  for (const ProtocolTrial& trial : all) names.push_back(trial.name);
  require_known(options, names);
  ResultTable table(options.output + "/protocols_runs.csv", kColumns);
  const auto key = [&](const ProtocolTrial& trial, int seed) {
    return fmt::format("{}{} seed={}", trial.name, options.quick ? " quick" : "", seed);
  };
  std::vector<Job> jobs;
  for (const ProtocolTrial& trial : all) {
    if (!is_wanted(options, trial.name)) continue;
    for (int seed = 1; seed <= options.seeds; ++seed) {
      jobs.push_back({key(trial, seed), [=] {
                        return row_or_nan(key(trial, seed), kColumns.size(), [&] {
                          return row_of(trial, static_cast<std::uint64_t>(seed), key(trial, seed));
                        });
                      }});
    }
  }
  run_jobs("protocols", jobs, options, table);

  std::string summary = "protocol,runs,worked,claimed,clock_s,clock_s_deviation,computing_s\n";
  fmt::print("{:<18} {:>5} {:>7} {:>8} {:>16} {:>13}\n", "protocol", "runs", "worked", "claimed", "clock, s",
             "computing, s");
  for (const ProtocolTrial& trial : all) {
    if (!is_wanted(options, trial.name)) continue;
    double worked = 0, claimed = 0;
    std::vector<double> clocks, computing;
    for (int seed = 1; seed <= options.seeds; ++seed) {
      const std::vector<double>& row = table.row(key(trial, seed));
      worked += row[0] > 0 ? 1 : 0;
      claimed += row[1] > 0 ? 1 : 0;
      if (row[0] > 0) clocks.push_back(row[3]);
      computing.push_back(row[5]);
    }
    const MeanAndSpread clock = mean_and_spread(clocks);
    const double computed = mean_and_spread(computing).mean;
    fmt::print("{:<18} {:>5} {:>6.0f}% {:>7.0f}% {:>9.1f} +- {:.1f} {:>13.0f}\n", trial.name, options.seeds,
               100 * worked / options.seeds, 100 * claimed / options.seeds, clock.mean, clock.deviation,
               computed);
    summary += fmt::format("{},{},{:g},{:g},{:.4g},{:.4g},{:.4g}\n", trial.name, options.seeds, worked,
                           claimed, clock.mean, clock.deviation, computed);
  }
  replace_file(options.output + "/protocols.csv", summary);
}

}  // namespace dmf::tools
