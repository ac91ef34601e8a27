#include "controller_node/protocol_server.h"

#include <filesystem>

namespace dmf::controller_node {

ProtocolServer::ProtocolServer(ros::NodeHandle handle, Workplace& workplace, std::string directory,
                               double max_voltage)
    : workplace_(workplace),
      directory_(std::move(directory)),
      max_voltage_(max_voltage),
      server_(
          handle, "run_protocol", [this](Server::GoalHandle goal) { start(goal); },
          [this](Server::GoalHandle goal) { cancel(goal); }, false) {
  server_.start();
}

controller::Protocol ProtocolServer::read(const dmf_sim::RunProtocolGoal& goal) const {
  const controller::Layout& layout = workplace_.coordinator.layout();
  if (goal.protocol.empty() == goal.yaml.empty())
    throw InvalidInput("protocol and yaml: allowed: one of both");
  if (!goal.yaml.empty()) return controller::parse_protocol(goal.yaml, "yaml", layout, max_voltage_);
  std::filesystem::path file = goal.protocol;
  if (!file.has_parent_path()) file = std::filesystem::path(directory_) / file.replace_extension(".yaml");
  return controller::load_protocol(file.string(), layout, max_voltage_);
}

void ProtocolServer::start(Server::GoalHandle goal) {
  try {
    if (run_) throw InvalidInput("a protocol is under way: cancel it first");
    run_.emplace(read(*goal.getGoal()), workplace_.coordinator);
    goal_ = goal;
    goal_.setAccepted();
  } catch (const InvalidInput& refused) {
    dmf_sim::RunProtocolResult result;
    result.message = refused.what();
    goal.setRejected(result, result.message);
  }
}

void ProtocolServer::cancel(Server::GoalHandle goal) {
  if (!run_ || goal_ != goal) return;
  run_->cancel();
  workplace_.drive();
  report();
}

void ProtocolServer::update() {
  if (run_) run_->update();
}

std::optional<controller::Rail> ProtocolServer::wanted_rail() const {
  return run_ ? run_->wanted_rail() : std::nullopt;
}

void ProtocolServer::report() {
  if (!run_) return;
  const controller::Status status = run_->status();
  if (run_->is_running()) {
    dmf_sim::RunProtocolFeedback feedback;
    feedback.step = static_cast<std::uint32_t>(run_->step() + 1);
    feedback.steps = static_cast<std::uint32_t>(run_->protocol().steps.size());
    feedback.name = run_->protocol().steps[run_->step()].name;
    feedback.progress = status.progress;
    feedback.time_left = status.time_left;
    feedback.text = status.text;
    return goal_.publishFeedback(feedback);
  }
  dmf_sim::RunProtocolResult result;
  result.message = status.text;
  result.steps_done = static_cast<std::uint32_t>(run_->step());
  run_.reset();
  if (status.state == controller::State::succeeded) return goal_.setSucceeded(result, result.message);
  if (status.state == controller::State::cancelled) return goal_.setCanceled(result, result.message);
  goal_.setAborted(result, result.message);
}

}  // namespace dmf::controller_node
