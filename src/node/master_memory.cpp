#include "node/master_memory.h"

#include <XmlRpcValue.h>
#include <ros/master.h>
#include <ros/param.h>
#include <ros/this_node.h>

#include <algorithm>
#include <limits>

namespace dmf::node {

namespace {
constexpr std::uint64_t kSecond = 1'000'000'000;
}

MasterMemory::MasterMemory(const std::string& node) : folder_("/dmf_sim" + node + "/") {
  int value = 0;
  if (ros::param::get(folder_ + "clock", value) && value > 0)
    clock_reached_ = static_cast<std::uint64_t>(value) * kSecond;
  if (ros::param::get(folder_ + "run", value) && value >= 0) run_reached_ = static_cast<std::uint32_t>(value);
}

void MasterMemory::before_clock(std::uint64_t nanoseconds) {
  if (nanoseconds <= noted_clock_) return;
  const Clock::time_point now = Clock::now();
  if (noted_clock_ > 0 && now - last_note_ < std::chrono::seconds(1)) ahead_ *= 2;
  last_note_ = now;
  // XML-RPC has whole numbers of 32 bits, and writes others with few digits.
  constexpr std::uint64_t kLatest = std::numeric_limits<int>::max();
  const std::uint64_t seconds = std::min(kLatest, (nanoseconds + ahead_) / kSecond + 1);
  noted_clock_ = std::max(nanoseconds, seconds * kSecond);
  set("clock", static_cast<int>(seconds));
}

void MasterMemory::before_run(std::uint32_t run) {
  if (noted_run_ == run) return;
  noted_run_ = run;
  set("run", static_cast<int>(run));
}

void MasterMemory::set(const std::string& key, int value) const {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  request[1] = folder_ + key;
  request[2] = value;
  ros::master::execute("setParam", request, response, payload, /*wait_for_master=*/false);
}

}  // namespace dmf::node
