#include "node/node.h"

#include <ros/this_node.h>

#include <utility>

namespace dmf::node {

Node::Node(const Options& options, const chip::Scene& scene)
    : scene_(scene),
      context_{scene_, options.display_scale.value_or(fitting_display_scale(scene_)),
               options.engine.ros_seconds_per_time_unit, ros::WallTime::now().toNSec()},
      private_handle_("~"),
      memory_(ros::this_node::getName()),
      series_(automatic_checkpoints(options, ros::this_node::getName(), scene_)),
      start_(begin(options, scene_, series_, memory_)),
      writer_(series_),
      engine_(std::move(start_.experiment), start_.settings, &writer_),
      publisher_(handle_, private_handle_, engine_, context_, memory_, options.engine.hash_interval),
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
  const std::string saved = engine_.write_last_checkpoint();
  if (!saved.empty()) tell(saved);
}

}  // namespace dmf::node
