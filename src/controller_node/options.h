#pragma once
#include <ros/node_handle.h>

#include <string>

#include "controller/goal.h"

namespace dmf::controller_node {

/// The node's private parameters. Read once, at the start.
struct Options {
  std::string chip = "chip";     ///< ~chip: name of the board's node
  double wetted_fraction = 0.3;  ///< ~wetted_fraction, (0, 1): of a pad from which on a droplet is on it
  double voltage = 0;            ///< ~voltage, V rms, of a rail that is off when an operation begins; 0: the
                                 ///< layout's reference_voltage
  double frequency = 1000;       ///< ~frequency, Hz, of the same
  controller::Limits limits;  ///< ~success_threshold, ~step_timeout, ~retries: of goals that leave them open
  std::string protocol_dir = ".";  ///< ~protocol_dir: where protocols are looked up by name
};

/// @throws InvalidInput naming every parameter that is unknown, of the wrong type or out of range.
Options load_options(const ros::NodeHandle& private_handle);

}  // namespace dmf::controller_node
