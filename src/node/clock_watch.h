#pragma once
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <rosgraph_msgs/Clock.h>

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace dmf::node {

/// Listens to /clock and knows who else publishes it: two clocks make time jump for every node. A `rosbag
/// play
/// --clock` beside the chip is how that happens.
class ClockWatch {
 public:
  /// @param on_conflict  is called with the name of each that begins to; on a thread of roscpp.
  ClockWatch(ros::NodeHandle& handle, std::function<void(const std::string&)> on_conflict);

  /// Names of those whose clock was heard within the last kMemory of wall time, sorted.
  std::vector<std::string> others() const;

  static constexpr std::chrono::seconds kMemory{3};

 private:
  using Clock = std::chrono::steady_clock;
  void hear(const ros::MessageEvent<const rosgraph_msgs::Clock>& event);

  std::function<void(const std::string&)> on_conflict_;
  mutable std::mutex mutex_;
  std::map<std::string, Clock::time_point> heard_;  ///< when each of the others was heard last
  ros::Subscriber subscriber_;
};

}  // namespace dmf::node
