#pragma once
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <memory>

#include "chip/checkpoint_writer.h"
#include "chip/scene.h"
#include "node/checkpoint_topic.h"
#include "node/convert.h"
#include "node/engine_thread.h"
#include "node/master_memory.h"
#include "node/options.h"
#include "node/publisher.h"
#include "node/services.h"
#include "node/start.h"

namespace dmf::node {

/// The chip as a ROS node. Four kinds of threads, each with one job:
///
///   service threads --requests--> engine thread --frames, commands, events--> publisher thread --> topics
///                                              --states--> checkpoint writer --> disk
///
/// The engine thread owns the experiment and never waits for the others.
class Node {
 public:
  /// Starts the run and everything around it. @throws engine::InvalidInput when the scene can't be run as
  /// asked.
  Node(const Options& options, const chip::Scene& scene);
  /// Saves the run as it is.
  ~Node();

 private:
  static constexpr unsigned kServiceThreads = 4;  ///< one may be held by ~step for long

  chip::Scene scene_;
  ConversionContext context_;
  ros::NodeHandle handle_;
  ros::NodeHandle private_handle_;
  MasterMemory memory_;
  chip::CheckpointSeries series_;
  Start start_;  ///< its experiment goes to the engine thread
  chip::CheckpointWriter writer_;
  EngineThread engine_;
  Publisher publisher_;
  CheckpointTopic checkpoint_topic_;
  Services services_;
  ros::AsyncSpinner spinner_;
};

}  // namespace dmf::node
