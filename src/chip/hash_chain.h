#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "chip/command.h"
#include "chip/scene_files.h"

namespace dmf::chip {

/// What a run was like at one step, in two numbers: enough to find out later whether another run came the
/// same way.
struct StateRecord {
  std::uint32_t index = 0;  ///< place among the run's records, from 0
  std::uint64_t step = 0;
  std::uint32_t commands = 0;  ///< how many of the run's had been given
  std::uint64_t hash = 0;      ///< of the engine's complete state
  std::uint64_t chain = 0;     ///< of all that led there, see HashChain
};

/// Fingerprint of a scene's texts; of their roles and contents, not of where the files were.
std::uint64_t fingerprint(const SceneFiles& files);

/// Ties scene, seed, commands and state hashes of a run together: every value is a fingerprint of the one
/// before, of the commands since then and of the state's hash. So the last value stands for the whole run,
/// and a record in which a scene, a command or a hash was altered, left out or put in is not one of any run.
///
/// Links are the first record of a run and the first at every multiple of the interval; a record between two
/// links hangs on the link before it, and nothing hangs on it. So the chain is a function of the run, whoever
/// asked for records in between. It is no signature: who alters a record can compute a new chain.
class HashChain {
 public:
  /// @param interval  steps, > 0.
  HashChain(std::uint64_t scene_fingerprint, std::uint64_t seed, std::uint64_t interval);

  /// The record of a state. @param history  commands of the run so far; its earlier ones as in the calls
  /// before.
  StateRecord add(std::uint64_t step, std::uint64_t hash, const std::vector<CommandRecord>& history) {
    return add(step, hash, history, history.size());
  }
  /// Same when only the first `count` of the history had been given.
  StateRecord add(std::uint64_t step, std::uint64_t hash, const std::vector<CommandRecord>& history,
                  std::size_t count);
  /// Goes on from a record of another chain as from the latest link: what led there is taken on trust.
  void adopt(const StateRecord& link);

  /// There is a record of this moment already.
  bool has(std::uint64_t step, std::size_t commands) const {
    return last_ && last_->step == step && last_->commands == commands;
  }
  const std::optional<StateRecord>& last() const { return last_; }
  bool is_link(std::uint64_t step) const { return !link_ || (step % interval_ == 0 && step > link_->step); }

 private:
  std::uint64_t interval_;
  std::uint64_t start_;              ///< what the first link hangs on
  std::optional<StateRecord> link_;  ///< latest
  std::optional<StateRecord> last_;  ///< latest record, a link or not
};

}  // namespace dmf::chip
