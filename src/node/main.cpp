#include <ros/init.h>
#include <ros/node_handle.h>

#include <cstdio>
#include <exception>

#include "chip/scene.h"
#include "engine/wait_policy.h"
#include "node/memory_limit.h"
#include "node/node.h"
#include "node/options.h"

int main(int argc, char** argv) {
  dmf::engine::prefer_short_spinning(argv);
  ros::init(argc, argv, "chip");
  try {
    const dmf::node::Options options = dmf::node::load_options(ros::NodeHandle("~"));
    const dmf::chip::Scene scene = dmf::chip::load_scene(options.scene);
    // Beside the run: stacks and heaps of some twenty threads, queues, messages on their way.
    constexpr double kBeside = 1000;  // MB
    dmf::node::limit_memory(scene.parameters.max_memory + kBeside);
    const dmf::node::Node node(options, scene);
    ros::waitForShutdown();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "chip: %s\n", error.what());
    return 1;
  }
  return 0;
}
