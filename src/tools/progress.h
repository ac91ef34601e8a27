#pragma once
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>

namespace dmf::tools {

/// A line on standard error that rewrites itself, at most five times a second; nothing when that is no
/// terminal.
class Progress {
 public:
  Progress(std::uint64_t from, std::uint64_t to, bool quiet)
      : from_(from), to_(to), shown_(!quiet && isatty(2)) {}
  ~Progress() {
    if (shown_) fmt::print(stderr, "\n");
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(std::uint64_t step) {
    if (!shown_ || (seconds_since(last_) < 0.2 && step != to_)) return;
    last_ = Clock::now();
    const double rate = static_cast<double>(step - from_) / std::max(1e-9, seconds_since(start_));
    fmt::print(stderr, "\r{} of {} steps, {:.0f} steps/s, {:.0f} s left   ", step, to_, rate,
               static_cast<double>(to_ - step) / std::max(1.0, rate));
    std::fflush(stderr);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }

  std::uint64_t from_, to_;
  bool shown_;
  Clock::time_point start_ = Clock::now(), last_ = start_ - std::chrono::seconds(1);
};

}  // namespace dmf::tools
