#include "tools/study_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace dmf::tools {

std::string duration_text(double seconds) {
  const auto minutes = static_cast<long>(std::lround(seconds / 60));
  if (seconds < 120) return fmt::format("{:.0f} s", seconds);
  if (minutes < 120) return fmt::format("{} min", minutes);
  return fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

std::string progress_text(const std::string& study, std::size_t runs, const WorkDone& done, double seconds) {
  constexpr double kWidth = 24;
  constexpr double kTooEarly = 0.002;  // runs: a look or two of a long one
  const auto all = static_cast<double>(runs);
  const double share = std::clamp(done.in_all / all, 0.0, 1.0);
  const auto filled = static_cast<std::size_t>(std::lround(kWidth * share));
  const std::string bar =
      std::string(filled, '#') + std::string(static_cast<std::size_t>(kWidth) - filled, '.');
  const std::string left =
      done.this_time > kTooEarly
          ? fmt::format(", about {} left", duration_text(seconds * (all - done.in_all) / done.this_time))
          : "";
  return fmt::format("{} [{}] {:.1f} of {} runs, {}{}", study, bar, done.in_all, runs, duration_text(seconds),
                     left);
}

StudyProgress::StudyProgress(std::string study, std::size_t runs)
    : study_(std::move(study)), runs_(runs), terminal_(isatty(STDERR_FILENO)) {}

StudyProgress::~StudyProgress() { clear(); }

void StudyProgress::show(const WorkDone& done) {
  if (!terminal_ && !said_) return;
  said_ = false;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  clear();
  fmt::print(stderr, "{}{}", progress_text(study_, runs_, done, seconds), terminal_ ? "" : "\n");
  std::fflush(stderr);
}

void StudyProgress::say(const std::string& message) {
  clear();
  fmt::print(stderr, "{}\n", message);
  said_ = true;
}

void StudyProgress::clear() const {
  if (terminal_) fmt::print(stderr, "\r\033[K");
}

}  // namespace dmf::tools
