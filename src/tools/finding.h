#pragma once
#include <string>
#include <utility>
#include <vector>

namespace dmf::tools {

/// One number with its spread over seeds.
struct MeanAndSpread {
  double mean = 0;
  double deviation = 0;       ///< sample standard deviation; 0 for one value
  double standard_error = 0;  ///< deviation / sqrt(n)
};
MeanAndSpread mean_and_spread(const std::vector<double>& values);

/// What a number of ours is compared with.
struct Reference {
  std::string value;   ///< "8.60", "about 1.5", "2000 to 4000", "never"; "": nothing is known
  std::string source;  ///< who says so: "Lan", "Young and Laplace"
};
Reference reference(double value, int decimals, const std::string& source);

/// What a study has found of one quantity of one case: a line of its NAME.csv, of what it prints, and, where
/// there is something to compare with, of the table in docs/validation.md.
struct Finding {
  std::string study, of;       ///< which case: "R=5 seed"; empty in a study that varies nothing
  std::string quantity;        ///< as a column is called: "passes_0"
  std::string title;           ///< for people, with its unit: "passes x = 0 at (tau)"
  std::vector<double> values;  ///< over runs; NaN: has not happened in that one
  int decimals = 3;
  Reference paper, theory;
  /// Off by no more than `tolerance` of the reference, or than `margin`, still agrees.
  double tolerance = 0.05, margin = 0;
  double computing = 0;             ///< mean processor time of the runs that were timed, s; NaN: none was
  std::vector<std::string> engine;  ///< commits that the runs were made with, each once

  Finding& against_paper(Reference reference);
  Finding& against_theory(Reference reference);
  Finding& within(double share_of_reference);
  Finding& within_margin(double of_either_side);

  /// Of the runs in which it has happened.
  MeanAndSpread mean() const;
  int happened() const;
  /// "2167 +- 30", "never", with "in 2 of 3" where it did not happen always.
  std::string ours() const;
  /// Compared with the paper's value, without one with theory's: "agrees, +0.3 %", "off, -12 %",
  /// "as there", "happened"; empty where there is nothing to compare.
  std::string verdict() const;
};
using Findings = std::vector<Finding>;

/// How alike two orders are, Kendall's rank correlation: 1 the same, -1 reversed. What is equal in the second
/// one has no order there and does not count. NaN when nothing does.
double rank_correlation(const std::vector<std::pair<double, double>>& pairs);

/// As a table for a terminal, and as the text of NAME.csv.
std::string as_text(const Findings& findings);
std::string as_csv(const Findings& findings);
/// The rows of those that have something to compare with, for docs/validation.md.
std::string as_markdown(const Findings& findings);

}  // namespace dmf::tools
