#pragma once
#include <chrono>
#include <cstdint>

namespace dmf::node {

/// Steps per second of wall time over about the last half second.
class RateMeter {
 public:
  using Clock = std::chrono::steady_clock;

  /// Forgets what was measured: the run stood still.
  void restart(Clock::time_point now, std::uint64_t steps) {
    begin_ = now;
    begin_steps_ = steps;
    rate_ = 0;
  }

  /// @param steps  steps of the run so far.
  double update(Clock::time_point now, std::uint64_t steps) {
    const double seconds = std::chrono::duration<double>(now - begin_).count();
    // The first window after a restart may be short: a rough number beats a zero.
    if (seconds >= kWindow || (rate_ == 0 && seconds >= kFirstWindow)) {
      rate_ = static_cast<double>(steps - begin_steps_) / seconds;
      begin_ = now;
      begin_steps_ = steps;
    }
    return rate_;
  }

 private:
  static constexpr double kWindow = 0.5;       // s
  static constexpr double kFirstWindow = 0.1;  // s
  Clock::time_point begin_ = Clock::now();
  std::uint64_t begin_steps_ = 0;
  double rate_ = 0;
};

}  // namespace dmf::node
