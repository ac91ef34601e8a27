#include "tools/cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <set>
#include <thread>

#include "engine/simulation.h"
#include "tools/saved_run.h"

namespace dmf::tools {
namespace {

struct Run {
  std::string key;
  const Case* of;
  std::uint64_t seed;
};

ResultRow do_run(const Run& run, std::size_t columns) {
  const double start = thread_seconds();
  ResultRow row;
  try {
    row = run.of->run(run.seed);
  } catch (const engine::Instability& problem) {
    fmt::print(stderr, "{}: {}\n", run.key, problem.what());
    row = std::vector<double>(columns, NAN);
  }
  row.computing += thread_seconds() - start;
  row.engine = engine_commit();
  return row;
}

void do_runs(const std::string& study, const std::vector<Run>& runs, int at_a_time, ResultTable& table) {
  std::atomic<std::size_t> next{0};
  std::size_t done = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto start = std::chrono::steady_clock::now();
  const auto worker = [&] {
    for (std::size_t k = next++; k < runs.size(); k = next++) {
      try {
        table.add(runs[k].key, do_run(runs[k], table.columns().size()));
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!failure) failure = std::current_exception();
        next = runs.size();
        return;
      }
      const std::lock_guard<std::mutex> lock(mutex);
      ++done;
      const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      fmt::print(stderr, "{}: {} of {} done, {:.0f} s, about {:.0f} s left ({})\n", study, done, runs.size(),
                 elapsed, elapsed / static_cast<double>(done) * static_cast<double>(runs.size() - done),
                 runs[k].key);
    }
  };
  std::vector<std::thread> threads;
  for (int k = 0; k < at_a_time; ++k) threads.emplace_back(worker);
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

Results::Results(std::string study, std::vector<std::string> columns, const StudyOptions& options)
    : study_(std::move(study)),
      variant_(options_key(options)),
      table_(std::make_unique<ResultTable>(fmt::format("{}/{}_runs.csv", options.output, study_),
                                           std::move(columns))) {}

std::string Results::name_of(const std::string& label) const {
  return (label.empty() ? "scene" : label) + variant_;
}

std::vector<double> Results::of(const std::string& label, const std::string& column) const {
  const auto& columns = table_->columns();
  const auto index = std::find(columns.begin(), columns.end(), column) - columns.begin();
  std::vector<double> values;
  if (std::find(wanted_.begin(), wanted_.end(), label) == wanted_.end()) return values;
  for (const int seed : table_->seeds_of(name_of(label)))
    values.push_back(table_->row(fmt::format("{} seed={}", name_of(label), seed)).values.at(index));
  return values;
}

MeanAndSpread Results::mean(const std::string& label, const std::string& column) const {
  return derived(label, column, "", 0, of(label, column)).mean();
}

Finding Results::finding(const std::string& label, const std::string& column, const std::string& title,
                         int decimals) const {
  return derived(label, column, title, decimals, of(label, column));
}

Finding Results::derived(const std::string& label, const std::string& quantity, const std::string& title,
                         int decimals, std::vector<double> values) const {
  Finding finding;
  finding.study = study_;
  finding.of = label + variant_;
  finding.quantity = quantity;
  finding.title = title;
  finding.decimals = decimals;
  finding.values = std::move(values);
  std::vector<double> seconds;
  std::set<std::string> commits;
  for (const int seed : table_->seeds_of(name_of(label))) {
    const ResultRow& row = table_->row(fmt::format("{} seed={}", name_of(label), seed));
    if (std::isfinite(row.computing)) seconds.push_back(row.computing);  // of those that were timed
    if (!row.engine.empty()) commits.insert(row.engine);
  }
  finding.computing = seconds.empty() ? NAN : mean_and_spread(seconds).mean;
  finding.engine.assign(commits.begin(), commits.end());
  return finding;
}

Results run_cases(const std::string& study, const std::vector<std::string>& columns,
                  const std::vector<Case>& cases, const StudyOptions& options, int first_seed) {
  std::vector<std::string> labels;
  for (const Case& one : cases) labels.push_back(one.label);
  require_known(options, labels);
  Results results(study, columns, options);
  for (const std::string& label : labels)
    if (is_wanted(options, label)) results.wanted_.push_back(label);
  if (options.recorded) return results;

  std::vector<Run> missing;
  std::size_t all = 0;
  // One seed of everything first: a study that was stopped early says something of every value.
  for (int seed = first_seed; seed < first_seed + options.seeds; ++seed)
    for (const Case& one : cases) {
      if (!is_wanted(options, one.label)) continue;
      const std::string key = fmt::format("{} seed={}", results.name_of(one.label), seed);
      ++all;
      if (!results.table_->has(key)) missing.push_back({key, &one, static_cast<std::uint64_t>(seed)});
    }
  fmt::print(stderr, "{}: {} runs, {} of them done before\n", study, all, all - missing.size());
  do_runs(study, missing, options.jobs, *results.table_);
  return results;
}

}  // namespace dmf::tools
