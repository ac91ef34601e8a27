#include "bag_tools/resimulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "chip/checkpoint_file.h"
#include "chip/experiment.h"
#include "chip/scene.h"

namespace dmf::bag_tools {

namespace {

constexpr const char* kReference = "reference";

/// The run went another way than the recorded one; what() says where.
class Difference : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A run that is computed again under the commands of a record.
class Rerun {
 public:
  Rerun(const Session& session, const RecordedRun& run, const ResimulationOptions& options)
      : session_(session),
        run_(run),
        commands_(history(run)),
        interval_(session.hash_interval),
        chain_(chain_of(session, run)),
        experiment_(chip::rebuild_scene(session.files), {options.threads, kernel(session, options)},
                    run.seed) {}

  /// Goes on from a checkpoint in place of the scene's start.
  void load(const RecordedCheckpoint& checkpoint) {
    const std::string name =
        checkpoint.name.empty() ? fmt::format("step {}", checkpoint.step) : checkpoint.name;
    experiment_.load(chip::decode(checkpoint.data, name).state);
    given_ = experiment_.history().size();
    for (std::size_t i = 0; i < std::min(given_, commands_.size()); ++i) {
      const chip::CommandRecord& there = experiment_.history()[i];
      if (there.step != commands_[i].step || to_json(there.command) != to_json(commands_[i].command)) {
        throw Difference(
            fmt::format("command {} is {} at step {} in the checkpoint of step {}, and {} at step {} in the "
                        "record of commands",
                        i, to_json(there.command), there.step, experiment_.steps(),
                        to_json(commands_[i].command), commands_[i].step));
      }
    }
  }

  std::uint64_t steps() const { return experiment_.steps(); }
  std::size_t commands_given() const { return given_; }
  const engine::Simulation& simulation() const { return experiment_.simulation(); }

  /// Computes up to a step, with the first `commands` of the run given; later ones of that step are not.
  void advance_to(std::uint64_t step, std::size_t commands, const std::function<void()>& on_step) {
    while (true) {
      while (given_ < commands && commands_.at(given_).step == steps()) give();
      if (steps() == step) break;
      experiment_.step();
      if (linked_ && steps() % interval_ == 0) note(steps(), hash());
      on_step();
    }
    if (given_ < commands) {
      throw Difference(fmt::format("command {} is of step {}, and was given before step {}", given_,
                                   commands_.at(given_).step, steps()));
    }
  }

  /// Whether this is where the recorded run was. @throws Difference.
  void compare(const chip::StateRecord& recorded) {
    if (recorded.index == 0) linked_ = true;  // the chain begins here
    const bool noted = linked_ && chain_.has(steps(), given_);
    const std::uint64_t own = noted ? chain_.last()->hash : hash();
    if (own != recorded.hash)
      throw Difference(fmt::format("{:016x} in place of {:016x}", own, recorded.hash));
    if (!linked_) {
      linked_ = is_link(session_, run_, recorded);
      if (linked_) chain_.adopt(recorded);
      return;
    }
    if (!noted) note(steps(), own);
    if (chain_.last()->chain != recorded.chain && altered_.empty()) {
      altered_ = fmt::format("step {}", recorded.step);
    }
  }

  /// Where the chain does not hold although the states are equal; empty when it does everywhere.
  const std::string& altered() const { return altered_; }

  /// The step that halted the recorded run. @throws Difference unless it halts this one for the same reason.
  void expect_fault(const std::string& message) {
    try {
      experiment_.step();
    } catch (const engine::Instability& instability) {
      if (instability.what() == message) return;
      throw Difference(fmt::format("halted by \"{}\" in place of \"{}\"", instability.what(), message));
    }
    throw Difference(fmt::format("goes on where the recorded run was halted by \"{}\"", message));
  }

 private:
  static std::string kernel(const Session& session, const ResimulationOptions& options) {
    if (!options.kernel.empty()) return options.kernel;
    // All others give the same bits; the recorded one may not exist on this processor.
    return session.kernel == kReference ? kReference : engine::Execution{}.kernel;
  }

  void give() {
    const chip::Reply reply = experiment_.apply(commands_[given_].command);
    if (!reply.success) {
      throw Difference(fmt::format("command {} ({}) was accepted at step {}, and is refused here: {}", given_,
                                   name_of(commands_[given_].command), steps(), reply.message));
    }
    ++given_;
  }

  std::uint64_t hash() const {
    engine::ObserveRequest request;
    request.hash = true;
    return experiment_.observe(request)->state_hash.value();
  }

  void note(std::uint64_t step, std::uint64_t hash) { chain_.add(step, hash, commands_, given_); }

  const Session& session_;
  const RecordedRun& run_;
  std::vector<chip::CommandRecord> commands_;
  std::size_t given_ = 0;
  std::uint64_t interval_;
  chip::HashChain chain_;
  bool linked_ = false;  ///< the chain is the recorded run's
  std::string altered_;
  chip::Experiment experiment_;
};

void require_commands(const RecordedRun& run, std::uint32_t count) {
  const std::string missing = missing_commands(run, count);
  if (missing.empty()) return;
  throw InvalidInput(
      fmt::format("run {}: commands {} are missing in the bag, and it can't be computed again without them",
                  run.number, missing));
}

const RecordedCheckpoint* last_checkpoint(const RecordedRun& run, std::uint64_t up_to) {
  const auto after = run.checkpoints.upper_bound(up_to);
  return after == run.checkpoints.begin() ? nullptr : &std::prev(after)->second;
}

}  // namespace

Verdict resimulate(const Session& session, const RecordedRun& run, const ResimulationOptions& options,
                   const OnProgress& on_progress) {
  if (session.version.empty()) throw InvalidInput("the bag lacks the scene (~scene was not recorded)");
  if (run.hashes.empty() || session.hash_interval == 0) {
    throw InvalidInput(
        fmt::format("run {}: the bag holds no state hashes (~hash_interval was 0, or ~run_record was not "
                    "recorded), there is nothing to compare with",
                    run.number));
  }
  const std::uint64_t first = run.hashes.begin()->second.step, last = run.hashes.rbegin()->second.step;
  const std::uint64_t from = options.from.value_or(first), until = options.until.value_or(last);
  if (from > until || from > last) {
    throw InvalidInput(fmt::format("run {}: from step {} to {}, allowed: within {} to {}, what was recorded",
                                   run.number, from, until, first, last));
  }

  const auto start = std::chrono::steady_clock::now();
  Verdict verdict;
  std::optional<std::uint64_t> sound_at;
  std::uint64_t aim = 0;  // step of what is compared next
  try {
    Rerun rerun(session, run, options);
    verdict.kernel = rerun.simulation().kernel();
    verdict.threads = rerun.simulation().threads();
    if (const RecordedCheckpoint* checkpoint = last_checkpoint(run, from)) rerun.load(*checkpoint);
    verdict.start = verdict.end = rerun.steps();
    const auto on_step = [&] {
      verdict.end = rerun.steps();
      if (on_progress) on_progress(rerun.steps(), verdict.start, std::min(until, last));
    };
    for (const auto& [index, recorded] : run.hashes) {
      if (recorded.step > until) break;
      if (recorded.step < rerun.steps() || recorded.commands < rerun.commands_given()) continue;
      require_commands(run, recorded.commands);
      aim = recorded.step;
      ++verdict.compared;
      rerun.advance_to(recorded.step, recorded.commands, on_step);
      rerun.compare(recorded);
      ++verdict.equal;
      sound_at = recorded.step;
    }
    const bool to_fault = run.fault && run.fault->step >= verdict.end && until >= last;
    if (to_fault) {
      require_commands(run, run.commands_given());
      aim = run.fault->step;
      rerun.advance_to(run.fault->step, run.commands_given(), on_step);
      rerun.expect_fault(run.fault->message);
    }
    verdict.reproduced = rerun.altered().empty() && verdict.equal > 0;
    verdict.message =
        !rerun.altered().empty()
            ? fmt::format(
                  "{} of {} hashes equal, but the record was altered: the hash chain differs first at "
                  "{}, so the scene, the seed or a command is not the run's",
                  verdict.equal, verdict.compared, rerun.altered())
        : verdict.equal == 0 ? fmt::format("there is no hash between step {} and step {} to compare with",
                                           verdict.start, until)
                             : fmt::format("{} of {} hashes equal{}, the run is reproduced", verdict.equal,
                                           verdict.compared, to_fault ? " and the same fault" : "");
  } catch (const Difference& difference) {
    verdict.message =
        fmt::format("differs first at step {}{}: {}", aim,
                    sound_at ? fmt::format(", equal up to step {}", *sound_at) : "", difference.what());
  } catch (const engine::Instability& instability) {
    verdict.message =
        fmt::format("differs first at step {}{}: halted, and the recorded run was not: {}", verdict.end,
                    sound_at ? fmt::format(", equal up to step {}", *sound_at) : "", instability.what());
  }
  verdict.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return verdict;
}

}  // namespace dmf::bag_tools
