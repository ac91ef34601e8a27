#include "tools/headless_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "chip/checkpoint_series.h"
#include "chip/checkpoint_writer.h"
#include "tools/progress.h"
#include "tools/run_log.h"

namespace dmf::tools {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The checkpoints of a folder that dmf_run writes.
chip::CheckpointSeries series_in(const std::string& folder, unsigned keep) {
  return {folder, "step_", ".checkpoint", chip::CheckpointSeries::Numbering::by_step,
          keep > 0 ? keep : std::numeric_limits<unsigned>::max()};
}

/// Damaged checkpoints are named on standard error and passed over.
void resume_from(const RunOptions& options, chip::Experiment& experiment) {
  const auto point =
      chip::resume(experiment, series_in(options.resume, options.checkpoint_keep), {0, options.seed},
                   [](const std::string& why) { fmt::print(stderr, "{}\n", why); });
  if (!point)
    throw engine::InvalidInput(fmt::format(
        "--resume: {}, allowed: a folder with a good step_*.checkpoint of this scene", options.resume));
}

/// Writes checkpoints as they were asked for, and says once when they begin to fail and when they are written
/// again: the run goes on without.
class Checkpoints {
 public:
  Checkpoints(const RunOptions& options, chip::CheckpointSeries series)
      : every_(options.checkpoint_every), period_(options.checkpoint_period), writer_(std::move(series)) {}

  /// After a step.
  void write_if_due(const chip::Experiment& experiment, RunLog& log) {
    if (every_ > 0 && experiment.steps() % every_ == 0) {
      writer_.wait();
      put(experiment, log);
    } else if (period_ > 0 && seconds_since(last_) >= period_ && !writer_.busy()) {
      put(experiment, log);
    }
    report();
  }

  /// The last one. @throws std::runtime_error when it can't be written.
  void write_last(const chip::Experiment& experiment, RunLog& log) {
    writer_.wait();
    report();
    put(experiment, log);
    writer_.wait();
    for (const auto& written : writer_.take_reports())
      if (!written.problem.empty())
        throw std::runtime_error("interrupted, and not saved: " + written.problem);
  }

 private:
  void put(const chip::Experiment& experiment, RunLog& log) {
    // First the tables: what is resumed finds all lines before its step.
    log.sync();
    // While the last one is still being written this one is left out, and the next is due at once.
    if (writer_.put(chip::checkpoint_of(experiment))) last_ = Clock::now();
  }

  void report() {
    for (const auto& written : writer_.take_reports()) {
      const bool fails = !written.problem.empty();
      if (fails && !failing_)
        fmt::print(stderr, "\nstep {}: no checkpoint, the run goes on: {}\n", written.step, written.problem);
      if (!fails && failing_) fmt::print(stderr, "\nstep {}: checkpoints are written again\n", written.step);
      failing_ = fails;
    }
  }

  std::uint64_t every_;
  double period_;
  chip::CheckpointWriter writer_;
  Clock::time_point last_ = Clock::now();
  bool failing_ = false;
};

/// Where a run of these options writes its checkpoints. A run that may still be gone on with is not
/// overwritten. @throws engine::InvalidInput then, and when another process writes there.
chip::CheckpointSeries claim_output(const RunOptions& options) {
  chip::CheckpointSeries series = series_in(options.output, options.checkpoint_keep);
  if (options.resume.empty() && !series.numbers().empty()) {
    throw engine::InvalidInput(
        fmt::format("--out: {} has checkpoints of a run up to step {}, allowed: --resume {}, or a folder "
                    "without step_*.checkpoint",
                    options.output, series.numbers().back(), options.output));
  }
  series.claim();
  return series;
}

/// SIGINT and SIGTERM are noted while this lives, a second time they do what they did before.
class SignalsNoted {
 public:
  SignalsNoted() {
    noted = 0;
    struct sigaction action {};
    action.sa_handler = [](int signal) { noted = signal; };
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigaction(SIGINT, &action, &interrupt_);
    ::sigaction(SIGTERM, &action, &terminate_);
  }
  ~SignalsNoted() {
    ::sigaction(SIGINT, &interrupt_, nullptr);
    ::sigaction(SIGTERM, &terminate_, nullptr);
  }
  SignalsNoted(const SignalsNoted&) = delete;
  SignalsNoted& operator=(const SignalsNoted&) = delete;
  int which() const { return noted; }  ///< 0: none

 private:
  static volatile std::sig_atomic_t noted;
  struct sigaction interrupt_ {
  }, terminate_{};
};
volatile std::sig_atomic_t SignalsNoted::noted = 0;

std::uint64_t last_step(const RunOptions& options, const chip::Scene& scene) {
  if (options.steps) return *options.steps;
  const double until = options.until.value_or(scene.settle_time + scene.default_duration);
  return static_cast<std::uint64_t>(std::llround(until / scene.parameters.time_step));
}

}  // namespace

RunResult headless_run(const RunOptions& options) {
  const chip::Scene scene = chip::load_scene(options.scene);
  std::optional<Checkpoints> checkpoints;
  if (!options.output.empty()) checkpoints.emplace(options, claim_output(options));
  chip::Experiment experiment(scene, {options.threads, options.kernel}, options.seed);
  if (!options.resume.empty()) resume_from(options, experiment);
  const std::uint64_t from = experiment.steps(), to = std::max(from, last_step(options, scene));
  const std::uint64_t look = scene.parameters.observe_interval;

  std::optional<std::uint64_t> kept;
  if (!options.resume.empty()) kept = from;
  // A run that ended between two looks had one at its end, which one that goes farther has not.
  if (kept && from % look != 0 && from < to) kept = from - 1;
  RunLog log(options.output, kept);

  const SignalsNoted signals;
  double temperature_sum = 0, looks = 0, bead_steps = 0;
  std::uint64_t looked = from;
  const auto start = Clock::now();
  {
    Progress progress(from, to, options.quiet);
    while (experiment.steps() < to && signals.which() == 0) {
      experiment.step();
      const std::uint64_t step = experiment.steps();
      if (step % look == 0 || step == to) {
        const auto snapshot = experiment.observe();
        temperature_sum += snapshot->temperature;
        looks += 1;
        bead_steps += static_cast<double>(snapshot->moving_beads) * static_cast<double>(step - looked);
        looked = step;
        log.write(*snapshot, scene.units);
        progress.show(step);
      }
      if (checkpoints) checkpoints->write_if_due(experiment, log);
    }
  }
  const bool interrupted = experiment.steps() < to;
  if (interrupted && checkpoints) checkpoints->write_last(experiment, log);

  RunResult result;
  result.wall_s = seconds_since(start);
  const auto end = experiment.observe({false, true});
  result.scene = scene.name;
  result.kernel = experiment.simulation().kernel();
  result.threads = experiment.simulation().threads();
  result.beads = end->moving_beads;
  result.steps = end->step;
  result.time = end->time;
  result.ns_per_bead_step = bead_steps > 0 ? result.wall_s * 1e9 / bead_steps : 0;
  result.temperature = looks > 0 ? temperature_sum / looks : end->temperature;
  result.hash = *end->state_hash;
  if (interrupted) result.interrupted_by = signals.which();
  return result;
}

std::string to_json(const RunResult& result) {
  nlohmann::ordered_json json;
  json["scene"] = result.scene;
  json["kernel"] = result.kernel;
  json["threads"] = result.threads;
  json["beads"] = result.beads;
  json["steps"] = result.steps;
  json["time"] = result.time;
  json["wall_s"] = result.wall_s;
  json["ns_per_bead_step"] = result.ns_per_bead_step;
  json["temperature"] = result.temperature;
  json["hash"] = fmt::format("{:016x}", result.hash);
  return json.dump();
}

}  // namespace dmf::tools
