#pragma once
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "node/clock_watch.h"
#include "node/convert.h"
#include "node/engine_thread.h"
#include "node/master_memory.h"
#include "node/run_record_topic.h"

namespace dmf::node {

/// The node's topics, on a thread of their own: takes frames, commands and events out of the engine's outbox
/// and publishes them, so that the engine waits neither for serialisation nor for a subscriber.
class Publisher {
 public:
  /// @param engine, context, memory  must outlive this.
  /// @param hash_interval            of the engine thread's settings.
  Publisher(ros::NodeHandle& handle, ros::NodeHandle& private_handle, EngineThread& engine,
            const ConversionContext& context, MasterMemory& memory, std::uint32_t hash_interval);
  ~Publisher();
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  void stop();  ///< idempotent

 private:
  using Clock = std::chrono::steady_clock;

  void loop();
  void publish(const Outbox::Delivery& delivery);
  void publish_clock(std::uint64_t nanoseconds);
  void publish_command(const CommandNote& note);
  void publish_frame(const Frame& frame);
  void publish_electrodes(const Frame& frame);
  void publish_transforms(const Frame& frame);
  void publish_markers(const Frame& frame);
  void publish_diagnostics(const Frame& frame);
  /// Tells a new subscriber of ~commands the run so far.
  void replay_commands(const ros::SingleSubscriberPublisher& subscriber);
  void announce_clock(const std::string& other);

  EngineThread& engine_;
  const ConversionContext& context_;
  MasterMemory& memory_;
  ros::Publisher clock_, state_, electrodes_, droplets_, microparticles_, particles_, markers_, commands_,
      events_, layout_, scene_, diagnostics_, capacitance_;
  RunRecordTopic run_record_;
  ClockWatch clock_watch_;
  tf2_ros::TransformBroadcaster transforms_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;

  std::mutex history_mutex_;               ///< commands_ is published to, and history_ changed, under it
  std::vector<dmf_sim::Command> history_;  ///< of the present run

  // Of the publisher thread.
  dmf_sim::ElectrodeArray last_electrodes_;
  bool electrodes_published_ = false;
  std::set<std::uint32_t> drawn_droplets_, drawn_microparticles_, drawn_membranes_;
  bool drawn_chains_ = false;
  std::uint32_t marker_subscribers_ = 0;
  std::uint64_t transform_stamp_ = 0;  ///< ns
  Clock::time_point next_diagnostics_ = Clock::now();
  Clock::time_point next_chip_markers_ = Clock::now();
  bool chip_changed_ = true;  ///< electrodes to be drawn again

  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace dmf::node
