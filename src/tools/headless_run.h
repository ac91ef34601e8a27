#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "chip/experiment.h"

namespace dmf::tools {

/// What dmf_run was asked for.
struct RunOptions {
  std::string scene;
  std::optional<std::uint64_t> steps;  ///< this many in all, counted from the scene's start
  std::optional<double> until;         ///< tau, instead of steps
  std::optional<std::uint64_t> seed;
  int threads = 0;
  std::string kernel = "auto";
  std::string output;  ///< folder for droplets.csv, microparticles.csv, checkpoints; empty: none
  std::uint64_t checkpoint_every = 0;  ///< steps; 0: none
  double checkpoint_period = 0;        ///< s of wall time between two checkpoints; 0: none
  unsigned checkpoint_keep = 3;        ///< how many checkpoints stay; 0: all
  std::string resume;                  ///< folder with checkpoints to go on from, of `seed` if it is given
  bool json = false;                   ///< last line of standard output is JSON
  bool quiet = false;                  ///< no progress line
};

/// What came out.
struct RunResult {
  std::string scene;
  std::string kernel;
  int threads = 0;
  std::uint64_t beads = 0;  ///< moving
  std::uint64_t steps = 0;  ///< at the end
  double time = 0;          ///< tau
  double wall_s = 0;        ///< of this call
  double ns_per_bead_step = 0;
  double temperature = 0;
  std::uint64_t hash = 0;
  int interrupted_by = 0;  ///< the signal that ended it early; 0: it is complete
};

/// Runs a scene without ROS, by its own schedule. A progress line with steps/s and time left goes to standard
/// error when that is a terminal. Ends early on SIGINT and SIGTERM, with a checkpoint when there is an output
/// folder.
///
/// A run that goes on with `output` where it wrote before leaves the files of one that was never interrupted,
/// however it was: lines after the checkpoint are written again. A checkpoint that can't be written is told
/// on standard error, and the run goes on; a table that can't be written ends it, for its lines would be
/// lost.
/// @throws engine::InvalidInput for bad options, an output folder with a run that could be resumed or that
/// another process writes to; engine::Instability; std::runtime_error when a table, or the checkpoint of a
/// run that was interrupted, can't be written.
RunResult headless_run(const RunOptions& options);

/// {"scene": ..., "beads": ..., "steps": ..., "wall_s": ..., "ns_per_bead_step": ..., "temperature": ...,
/// "hash": ...}
std::string to_json(const RunResult& result);

}  // namespace dmf::tools
