#include <ros/init.h>
#include <ros/node_handle.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <thread>

#include "chip/scene.h"
#include "engine/wait_policy.h"
#include "node/node.h"
#include "node/options.h"
#include "node/process_memory.h"

namespace {

volatile std::sig_atomic_t asked_to_end = 0;

/// SIGINT, as Ctrl-C and roslaunch send it, and SIGTERM, which roscpp leaves alone: the node saves its run
/// and ends. A second one ends it at once.
void note_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { asked_to_end = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes is a write that fails, not the end of the run
}

}  // namespace

int main(int argc, char** argv) {
  dmf::engine::prefer_short_spinning(argv);
  dmf::node::give_freed_memory_back();
  ros::init(argc, argv, "chip", ros::init_options::NoSigintHandler);
  note_signals();
  try {
    const dmf::node::Options options = dmf::node::load_options(ros::NodeHandle("~"));
    const dmf::chip::Scene scene = dmf::chip::load_scene(options.scene);
    // Beside the run: stacks and heaps of some twenty threads, queues, messages on their way; and of each
    // thread of the engine.
    constexpr double kBeside = 1000, kPerThread = 100;  // MB
    const int threads = options.execution.threads > 0 ? options.execution.threads
                                                      : static_cast<int>(std::thread::hardware_concurrency());
    dmf::node::limit_memory(scene.parameters.max_memory + kBeside + kPerThread * threads);
    const dmf::node::Node node(options, scene);
    while (ros::ok() && !asked_to_end) ros::WallDuration(0.05).sleep();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "chip: %s\n", error.what());
    return 1;
  }
  return 0;
}
