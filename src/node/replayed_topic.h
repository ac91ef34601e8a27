#pragma once
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/single_subscriber_publisher.h>

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>

namespace dmf::node {

/// A topic whose messages of the present run are told to every new subscriber first, in order, so that a
/// recording that starts late is complete. The messages have a field `run`.
template <class Message>
class ReplayedTopic {
 public:
  /// @param kept  of a run so many messages are remembered, the newest.
  ReplayedTopic(ros::NodeHandle& handle, const std::string& name, std::uint32_t queue, std::size_t kept)
      : kept_(kept) {
    publisher_ = handle.advertise<Message>(
        name, queue, [this](const ros::SingleSubscriberPublisher& subscriber) { replay(subscriber); });
  }

  void publish(const Message& message) {
    const std::lock_guard lock(mutex_);
    if (!history_.empty() && history_.back().run != message.run) history_.clear();
    history_.push_back(message);
    if (history_.size() > kept_) history_.pop_front();
    publisher_.publish(message);
  }

 private:
  void replay(const ros::SingleSubscriberPublisher& subscriber) {
    const std::lock_guard lock(mutex_);
    for (const Message& message : history_) subscriber.publish(message);
  }

  std::size_t kept_;
  std::mutex mutex_;  ///< the topic is published to, and history_ changed, under it
  std::deque<Message> history_;
  ros::Publisher publisher_;
};

}  // namespace dmf::node
