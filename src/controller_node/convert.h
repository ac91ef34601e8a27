#pragma once
#include <dmf_sim/Capacitance.h>
#include <dmf_sim/DispenseGoal.h>
#include <dmf_sim/ElectrodeArray.h>
#include <dmf_sim/Layout.h>
#include <dmf_sim/MergeGoal.h>
#include <dmf_sim/MixGoal.h>
#include <dmf_sim/MoveDropletGoal.h>
#include <dmf_sim/SensedDroplet.h>
#include <dmf_sim/SplitGoal.h>

#include "controller/coordinator.h"

/// Messages to plain values and back. Pure functions.
namespace dmf::controller_node {

controller::BoardDescription to_board(const dmf_sim::Layout& layout);
/// Its time is that of the header.
controller::Reading to_reading(const dmf_sim::Capacitance& message);
controller::Rail to_rail(const dmf_sim::ElectrodeArray& message);

/// What stands for the default in a message is replaced by it.
controller::Limits to_limits(const dmf_sim::OperationLimits& message, const controller::Limits& defaults);
controller::Goal to_goal(const dmf_sim::MoveDropletGoal& message, const controller::Limits& defaults);
controller::Goal to_goal(const dmf_sim::SplitGoal& message, const controller::Limits& defaults);
controller::Goal to_goal(const dmf_sim::MergeGoal& message, const controller::Limits& defaults);
controller::Goal to_goal(const dmf_sim::DispenseGoal& message, const controller::Limits& defaults);
controller::Goal to_goal(const dmf_sim::MixGoal& message, const controller::Limits& defaults);

std::vector<dmf_sim::SensedDroplet> to_messages(const std::vector<controller::Droplet>& droplets);

}  // namespace dmf::controller_node
