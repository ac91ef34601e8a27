#include "tools/cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "engine/archive.h"
#include "engine/simulation.h"
#include "tools/processes.h"
#include "tools/saved_run.h"
#include "tools/study_progress.h"

namespace dmf::tools {
namespace {

struct Run {
  std::string key;
  const Case* of;
  std::uint64_t seed;
};

/// What a run has given, on its way from the process that did it.
struct Outcome {
  std::vector<double> values;
  double computing = 0;        ///< s
  std::vector<char> unstable;  ///< why there are no values: what engine::Instability says

  void archive(engine::Archive& archive) {
    archive(values);
    archive(computing);
    archive(unstable);
  }
};

Outcome do_run(const Run& run, std::size_t columns) {
  const double start = thread_seconds();
  Outcome outcome;
  try {
    const ResultRow row = run.of->run(run.seed);
    outcome.values = row.values;
    outcome.computing = row.computing;
  } catch (const engine::Instability& problem) {
    const std::string why = problem.what();
    outcome.unstable.assign(why.begin(), why.end());
    outcome.values.assign(columns, NAN);
  }
  outcome.computing += thread_seconds() - start;
  return outcome;
}

void do_runs(const std::string& study, const std::vector<Run>& runs, int at_a_time, ResultTable& table) {
  StudyProgress progress(study, runs.size());
  Works works;
  works.count = runs.size();
  works.at_a_time = at_a_time;
  works.name = [&runs](std::size_t which) { return runs[which].key; };
  works.work = [&runs, &table](std::size_t which) {
    engine::Archive archive;
    do_run(runs[which], table.columns().size()).archive(archive);
    return archive.take();
  };
  works.answered = [&](std::size_t which, const std::string& answer) {
    Outcome outcome;
    engine::Archive archive(answer);
    outcome.archive(archive);
    ResultRow row = outcome.values;
    row.computing = outcome.computing;
    row.engine = engine_commit();
    table.add(runs[which].key, row);
    const std::string unstable(outcome.unstable.begin(), outcome.unstable.end());
    progress.say(fmt::format("{}: {}", runs[which].key,
                             unstable.empty() ? "done in " + duration_text(row.computing) : unstable));
  };
  works.watch = [&progress](const WorkDone& done) { progress.show(done); };
  run_in_processes(works);
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
