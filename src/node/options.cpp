#include "node/options.h"

#include <cstdlib>
#include <limits>

#include "node/parameter_reader.h"

namespace dmf::node {

namespace {

std::string default_checkpoint_dir() {
  if (const char* ros_home = std::getenv("ROS_HOME")) return std::string(ros_home) + "/dmf_sim";
  const char* home = std::getenv("HOME");
  return std::string(home ? home : ".") + "/.ros/dmf_sim";
}

}  // namespace

Options load_options(const ros::NodeHandle& private_handle) {
  Options options;
  ParameterReader reader(private_handle);
  reader.text("scene", options.scene);
  reader.seed("seed", options.seed);
  reader.integer("threads", 0, 256, options.execution.threads);
  reader.text("kernel", options.execution.kernel);
  reader.flag("paused", options.engine.paused);
  reader.number("publish_rate", 0.1, 1000, options.engine.publish_rate);
  reader.number("display_rate", 0.1, 1000, options.engine.display_rate);
  reader.number("max_steps_per_second", 0, 1e9, options.engine.max_steps_per_second);
  reader.number("ros_seconds_per_time_unit", 1e-6, 1e3, options.engine.ros_seconds_per_time_unit);
  double display_scale = 0;  // not given
  reader.number("display_scale", 1, 1e6, display_scale);
  if (display_scale > 0) options.display_scale = display_scale;
  int hash_interval = static_cast<int>(options.engine.hash_interval);
  reader.integer("hash_interval", 0, 1'000'000'000, hash_interval);
  options.engine.hash_interval = static_cast<std::uint32_t>(hash_interval);
  std::string checkpoint_dir = default_checkpoint_dir();
  reader.text("checkpoint_dir", checkpoint_dir);
  options.checkpoint_dir = checkpoint_dir;
  reader.number("checkpoint_period", 0, 1e6, options.engine.checkpoint_period);
  reader.integer("checkpoint_keep", 1, 1000, options.checkpoint_keep);
  reader.choice("resume", {"false", "true", "respawned"}, options.resume);
  reader.integer("respawn_from", 0, std::numeric_limits<int>::max(), options.respawn_from);
  reader.finish();
  return options;
}

}  // namespace dmf::node
