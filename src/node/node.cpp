#include "node/node.h"

namespace dmf::node {

Node::Node(const Options& options, const chip::Scene& scene)
    : scene_(scene),
      context_{scene_, options.display_scale, options.engine.ros_seconds_per_time_unit,
               ros::WallTime::now().toNSec()},
      private_handle_("~"),
      engine_(std::make_unique<chip::Experiment>(scene_, options.execution, options.seed), options.engine),
      publisher_(handle_, private_handle_, engine_, context_, options.engine.hash_interval),
      checkpoint_topic_(private_handle_, engine_, context_),
      services_(private_handle_, engine_, context_, chip::CheckpointFolder(options.checkpoint_dir),
                checkpoint_topic_),
      spinner_(kServiceThreads) {
  spinner_.start();
}

Node::~Node() {
  engine_.stop();  // first: it frees service threads that wait for an answer
  spinner_.stop();
  publisher_.stop();
}

}  // namespace dmf::node
