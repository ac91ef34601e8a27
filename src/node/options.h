#pragma once
#include <ros/node_handle.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "engine/simulation.h"
#include "node/engine_thread.h"

namespace dmf::node {

/// The node's private parameters. Read once, at the start.
struct Options {
  std::string scene = "electrode_line";  ///< ~scene: name of a shipped scene or path of a YAML file
  std::optional<std::uint64_t> seed;  ///< ~seed: in place of the scene's; a number, or text when beyond 2^31
  engine::Execution execution;        ///< ~threads (0 to 256, 0: all cores), ~kernel
  EngineSettings engine;              ///< ~paused, ~publish_rate, ~display_rate, ~max_steps_per_second,
                                      ///< ~ros_seconds_per_time_unit, ~checkpoint_period, ~hash_interval
  std::optional<double> display_scale;   ///< ~display_scale: metres on the screen per metre on the chip
  std::filesystem::path checkpoint_dir;  ///< ~checkpoint_dir; default: dmf_sim in $ROS_HOME or ~/.ros
  int checkpoint_keep = 3;               ///< ~checkpoint_keep: how many automatic checkpoints stay
  std::string resume = "false";          ///< ~resume: false, true or respawned, see node/start.h
  int respawn_from = -1;                 ///< ~respawn_from, see node/start.h; -1: not given
};

/// @throws engine::InvalidInput naming every parameter that is unknown, of the wrong type or out of range,
/// and what is allowed, on one line.
Options load_options(const ros::NodeHandle& private_handle);

}  // namespace dmf::node
