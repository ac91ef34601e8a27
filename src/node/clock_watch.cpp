#include "node/clock_watch.h"

#include <ros/this_node.h>

#include <cstdint>
#include <utility>

namespace dmf::node {

namespace {

constexpr std::uint32_t kQueue = 100;

}  // namespace

ClockWatch::ClockWatch(ros::NodeHandle& handle, std::function<void(const std::string&)> on_conflict)
    : on_conflict_(std::move(on_conflict)) {
  subscriber_ = handle.subscribe("/clock", kQueue, &ClockWatch::hear, this);
}

void ClockWatch::hear(const ros::MessageEvent<const rosgraph_msgs::Clock>& event) {
  const std::string& name = event.getPublisherName();
  if (name == ros::this_node::getName()) return;
  bool news = false;
  {
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    const auto found = heard_.find(name);
    news = found == heard_.end() || now - found->second > kMemory;
    heard_[name] = now;
  }
  if (news) on_conflict_(name);
}

std::vector<std::string> ClockWatch::others() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> names;
  for (const auto& [name, last] : heard_) {
    if (Clock::now() - last <= kMemory) names.push_back(name);
  }
  return names;
}

}  // namespace dmf::node
