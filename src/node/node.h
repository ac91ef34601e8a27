#pragma once
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <memory>

#include "chip/scene.h"
#include "node/checkpoint_topic.h"
#include "node/convert.h"
#include "node/engine_thread.h"
#include "node/options.h"
#include "node/publisher.h"
#include "node/services.h"

namespace dmf::node {

/// The chip as a ROS node. Three kinds of threads, each with one job:
///
///   service threads --requests--> engine thread --frames, commands, events--> publisher thread --> topics
///
/// The engine thread owns the experiment and never waits for the others.
class Node {
 public:
  /// Starts the run and everything around it. @throws engine::InvalidInput when the scene can't be run as
  /// asked.
  Node(const Options& options, const chip::Scene& scene);
  ~Node();

 private:
  static constexpr unsigned kServiceThreads = 4;  ///< one may be held by ~step for long

  chip::Scene scene_;
  ConversionContext context_;
  ros::NodeHandle handle_;
  ros::NodeHandle private_handle_;
  EngineThread engine_;
  Publisher publisher_;
  CheckpointTopic checkpoint_topic_;
  Services services_;
  ros::AsyncSpinner spinner_;
};

}  // namespace dmf::node
