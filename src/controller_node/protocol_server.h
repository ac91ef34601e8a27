#pragma once
#include <actionlib/server/action_server.h>
#include <dmf_sim/RunProtocolAction.h>
#include <ros/node_handle.h>

#include <optional>
#include <string>

#include "controller/protocol_run.h"
#include "controller_node/operation_server.h"

namespace dmf::controller_node {

/// Protocols as an action, one at a time.
class ProtocolServer {
 public:
  /// @param directory  where protocols are looked up by name. @param max_voltage  V rms, of the rail.
  ProtocolServer(ros::NodeHandle handle, Workplace& workplace, std::string directory, double max_voltage);

  /// On by a reading.
  void update();
  std::optional<controller::Rail> wanted_rail() const;
  void report();

 private:
  using Server = actionlib::ActionServer<dmf_sim::RunProtocolAction>;

  void start(Server::GoalHandle goal);
  void cancel(Server::GoalHandle goal);
  controller::Protocol read(const dmf_sim::RunProtocolGoal& goal) const;

  Workplace& workplace_;
  std::string directory_;
  double max_voltage_;
  std::optional<controller::ProtocolRun> run_;
  Server::GoalHandle goal_;
  Server server_;
};

}  // namespace dmf::controller_node
