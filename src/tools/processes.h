#pragma once
#include <cstddef>
#include <functional>
#include <string>

namespace dmf::tools {

/// How much of some works is done, counted in works: 2.5 is two of them and half of a third.
struct WorkDone {
  double in_all = 0;
  double this_time = 0;  ///< without what those that were taken up again had done before
};

/// What run_in_processes() is to do.
struct Works {
  std::size_t count = 0;
  int at_a_time = 1;
  /// What it is called when it fails.
  std::function<std::string(std::size_t which)> name;
  /// Gives an answer. It is done in a copy of this process: what it changes in memory is lost.
  std::function<std::string(std::size_t which)> work;
  /// Takes the answers as they come, in this process.
  std::function<void(std::size_t which, const std::string& answer)> answered;
  /// Called five times a second while works are under way, and after each answer.
  std::function<void(const WorkDone&)> watch;
};

/// Does every work in a process of its own: the crash of one, or memory that runs out, leaves the others
/// alone. Those that are under way end with this process, however it ends. To be called while this process
/// has one thread.
/// @throws std::runtime_error with what the first work that failed has thrown, or the signal that ended it,
/// after those that were under way then; no others are begun.
void run_in_processes(const Works& works);

/// To be called by a work: the share of it that is done, 0 to 1. A work that is taken up again says first
/// what it had done before. Outside of run_in_processes() nobody hears it.
void tell_share_done(double share);

}  // namespace dmf::tools
