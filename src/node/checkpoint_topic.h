#pragma once
#include <dmf_sim/CheckpointFile.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/single_subscriber_publisher.h>

#include <cstdint>
#include <string>

#include "chip/checkpoint_file.h"
#include "node/convert.h"
#include "node/engine_thread.h"

namespace dmf::node {

/// The topic ~checkpoint: states that a recording can be re-simulated from. Nothing is put together for it
/// while nobody listens, and nothing is kept. Whoever joins in the middle of a run gets the state of the
/// moment: what came before it is a recording's only by its commands.
class CheckpointTopic {
 public:
  /// @param engine, context  must outlive this.
  CheckpointTopic(ros::NodeHandle& private_handle, EngineThread& engine, const ConversionContext& context);

  bool wanted() const { return publisher_.getNumSubscribers() > 0; }
  /// @param run    number of the run that goes on from it.
  /// @param stamp  ROS time of that moment, ns.
  /// @param name   of the file that was written or read; empty: none.
  void publish(const chip::Checkpoint& checkpoint, std::uint32_t run, std::uint64_t stamp,
               const std::string& name);

 private:
  dmf_sim::CheckpointFile to_message(const chip::Checkpoint& checkpoint, std::uint32_t run,
                                     std::uint64_t stamp, const std::string& name) const;
  void greet(const ros::SingleSubscriberPublisher& subscriber);

  EngineThread& engine_;
  const ConversionContext& context_;
  ros::Publisher publisher_;
};

}  // namespace dmf::node
