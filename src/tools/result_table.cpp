#include "tools/result_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "commit.h"
#include "tools/saved_run.h"

namespace dmf::tools {
namespace {

constexpr const char* bookkeeping = ",computing_s,engine";

}  // namespace

ResultTable::ResultTable(const std::string& file, std::vector<std::string> columns)
    : file_(file), columns_(std::move(columns)) {
  const std::string header = fmt::format("run,{}", fmt::join(columns_, ","));
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line)) return;
  if (line != header && line != header + bookkeeping)
    throw std::runtime_error(fmt::format("{}: holds other results; move it away", file));
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    std::string key, field;
    std::getline(fields, key, ',');
    ResultRow row;
    while (row.values.size() < columns_.size() && std::getline(fields, field, ','))
      row.values.push_back(std::strtod(field.c_str(), nullptr));
    // The last line of a killed study may be cut: it is done again.
    if (row.values.size() < columns_.size()) continue;
    if (std::getline(fields, field, ',')) row.computing = std::strtod(field.c_str(), nullptr);
    std::getline(fields, row.engine);
    rows_[key] = row;
  }
}

bool ResultTable::has(const std::string& key) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return rows_.count(key) > 0;
}

const ResultRow& ResultTable::row(const std::string& key) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return rows_.at(key);
}

std::vector<int> ResultTable::seeds_of(const std::string& name) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string prefix = name + " seed=";
  std::vector<int> seeds;
  for (auto row = rows_.lower_bound(prefix); row != rows_.end() && row->first.rfind(prefix, 0) == 0; ++row)
    seeds.push_back(std::atoi(row->first.c_str() + prefix.size()));
  std::sort(seeds.begin(), seeds.end());
  return seeds;
}

void ResultTable::add(const std::string& key, const ResultRow& row) {
  const std::lock_guard<std::mutex> lock(mutex_);
  rows_[key] = row;
  if (!begun_) {
    std::string text = fmt::format("run,{}{}\n", fmt::join(columns_, ","), bookkeeping);
    for (const auto& [name, values] : rows_) text += line_of(name, values);
    replace_file(file_, text);
    begun_ = true;
  } else {
    std::ofstream(file_, std::ios::app) << line_of(key, row);
  }
}

std::string ResultTable::line_of(const std::string& key, const ResultRow& row) const {
  return fmt::format("{},{:.10g},{:.4g},{}\n", key, fmt::join(row.values, ","), row.computing, row.engine);
}

std::string engine_commit() { return DMF_SIM_COMMIT; }

}  // namespace dmf::tools
