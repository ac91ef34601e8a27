#include "controller_node/node.h"

#include <dmf_sim/SensedDropletArray.h>
#include <ros/console.h>

#include <stdexcept>

namespace dmf::controller_node {

Node::Node(const Options& options)
    : options_(options),
      private_handle_("~"),
      board_(handle_, options.chip),
      coordinator_(controller::Layout(to_board(board_.layout())), options.wetted_fraction),
      workplace_{coordinator_, options.limits, [this] { prepare(); }, [this] { drive(); },
                 [this](controller::Channel channel) { return board_.explain(channel); }},
      droplets_(private_handle_.advertise<dmf_sim::SensedDropletArray>("droplets", 10)),
      move_(private_handle_, "move_droplet", workplace_),
      split_(private_handle_, "split", workplace_),
      merge_(private_handle_, "merge", workplace_),
      dispense_(private_handle_, "dispense", workplace_),
      mix_(private_handle_, "mix", workplace_),
      protocol_(private_handle_, workplace_, options.protocol_dir, board_.layout().max_voltage) {
  board_.on_reading([this](const controller::Reading& reading) { look(reading); });
}

void Node::look(const controller::Reading& reading) {
  // A board whose rail has gone off, halted or reset, may have switched its electrodes off as well.
  if (had_rail_ && !board_.rail().enabled) has_told_ = false;
  had_rail_ = board_.rail().enabled;
  coordinator_.update(reading, board_.rail());
  protocol_.update();
  if (const auto rail = protocol_.wanted_rail()) {
    const std::string refused = board_.set_rail(*rail);
    if (!refused.empty()) ROS_WARN_THROTTLE(1, "%s", refused.c_str());
  }
  drive();
  move_.report();
  split_.report();
  merge_.report();
  dispense_.report();
  mix_.report();
  protocol_.report();
  publish_droplets(reading.time);
}

void Node::drive() {
  const auto on = coordinator_.on();
  if (!on || (has_told_ && *on == on_)) return;
  try {
    board_.set_electrodes(*on);
    on_ = *on;
    has_told_ = true;
    coordinator_.note_disabled(board_.disabled());
  } catch (const std::runtime_error& refused) {
    ROS_WARN_THROTTLE(1, "%s", refused.what());  // told again at the next reading
  }
}

void Node::prepare() {
  // What has been found not to answer is tried again by who begins anew.
  if (coordinator_.is_idle()) coordinator_.forget_dead_electrodes();
  if (board_.rail().enabled && board_.rail().voltage > 0) return;
  const double voltage = options_.voltage > 0 ? options_.voltage : board_.layout().reference_voltage;
  const std::string refused = board_.set_rail({voltage, options_.frequency, true});
  if (!refused.empty()) throw InvalidInput("the high-voltage rail is off: " + refused);
}

void Node::publish_droplets(double time) {
  if (droplets_.getNumSubscribers() == 0) return;
  dmf_sim::SensedDropletArray message;
  message.header.stamp = ros::Time(time);
  message.header.frame_id = "chip";
  message.droplets = to_messages(coordinator_.droplets());
  droplets_.publish(message);
}

}  // namespace dmf::controller_node
