#pragma once
#include <dmf_sim/DispenseAction.h>
#include <dmf_sim/MergeAction.h>
#include <dmf_sim/MixAction.h>
#include <dmf_sim/MoveDropletAction.h>
#include <dmf_sim/SplitAction.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "controller/coordinator.h"
#include "controller_node/board_client.h"
#include "controller_node/operation_server.h"
#include "controller_node/options.h"
#include "controller_node/protocol_server.h"

namespace dmf::controller_node {

/// Operations on droplets as actions, over the public services and topics of a board. Everything happens in
/// one thread, from one reading of the capacitance to the next:
///
///     reading -> droplets -> operations -> electrodes that shall be on -> ~set_electrodes of the board
class Node {
 public:
  /// Waits for the board. @throws InvalidInput, std::runtime_error when it is none that can be driven.
  explicit Node(const Options& options);

 private:
  void look(const controller::Reading& reading);
  void drive();
  void prepare();
  void publish_droplets(double time);

  Options options_;
  ros::NodeHandle handle_, private_handle_;
  BoardClient board_;
  controller::Coordinator coordinator_;
  Workplace workplace_;
  controller::Channels on_;  ///< as the board was last told
  bool has_told_ = false;
  bool had_rail_ = false;
  ros::Publisher droplets_;
  OperationServer<dmf_sim::MoveDropletAction> move_;
  OperationServer<dmf_sim::SplitAction> split_;
  OperationServer<dmf_sim::MergeAction> merge_;
  OperationServer<dmf_sim::DispenseAction> dispense_;
  OperationServer<dmf_sim::MixAction> mix_;
  ProtocolServer protocol_;
};

}  // namespace dmf::controller_node
