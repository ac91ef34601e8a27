#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace dmf::node {

/// What the master has to remember of a node that may be killed at any moment: how far its /clock and its run
/// numbers have come. A node that comes back goes on after both, so that neither steps back for those who
/// stayed. Kept as parameters /dmf_sim/NODE/clock and /dmf_sim/NODE/run. A master that does not answer is not
/// waited for.
class MasterMemory {
 public:
  /// Asks the master. @param node  "/chip".
  explicit MasterMemory(const std::string& node);

  /// No clock beyond this was told by an earlier process of this node, ns; nothing: there was none.
  std::optional<std::uint64_t> clock_reached() const { return clock_reached_; }
  std::optional<std::uint32_t> run_reached() const { return run_reached_; }

  /// Before this time is told (ns). What is noted lies ahead by a ROS second or more, so that the master is
  /// asked about once in a second of wall time at most, however fast the clock is.
  void before_clock(std::uint64_t nanoseconds);
  /// Before something of this run is told.
  void before_run(std::uint32_t run);

 private:
  using Clock = std::chrono::steady_clock;
  void set(const std::string& key, int value) const;

  std::string folder_;
  std::optional<std::uint64_t> clock_reached_;
  std::optional<std::uint32_t> run_reached_;
  std::uint64_t noted_clock_ = 0;        ///< ns
  std::uint64_t ahead_ = 1'000'000'000;  ///< ns
  std::optional<std::uint32_t> noted_run_;
  Clock::time_point last_note_;
};

}  // namespace dmf::node
