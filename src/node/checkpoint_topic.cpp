#include "node/checkpoint_topic.h"

namespace dmf::node {

namespace {

constexpr std::uint32_t kQueue = 10;  // states may be large: a subscriber that is this far behind loses some

}  // namespace

CheckpointTopic::CheckpointTopic(ros::NodeHandle& private_handle, EngineThread& engine,
                                 const ConversionContext& context)
    : engine_(engine), context_(context) {
  publisher_ = private_handle.advertise<dmf_sim::CheckpointFile>(
      "checkpoint", kQueue, [this](const ros::SingleSubscriberPublisher& subscriber) { greet(subscriber); });
}

void CheckpointTopic::publish(const chip::Checkpoint& checkpoint, std::uint32_t run, std::uint64_t stamp,
                              const std::string& name) {
  if (wanted()) publisher_.publish(to_message(checkpoint, run, stamp, name));
}

dmf_sim::CheckpointFile CheckpointTopic::to_message(const chip::Checkpoint& checkpoint, std::uint32_t run,
                                                    std::uint64_t stamp, const std::string& name) const {
  dmf_sim::CheckpointFile message;
  message.header.stamp = to_ros_time(stamp);
  message.header.frame_id = kChipFrame;
  message.session = context_.session;
  message.run = run;
  message.step = checkpoint.step;
  message.name = name;
  const std::string data = chip::encode(checkpoint);
  message.data.assign(data.begin(), data.end());
  return message;
}

void CheckpointTopic::greet(const ros::SingleSubscriberPublisher& subscriber) {
  try {
    const SavedRun run = engine_.save();
    // From its first step a run follows from the scene; a halted one has no state worth keeping.
    if (!run.outcome.success || run.outcome.step == 0) return;
    subscriber.publish(to_message(run.checkpoint, run.checkpoint.run, run.checkpoint.ros_time, ""));
  } catch (const EngineStopped&) {
    // There will be no more to tell.
  }
}

}  // namespace dmf::node
