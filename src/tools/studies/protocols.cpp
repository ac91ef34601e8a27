#include <fmt/format.h>

#include "tools/cases.h"
#include "tools/protocol_trial.h"

namespace dmf::tools {

Findings study_protocols(const StudyOptions& options) {
  const std::vector<ProtocolTrial> all = protocol_trials(options.quick);
  std::vector<Case> cases;
  for (const ProtocolTrial& trial : all)
    cases.push_back({trial.name, [=](std::uint64_t seed) {
                       const TrialResult result = run_trial(trial, seed);
                       if (!result.worked)
                         fmt::print(stderr, "{} seed={}: {}\n", trial.name, seed, describe(trial, result));
                       return std::vector<double>{static_cast<double>(result.worked),
                                                  static_cast<double>(result.claimed),
                                                  static_cast<double>(result.steps_done), result.clock,
                                                  static_cast<double>(result.droplets.size())};
                     }});
  const Results results =
      run_cases("protocols", {"worked", "claimed", "steps_done", "clock_s", "droplets"}, cases, options);
  Findings findings;
  for (const ProtocolTrial& trial : all) {
    findings.push_back(results.finding(trial.name, "worked", "share of the runs that worked", 2)
                           .against_theory({"1", "all"}));
    findings.push_back(
        results.finding(trial.name, "claimed", "share that the controller called a success", 2));
    findings.push_back(results.finding(trial.name, "clock_s", "time on the chip (s)", 1));
  }
  return findings;
}

}  // namespace dmf::tools
