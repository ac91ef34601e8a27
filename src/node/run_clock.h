#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace dmf::node {

/// Turns chip time into ROS time. Chip time starts over with every reset and jumps with a restored
/// checkpoint; ROS time must do neither, because every tf buffer, filter and bag downstream takes a clock
/// that steps back for a new recording and throws its data away. So each run begins where the previous one
/// ended, also when that was another process's.
class RunClock {
 public:
  static constexpr std::uint64_t kStart = 1'000'000'000;  ///< ns; ROS reads time 0 as "no clock yet"
  static constexpr std::uint64_t kRunGap = 1'000'000;     ///< ns between two runs: no stamp is shared by both

  /// @param ros_seconds_per_time_unit  ROS seconds per tau, > 0. @param start  ns of ROS time at which the
  /// first run begins, at chip time `run_start` (tau).
  explicit RunClock(double ros_seconds_per_time_unit, std::uint64_t start = kStart, double run_start = 0)
      : scale_(ros_seconds_per_time_unit * 1e9), origin_(start), run_start_(run_start) {}

  /// ROS time in ns at a chip time (tau). Times before the run's start give its start.
  std::uint64_t nanoseconds(double time) const {
    return origin_ + static_cast<std::uint64_t>(std::llround(std::max(0.0, time - run_start_) * scale_));
  }

  /// A new run goes on from chip time `new_time` where the old one had come to `old_time` (tau).
  void start_run(double old_time, double new_time) {
    origin_ = nanoseconds(old_time) + kRunGap;
    run_start_ = new_time;
  }

 private:
  double scale_;          ///< ns per tau
  std::uint64_t origin_;  ///< ns at the start of the run
  double run_start_;      ///< tau at the start of the run
};

}  // namespace dmf::node
