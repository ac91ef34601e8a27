#pragma once
#include <chrono>
#include <cstddef>
#include <string>

#include "tools/processes.h"

namespace dmf::tools {

/// "45 s", "25 min", "3 h 20 min".
std::string duration_text(double seconds);
/// A study with so many runs after so many seconds, as a bar and in words. The time left follows from how
/// fast it went this time; at the start, while nothing is known of that, it is left out.
std::string progress_text(const std::string& study, std::size_t runs, const WorkDone& done, double seconds);

/// How far a study is, on standard error: on a terminal in a line that rewrites itself, elsewhere in one
/// after each message.
class StudyProgress {
 public:
  StudyProgress(std::string study, std::size_t runs);
  ~StudyProgress();
  StudyProgress(const StudyProgress&) = delete;
  StudyProgress& operator=(const StudyProgress&) = delete;

  void show(const WorkDone& done);
  /// In a line of its own.
  void say(const std::string& message);

 private:
  void clear() const;

  std::string study_;
  std::size_t runs_;
  bool terminal_, said_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace dmf::tools
