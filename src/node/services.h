#pragma once
#include <dmf_sim/AddMicroparticle.h>
#include <dmf_sim/Checkpoint.h>
#include <dmf_sim/DetectShorts.h>
#include <dmf_sim/DispenseDroplet.h>
#include <dmf_sim/ExplainDroplet.h>
#include <dmf_sim/GetLayout.h>
#include <dmf_sim/GetState.h>
#include <dmf_sim/InjectFault.h>
#include <dmf_sim/LoadPattern.h>
#include <dmf_sim/Remove.h>
#include <dmf_sim/SetBodyForces.h>
#include <dmf_sim/SetDisabledChannels.h>
#include <dmf_sim/SetElectrodeVoltages.h>
#include <dmf_sim/SetElectrodes.h>
#include <dmf_sim/SetHv.h>
#include <dmf_sim/SetWettability.h>
#include <dmf_sim/Step.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <std_srvs/Empty.h>
#include <std_srvs/Trigger.h>

#include <vector>

#include "chip/checkpoint_file.h"
#include "node/checkpoint_topic.h"
#include "node/convert.h"
#include "node/engine_thread.h"

namespace dmf::node {

/// The node's services: each turns its request into a call of the engine thread, and the answer into its
/// reply. Callbacks may run on several threads at once.
class Services {
 public:
  /// @param engine, context, topic  must outlive this.
  Services(ros::NodeHandle& private_handle, EngineThread& engine, const ConversionContext& context,
           chip::CheckpointFolder checkpoints, CheckpointTopic& topic);

 private:
  bool set_electrodes(dmf_sim::SetElectrodes::Request& request, dmf_sim::SetElectrodes::Response& response);
  bool set_hv(dmf_sim::SetHv::Request& request, dmf_sim::SetHv::Response& response);
  bool set_electrode_voltages(dmf_sim::SetElectrodeVoltages::Request& request,
                              dmf_sim::SetElectrodeVoltages::Response& response);
  bool set_wettability(dmf_sim::SetWettability::Request& request,
                       dmf_sim::SetWettability::Response& response);
  bool load_pattern(dmf_sim::LoadPattern::Request& request, dmf_sim::LoadPattern::Response& response);
  bool dispense_droplet(dmf_sim::DispenseDroplet::Request& request,
                        dmf_sim::DispenseDroplet::Response& response);
  bool add_microparticle(dmf_sim::AddMicroparticle::Request& request,
                         dmf_sim::AddMicroparticle::Response& response);
  bool remove(dmf_sim::Remove::Request& request, dmf_sim::Remove::Response& response);
  bool set_body_forces(dmf_sim::SetBodyForces::Request& request, dmf_sim::SetBodyForces::Response& response);
  bool halt(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool set_disabled_channels(dmf_sim::SetDisabledChannels::Request& request,
                             dmf_sim::SetDisabledChannels::Response& response);
  bool detect_shorts(dmf_sim::DetectShorts::Request& request, dmf_sim::DetectShorts::Response& response);
  bool inject_fault(dmf_sim::InjectFault::Request& request, dmf_sim::InjectFault::Response& response);
  bool explain_droplet(dmf_sim::ExplainDroplet::Request& request,
                       dmf_sim::ExplainDroplet::Response& response);
  bool pause(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);
  bool unpause(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);
  bool step(dmf_sim::Step::Request& request, dmf_sim::Step::Response& response);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool save_checkpoint(dmf_sim::Checkpoint::Request& request, dmf_sim::Checkpoint::Response& response);
  bool record_checkpoint(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool load_checkpoint(dmf_sim::Checkpoint::Request& request, dmf_sim::Checkpoint::Response& response);
  bool get_layout(dmf_sim::GetLayout::Request& request, dmf_sim::GetLayout::Response& response);
  bool get_state(dmf_sim::GetState::Request& request, dmf_sim::GetState::Response& response);

  EngineThread& engine_;
  const ConversionContext& context_;
  chip::CheckpointFolder checkpoints_;
  CheckpointTopic& topic_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace dmf::node
