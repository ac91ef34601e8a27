#pragma once
#include <dmf_sim/DropletArray.h>
#include <ros/node_handle.h>
#include <ros/service_client.h>
#include <ros/subscriber.h>

#include <functional>
#include <string>

#include "controller_node/convert.h"

namespace dmf::controller_node {

/// The board as its public services and topics show it: whatever answers like the node `chip`.
class BoardClient {
 public:
  /// Waits for the board and asks for its layout. @throws std::runtime_error when ROS shuts down before it
  /// answers, or it does not tell its electrodes.
  BoardClient(ros::NodeHandle handle, const std::string& name);

  const dmf_sim::Layout& layout() const { return layout_; }
  const controller::Rail& rail() const { return rail_; }
  /// From now on called for every reading.
  void on_reading(std::function<void(const controller::Reading&)> callback);

  /// "" when it was done, else why not.
  std::string set_rail(const controller::Rail& rail);
  /// Electrodes that the board does not switch on.
  const controller::Channels& disabled() const { return disabled_; }
  /// @throws std::runtime_error with the reason when nothing was switched.
  void set_electrodes(const controller::Channels& channels);
  /// What the board says to why the droplet on a channel does not move; "" when it can't tell.
  std::string explain(controller::Channel channel);

 private:
  dmf_sim::Layout layout_;
  controller::Rail rail_;
  controller::Channels disabled_;
  dmf_sim::DropletArray droplets_;  ///< only to find the id that explain() asks for
  ros::ServiceClient set_hv_, set_electrodes_, explain_;
  ros::Subscriber capacitance_, electrodes_, droplets_topic_;
  ros::NodeHandle handle_;
  std::function<void(const controller::Reading&)> reading_callback_;
};

}  // namespace dmf::controller_node
