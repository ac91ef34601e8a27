#include "node/run_record_topic.h"

#include <cstdint>
#include <utility>

namespace dmf::node {

namespace {

constexpr std::uint32_t kQueue = 10000;
constexpr std::size_t kKept = 10000;  // hashes, 1 MB; each stands for all before it

}  // namespace

RunRecordTopic::RunRecordTopic(ros::NodeHandle& private_handle, bool wanted) : wanted_(wanted) {
  publisher_ = private_handle.advertise<dmf_sim::RunRecord>(
      "run_record", kQueue, [this](const ros::SingleSubscriberPublisher& subscriber) { greet(subscriber); });
}

void RunRecordTopic::add(const dmf_sim::Command& command) {
  if (wanted_) waiting_.push_back(command);
}

void RunRecordTopic::publish(dmf_sim::RunRecord message) {
  const dmf_sim::StateHash& hash = message.hashes.back();
  // Of one run after the other, and in a run by rising index. What no hash of an older run counts is lost
  // here.
  while (!waiting_.empty() &&
         (waiting_.front().run < message.run ||
          (waiting_.front().run == message.run && waiting_.front().index < hash.commands))) {
    if (waiting_.front().run == message.run) message.commands.push_back(std::move(waiting_.front()));
    waiting_.pop_front();
  }
  const std::lock_guard lock(mutex_);
  if (run_.run != message.run) {
    run_.commands.clear();
    hashes_.clear();
  }
  run_.header = message.header;
  run_.session = message.session;
  run_.run = message.run;
  run_.seed = message.seed;
  run_.commands.insert(run_.commands.end(), message.commands.begin(), message.commands.end());
  hashes_.push_back(hash);
  if (hashes_.size() > kKept) hashes_.pop_front();
  publisher_.publish(message);
}

void RunRecordTopic::greet(const ros::SingleSubscriberPublisher& subscriber) {
  const std::lock_guard lock(mutex_);
  if (hashes_.empty()) return;
  dmf_sim::RunRecord message = run_;
  message.hashes.assign(hashes_.begin(), hashes_.end());
  subscriber.publish(message);
}

}  // namespace dmf::node
