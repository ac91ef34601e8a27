#include "controller_node/convert.h"

namespace dmf::controller_node {

controller::BoardDescription to_board(const dmf_sim::Layout& layout) {
  controller::BoardDescription board;
  for (const auto& electrode : layout.electrodes) {
    controller::Electrode pad{electrode.channel, {}, electrode.neighbours};
    for (const auto& corner : electrode.outline) pad.outline.push_back({corner.x, corner.y});
    board.electrodes.push_back(pad);
  }
  board.gap = layout.gap;
  board.sensing = {layout.liquid_capacitance, layout.filler_capacitance, layout.capacitance_offset,
                   layout.capacitance_noise};
  board.threshold_voltage = layout.threshold_voltage;
  return board;
}

controller::Reading to_reading(const dmf_sim::Capacitance& message) {
  controller::Reading reading{message.header.stamp.toSec(), {}};
  for (std::size_t k = 0; k < message.channels.size() && k < message.capacitance.size(); ++k)
    reading.capacitance[message.channels[k]] = message.capacitance[k];
  return reading;
}

controller::Rail to_rail(const dmf_sim::ElectrodeArray& message) {
  return {message.hv_voltage, message.hv_frequency, message.hv_enabled != 0};
}

controller::Limits to_limits(const dmf_sim::OperationLimits& message, const controller::Limits& defaults) {
  controller::Limits limits = defaults;
  if (message.success_threshold != 0) limits.success_threshold = message.success_threshold;
  if (message.step_timeout != 0) limits.step_timeout = message.step_timeout;
  if (message.retries > 0) limits.retries = static_cast<unsigned>(message.retries);
  if (message.retries < 0) limits.retries = 0;
  limits.timeout = message.timeout;
  return limits;
}

controller::Goal to_goal(const dmf_sim::MoveDropletGoal& message, const controller::Limits& defaults) {
  return controller::Move{message.channel, message.target, message.path, to_limits(message.limits, defaults)};
}

controller::Goal to_goal(const dmf_sim::SplitGoal& message, const controller::Limits& defaults) {
  return controller::Split{message.channel, message.onto, to_limits(message.limits, defaults)};
}

controller::Goal to_goal(const dmf_sim::MergeGoal& message, const controller::Limits& defaults) {
  return controller::Merge{message.channel, message.into, to_limits(message.limits, defaults)};
}

controller::Goal to_goal(const dmf_sim::DispenseGoal& message, const controller::Limits& defaults) {
  return controller::Dispense{message.reservoir, message.path, message.least, message.most,
                              to_limits(message.limits, defaults)};
}

controller::Goal to_goal(const dmf_sim::MixGoal& message, const controller::Limits& defaults) {
  return controller::Mix{message.channel, message.loop, message.laps ? message.laps : 1,
                         to_limits(message.limits, defaults)};
}

std::vector<dmf_sim::SensedDroplet> to_messages(const std::vector<controller::Droplet>& droplets) {
  std::vector<dmf_sim::SensedDroplet> messages;
  for (const controller::Droplet& droplet : droplets) {
    dmf_sim::SensedDroplet message;
    message.id = droplet.id;
    message.channels = {droplet.channels.begin(), droplet.channels.end()};
    message.channel = droplet.main;
    message.covered = droplet.covered;
    messages.push_back(message);
  }
  return messages;
}

}  // namespace dmf::controller_node
