#include "controller_node/board_client.h"

#include <dmf_sim/ExplainDroplet.h>
#include <dmf_sim/GetLayout.h>
#include <dmf_sim/SetElectrodes.h>
#include <dmf_sim/SetHv.h>
#include <ros/service.h>

#include <algorithm>
#include <stdexcept>

namespace dmf::controller_node {

BoardClient::BoardClient(ros::NodeHandle handle, const std::string& name) : handle_(handle, name) {
  ros::service::waitForService(handle_.resolveName("get_layout"));
  dmf_sim::GetLayout layout;
  if (!handle_.serviceClient<dmf_sim::GetLayout>("get_layout").call(layout) || !layout.response.success)
    throw std::runtime_error(handle_.resolveName("get_layout") + " does not answer");
  layout_ = layout.response.layout;

  set_hv_ = handle_.serviceClient<dmf_sim::SetHv>("set_hv");
  set_electrodes_ = handle_.serviceClient<dmf_sim::SetElectrodes>("set_electrodes");
  explain_ = handle_.serviceClient<dmf_sim::ExplainDroplet>("explain_droplet");
  electrodes_ = handle_.subscribe<dmf_sim::ElectrodeArray>(
      "electrodes", 1, [this](const dmf_sim::ElectrodeArrayConstPtr& message) {
        rail_ = to_rail(*message);
        disabled_.clear();
        for (const auto& electrode : message->electrodes)
          if (electrode.disabled) disabled_.insert(electrode.channel);
      });
  droplets_topic_ = handle_.subscribe<dmf_sim::DropletArray>(
      "droplets", 1, [this](const dmf_sim::DropletArrayConstPtr& message) { droplets_ = *message; });
}

void BoardClient::on_reading(std::function<void(const controller::Reading&)> callback) {
  reading_callback_ = std::move(callback);
  // Only the newest: what the liquid did before is over.
  capacitance_ = handle_.subscribe<dmf_sim::Capacitance>(
      "capacitance", 1,
      [this](const dmf_sim::CapacitanceConstPtr& message) { reading_callback_(to_reading(*message)); });
}

std::string BoardClient::set_rail(const controller::Rail& rail) {
  dmf_sim::SetHv call;
  call.request.voltage = rail.voltage;
  call.request.frequency = rail.frequency;
  call.request.enabled = rail.enabled;
  if (!set_hv_.call(call)) return set_hv_.getService() + " does not answer";
  if (!call.response.success) return call.response.message;
  rail_ = rail;
  return "";
}

void BoardClient::set_electrodes(const controller::Channels& channels) {
  dmf_sim::SetElectrodes call;
  call.request.channels = {channels.begin(), channels.end()};
  if (!set_electrodes_.call(call))
    throw std::runtime_error(set_electrodes_.getService() + " does not answer");
  if (!call.response.success) throw std::runtime_error(call.response.message);
}

std::string BoardClient::explain(controller::Channel channel) {
  for (const auto& droplet : droplets_.droplets) {
    if (!std::count(droplet.channels.begin(), droplet.channels.end(), channel)) continue;
    dmf_sim::ExplainDroplet call;
    call.request.droplet = droplet.id;
    if (explain_.call(call) && call.response.success) return call.response.message;
  }
  return "";
}

}  // namespace dmf::controller_node
