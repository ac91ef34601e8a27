#pragma once
#include <cmath>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace dmf::tools {

/// What one run has given.
struct ResultRow {
  ResultRow() = default;
  ResultRow(std::vector<double> by_column) : values(std::move(by_column)), computing(0) {}

  std::vector<double> values;  ///< by column
  double computing = NAN;      ///< processor time of the run, s; NaN: not recorded
  std::string engine;          ///< commit that it was made with; empty: not recorded
};

/// Results of runs, one a line in a CSV file, written as soon as they are there: a study that was killed goes
/// on where it was. A run is known by its key, such as "A=-15 R=10 seed=2". Thread-safe.
class ResultTable {
 public:
  /// Reads what an earlier call has left, the last two columns, computing_s and engine, may be missing. The
  /// file is first written by add().
  /// @throws std::runtime_error when the file has other columns.
  ResultTable(const std::string& file, std::vector<std::string> columns);

  const std::vector<std::string>& columns() const { return columns_; }
  bool has(const std::string& key) const;
  const ResultRow& row(const std::string& key) const;
  /// The seeds of all rows of the key "CASE seed=", in their order.
  std::vector<int> seeds_of(const std::string& name) const;
  void add(const std::string& key, const ResultRow& row);

 private:
  std::string line_of(const std::string& key, const ResultRow& row) const;

  std::string file_;
  std::vector<std::string> columns_;
  mutable std::mutex mutex_;
  std::map<std::string, ResultRow> rows_;
  bool begun_ = false;  ///< the file has been written with today's columns
};

/// The commit that this program was built from, with "-dirty" when the tree was changed; "unknown" outside
/// git.
std::string engine_commit();

}  // namespace dmf::tools
