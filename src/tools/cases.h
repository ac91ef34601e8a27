#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tools/finding.h"
#include "tools/result_table.h"
#include "tools/study.h"

namespace dmf::tools {

/// What a study varies has one value: how it is run.
struct Case {
  std::string label;  ///< "R=5"; empty in a study that varies nothing
  /// Gives the row, by column; single-threaded. Its `computing` is what the run had taken before it was
  /// stopped and taken up again: the time of this call is added. What engine::Instability ends leaves a row
  /// of NaN.
  std::function<ResultRow(std::uint64_t seed)> run;
};

/// What the cases of a study have given, over seeds.
class Results {
 public:
  Results(std::string study, std::vector<std::string> columns, const StudyOptions& options);

  /// One column of a case, over all seeds that are recorded; empty when the case was not wanted or not run.
  std::vector<double> of(const std::string& label, const std::string& column) const;
  MeanAndSpread mean(const std::string& label, const std::string& column) const;
  /// The same as a finding, to be compared with something.
  Finding finding(const std::string& label, const std::string& column, const std::string& title,
                  int decimals) const;
  /// Of what was computed from several columns or cases.
  Finding derived(const std::string& label, const std::string& quantity, const std::string& title,
                  int decimals, std::vector<double> values) const;

 private:
  friend Results run_cases(const std::string& study, const std::vector<std::string>& columns,
                           const std::vector<Case>& cases, const StudyOptions& options, int first_seed);
  std::string name_of(const std::string& label) const;

  std::string study_, variant_;
  std::unique_ptr<ResultTable> table_;
  std::vector<std::string> wanted_;
};

/// Runs every case with `options.seeds` seeds, one seed of everything first, `options.jobs` at a time, each
/// in a process of its own, and leaves a line a run in options.output/STUDY_runs.csv: what is there already
/// is not run again. Progress with time left goes to standard error. With options.recorded nothing is run.
/// @throws std::runtime_error when --only names no case; after the running ones when a run has thrown or
/// crashed.
Results run_cases(const std::string& study, const std::vector<std::string>& columns,
                  const std::vector<Case>& cases, const StudyOptions& options, int first_seed = 1);

}  // namespace dmf::tools
