#pragma once
#include <dmf_sim/RunRecord.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/single_subscriber_publisher.h>

#include <deque>
#include <mutex>

namespace dmf::node {

/// The topic ~run_record. What a new subscriber is told of the present run is one message, and not one for
/// each hash and command: recorders have room for a hundred that come at once.
class RunRecordTopic {
 public:
  /// @param wanted  false: there will be no hashes, so nothing is kept for them.
  RunRecordTopic(ros::NodeHandle& private_handle, bool wanted);

  /// Kept until a hash counts it.
  void add(const dmf_sim::Command& command);
  /// Publishes a hash with the commands since the one before. @param message  as to_run_record() makes it.
  void publish(dmf_sim::RunRecord message);

 private:
  void greet(const ros::SingleSubscriberPublisher& subscriber);

  bool wanted_;
  std::mutex mutex_;        ///< the topic is published to, and the run so far changed, under it
  dmf_sim::RunRecord run_;  ///< its header and commands
  std::deque<dmf_sim::StateHash> hashes_;  ///< of the run, the newest
  std::deque<dmf_sim::Command> waiting_;
  ros::Publisher publisher_;
};

}  // namespace dmf::node
