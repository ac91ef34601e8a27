#include <ros/init.h>
#include <ros/spinner.h>

#include <cstdio>
#include <exception>

#include "controller_node/node.h"
#include "controller_node/options.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "chip_controller");
  try {
    const dmf::controller_node::Node node(dmf::controller_node::load_options(ros::NodeHandle("~")));
    ros::spin();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "chip_controller: %s\n", error.what());
    return 1;
  }
  return 0;
}
