#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "bag_tools/bag_record.h"

namespace dmf::bag_tools {

struct ResimulationOptions {
  /// Compare from here on: begin at the last checkpoint up to this step, without one at the scene's start.
  /// By default the run's first hash that was recorded.
  std::optional<std::uint64_t> from;
  std::optional<std::uint64_t> until;  ///< the last step to compare; by default the last that was recorded
  int threads = 0;                     ///< 0: all cores
  /// Empty: what gives the same bits as the recorded one, which is any of them but `reference`.
  std::string kernel;
};

/// What became of it.
struct Verdict {
  bool reproduced = false;
  std::string message;  ///< a sentence: how many hashes are equal, or where it differs first
  std::size_t equal = 0;
  std::size_t compared = 0;
  std::uint64_t start = 0;  ///< step at which it began
  std::uint64_t end = 0;    ///< step that it came to
  double wall_s = 0;
  std::string kernel;
  int threads = 0;
};

/// Is told the step, the first step and the last.
using OnProgress = std::function<void(std::uint64_t, std::uint64_t, std::uint64_t)>;

/// Computes a recorded run again, from what the bag holds and nothing else, and compares every state hash,
/// the hash chain, and the fault that ended the run if one did.
/// @throws InvalidInput when the record does not allow that, with the reason.
Verdict resimulate(const Session& session, const RecordedRun& run, const ResimulationOptions& options,
                   const OnProgress& on_progress = {});

}  // namespace dmf::bag_tools
