#include "node/services.h"

#include "node/start.h"

#include <fmt/format.h>

#include <stdexcept>

namespace dmf::node {

namespace {

template <class Response>
void copy(const chip::Reply& reply, Response& response) {
  response.success = reply.success;
  response.message = reply.message;
}

}  // namespace

// Each callback returns true: a refusal is an answer, not a failed call. Only std_srvs/Empty has no room for
// one; roscpp sends the text of an exception to the caller as the call's error.

Services::Services(ros::NodeHandle& private_handle, EngineThread& engine, const ConversionContext& context,
                   chip::CheckpointFolder checkpoints, CheckpointTopic& topic)
    : engine_(engine), context_(context), checkpoints_(std::move(checkpoints)), topic_(topic) {
  const auto advertise = [&](const char* name, auto callback) {
    servers_.push_back(private_handle.advertiseService(name, callback, this));
  };
  advertise("set_electrodes", &Services::set_electrodes);
  advertise("set_hv", &Services::set_hv);
  advertise("set_electrode_voltages", &Services::set_electrode_voltages);
  advertise("set_wettability", &Services::set_wettability);
  advertise("load_pattern", &Services::load_pattern);
  advertise("dispense_droplet", &Services::dispense_droplet);
  advertise("add_microparticle", &Services::add_microparticle);
  advertise("remove", &Services::remove);
  advertise("set_body_forces", &Services::set_body_forces);
  advertise("halt", &Services::halt);
  advertise("set_disabled_channels", &Services::set_disabled_channels);
  advertise("detect_shorts", &Services::detect_shorts);
  advertise("inject_fault", &Services::inject_fault);
  advertise("explain_droplet", &Services::explain_droplet);
  advertise("pause_physics", &Services::pause);
  advertise("unpause_physics", &Services::unpause);
  advertise("step", &Services::step);
  advertise("reset", &Services::reset);
  advertise("save_checkpoint", &Services::save_checkpoint);
  advertise("record_checkpoint", &Services::record_checkpoint);
  advertise("load_checkpoint", &Services::load_checkpoint);
  advertise("get_layout", &Services::get_layout);
  advertise("get_state", &Services::get_state);
}

bool Services::set_electrodes(dmf_sim::SetElectrodes::Request& request,
                              dmf_sim::SetElectrodes::Response& response) {
  const chip::Reply reply = engine_.apply(chip::SetElectrodes{request.channels});
  copy(reply, response);
  response.applied_channels = reply.applied_channels;
  return true;
}

bool Services::set_hv(dmf_sim::SetHv::Request& request, dmf_sim::SetHv::Response& response) {
  copy(engine_.apply(chip::SetHv{request.voltage, request.frequency, request.enabled != 0}), response);
  return true;
}

bool Services::set_electrode_voltages(dmf_sim::SetElectrodeVoltages::Request& request,
                                      dmf_sim::SetElectrodeVoltages::Response& response) {
  copy(engine_.apply(chip::SetElectrodeVoltages{request.channels, request.voltages}), response);
  return true;
}

bool Services::set_wettability(dmf_sim::SetWettability::Request& request,
                               dmf_sim::SetWettability::Response& response) {
  copy(engine_.apply(chip::SetWettability{request.positions, request.contact_angles_deg}), response);
  return true;
}

bool Services::load_pattern(dmf_sim::LoadPattern::Request& request,
                            dmf_sim::LoadPattern::Response& response) {
  copy(engine_.apply(chip::LoadPattern{request.name}), response);
  return true;
}

bool Services::dispense_droplet(dmf_sim::DispenseDroplet::Request& request,
                                dmf_sim::DispenseDroplet::Response& response) {
  copy(engine_.apply(
           chip::DispenseDroplet{request.x, request.y, request.volume, request.fills, request.species}),
       response);
  return true;
}

bool Services::add_microparticle(dmf_sim::AddMicroparticle::Request& request,
                                 dmf_sim::AddMicroparticle::Response& response) {
  if (request.contact_angle_deg != 0 && request.attraction_mdpd != 0) {
    response.message =
        fmt::format("contact_angle_deg {} and attraction_mdpd {}: allowed one of both, 0 for the other",
                    request.contact_angle_deg, request.attraction_mdpd);
    return true;
  }
  const chip::Reply reply = engine_.apply(to_command(request));
  copy(reply, response);
  response.microparticle = reply.microparticle;
  return true;
}

bool Services::remove(dmf_sim::Remove::Request& request, dmf_sim::Remove::Response& response) {
  copy(engine_.apply(chip::Remove{request.droplet, request.microparticle}), response);
  return true;
}

bool Services::set_body_forces(dmf_sim::SetBodyForces::Request& request,
                               dmf_sim::SetBodyForces::Response& response) {
  copy(engine_.apply(chip::SetBodyForces{to_array(request.gravity), to_array(request.magnetic)}), response);
  return true;
}

bool Services::halt(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  copy(engine_.apply(chip::Halt{}), response);
  return true;
}

bool Services::set_disabled_channels(dmf_sim::SetDisabledChannels::Request& request,
                                     dmf_sim::SetDisabledChannels::Response& response) {
  const chip::Reply reply = engine_.apply(chip::SetDisabledChannels{request.channels});
  copy(reply, response);
  response.disabled_channels = reply.disabled_channels;
  return true;
}

bool Services::detect_shorts(dmf_sim::DetectShorts::Request&, dmf_sim::DetectShorts::Response& response) {
  const chip::ShortsReport report = engine_.detect_shorts();
  response.success = report.success;
  response.message = report.message;
  response.channels = report.channels;
  return true;
}

bool Services::inject_fault(dmf_sim::InjectFault::Request& request,
                            dmf_sim::InjectFault::Response& response) {
  const chip::InjectFault fault{request.kind, request.channel, request.strength, request.all != 0};
  copy(engine_.apply(fault), response);
  return true;
}

bool Services::explain_droplet(dmf_sim::ExplainDroplet::Request& request,
                               dmf_sim::ExplainDroplet::Response& response) {
  const Explained explained = engine_.explain_droplet(request.droplet);
  response = to_response(explained.explanation, context_);
  response.success = explained.outcome.success;
  response.message = explained.outcome.message;
  return true;
}

bool Services::pause(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  engine_.pause();
  return true;
}

bool Services::unpause(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  const Outcome outcome = engine_.resume();
  if (!outcome.success) throw std::runtime_error(outcome.message);
  return true;
}

bool Services::step(dmf_sim::Step::Request& request, dmf_sim::Step::Response& response) {
  const Outcome outcome = engine_.advance(request.steps);
  response.success = outcome.success;
  response.message = outcome.message;
  response.step = outcome.step;
  return true;
}

bool Services::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  copy(engine_.apply(chip::Reset{}), response);
  return true;
}

bool Services::save_checkpoint(dmf_sim::Checkpoint::Request& request,
                               dmf_sim::Checkpoint::Response& response) {
  if (is_automatic(request.path)) {
    response.message = fmt::format(
        "path: \"{}\", allowed: a name that does not begin with \"{}\": those are written and taken away "
        "automatically",
        request.path, kAutomatic);
    return true;
  }
  const SavedRun run = engine_.save();
  response.message = run.outcome.message;
  if (!run.outcome.success) return true;
  const chip::Checkpoint& checkpoint = run.checkpoint;
  topic_.publish(checkpoint, checkpoint.run, checkpoint.ros_time, request.path);
  try {
    checkpoints_.write(request.path, checkpoint);  // on this thread: the engine does not wait for the disk
  } catch (const std::exception& error) {
    response.message = error.what();
    return true;
  }
  response.success = true;
  response.message =
      fmt::format("step {}, state hash {}, in {}", checkpoint.step, hash_text(checkpoint.state_hash),
                  (checkpoints_.path() / request.path).string());
  engine_.announce(dmf_sim::Event::CHECKPOINT_SAVED, response.message);
  return true;
}

bool Services::record_checkpoint(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  if (!topic_.wanted()) {
    response.message = "nobody listens to ~checkpoint, allowed: while a recorder does";
    return true;
  }
  const SavedRun run = engine_.save();
  const chip::Checkpoint& checkpoint = run.checkpoint;
  response.success = run.outcome.success;
  response.message = run.outcome.message;
  if (!run.outcome.success) return true;
  response.message = fmt::format("step {}, state hash {}", checkpoint.step, hash_text(checkpoint.state_hash));
  topic_.publish(checkpoint, checkpoint.run, checkpoint.ros_time, "");
  return true;
}

bool Services::load_checkpoint(dmf_sim::Checkpoint::Request& request,
                               dmf_sim::Checkpoint::Response& response) {
  chip::Checkpoint checkpoint;
  try {
    checkpoint = checkpoints_.read(request.path);
  } catch (const std::exception& error) {
    response.message = error.what();
    return true;
  }
  if (checkpoint.scene != context_.scene.name) {
    response.message = fmt::format("checkpoint \"{}\" is of scene {}, allowed: one of scene {}", request.path,
                                   checkpoint.scene, context_.scene.name);
    return true;
  }
  const Outcome outcome = engine_.load(checkpoint.state, request.path);
  if (outcome.success) topic_.publish(checkpoint, outcome.run, outcome.stamp, request.path);
  response.success = outcome.success;
  response.message = outcome.success ? fmt::format("goes on from step {}, state hash {}", outcome.step,
                                                   hash_text(checkpoint.state_hash))
                                     : outcome.message;
  return true;
}

bool Services::get_layout(dmf_sim::GetLayout::Request&, dmf_sim::GetLayout::Response& response) {
  response.layout = to_layout(context_);
  response.success = true;
  response.message = fmt::format("channels {}", context_.scene.layout.channels_text());
  return true;
}

bool Services::get_state(dmf_sim::GetState::Request& request, dmf_sim::GetState::Response& response) {
  const auto frame = engine_.inspect(request.hash != 0);
  response.state = to_state(*frame, context_);
  response.success = frame->fault.empty();
  response.message = frame->fault.empty()
                         ? fmt::format("step {}", frame->snapshot->step)
                         : "the state is the last sound one, the run was halted: " + frame->fault;
  return true;
}

}  // namespace dmf::node
