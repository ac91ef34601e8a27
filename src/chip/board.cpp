#include "chip/board.h"

#include <algorithm>
#include <type_traits>
#include <variant>

namespace dmf::chip {

Board::Board(std::shared_ptr<const Scene> scene)
    : scene_(std::move(scene)), pads_(scene_->layout.electrodes().size()) {
  update_angles();
  if (scene_->program) apply(*scene_->program);
}

void Board::apply(const SetElectrodes& command) {
  for (Pad& pad : pads_) pad = Pad{};
  for (const std::uint32_t channel : command.channels) pads_[scene_->layout.index_of(channel)].on = true;
  program_.reset();
  update_angles();
}

void Board::apply(const SetHv& command) {
  rail_ = {command.voltage, command.frequency, command.enabled};
  program_.reset();
  update_angles();
}

void Board::apply(const SetElectrodeVoltages& command) {
  for (std::size_t i = 0; i < command.channels.size(); ++i) {
    pads_[scene_->layout.index_of(command.channels[i])].own_voltage = command.voltages[i];
  }
  program_.reset();
  update_angles();
}

void Board::apply(const SetWettability& command) { program_ = command; }

void Board::apply(const Command& command) {
  const auto pass_on = [this](const auto& given) {
    using Given = std::decay_t<decltype(given)>;
    constexpr bool kElsewhere = std::is_same_v<Given, LoadPattern> ||
                                std::is_same_v<Given, DispenseDroplet> ||
                                std::is_same_v<Given, AddMicroparticle> || std::is_same_v<Given, Remove> ||
                                std::is_same_v<Given, SetBodyForces> || std::is_same_v<Given, Reset>;
    if constexpr (kElsewhere) {
      throw engine::InvalidInput(name_of(given) + " is no command of a board");
    } else {
      apply(given);
    }
  };
  std::visit(pass_on, command);
}

std::vector<Command> Board::as_commands() const {
  SetElectrodes on;
  SetElectrodeVoltages driven;
  for (std::size_t index = 0; index < pads_.size(); ++index) {
    const std::uint32_t channel = scene_->layout.electrodes()[index].channel;
    if (pads_[index].on) on.channels.push_back(channel);
    if (!pads_[index].own_voltage) continue;
    driven.channels.push_back(channel);
    driven.voltages.push_back(*pads_[index].own_voltage);
  }
  std::vector<Command> commands{SetHv{rail_.voltage, rail_.frequency, rail_.enabled}, on};
  if (!driven.channels.empty()) commands.push_back(driven);
  if (program_) commands.push_back(*program_);
  return commands;
}

double Board::voltage(std::size_t index) const {
  const Pad& pad = pads_[index];
  return pad.own_voltage.value_or(rail_.enabled && pad.on ? rail_.voltage : 0.0);
}

double Board::contact_angle(std::size_t index) const {
  if (program_) return program_angle_at(scene_->layout.electrodes()[index].centroid.x());
  return pads_[index].angle;
}

double Board::contact_angle_at(const Vector2d& point) const {
  if (program_) return program_angle_at(point.x());
  const double rest = scene_->electrowetting.rest_angle;
  double angle = rest;
  double lowest = rest;
  const auto mix = [&](std::size_t index, double weight) {
    angle += weight * (pads_[index].angle - rest);
    lowest = std::min(lowest, pads_[index].angle);
  };
  scene_->layout.weights(point, mix);
  // A mean lies between what it is made of, up to rounding, which the engine would refuse beyond the
  // calibration's end.
  return std::clamp(angle, lowest, rest);
}

engine::ContactAngleField Board::field() const {
  return [board = *this](double x, double y) { return board.contact_angle_at({x, y}); };
}

void Board::update_angles() {
  for (std::size_t index = 0; index < pads_.size(); ++index) {
    pads_[index].angle = scene_->electrowetting.contact_angle(voltage(index));
  }
}

double Board::program_angle_at(double reduced_x) const {
  const double x = reduced_x * scene_->units.length_m;
  const std::vector<double>& positions = program_->positions;
  const std::vector<double>& angles = program_->contact_angles_deg;
  const std::size_t above = std::upper_bound(positions.begin(), positions.end(), x) - positions.begin();
  if (above == 0) return angles.front();
  if (above == positions.size()) return angles.back();
  const double along = (x - positions[above - 1]) / (positions[above] - positions[above - 1]);
  const auto [low, high] = std::minmax(angles[above - 1], angles[above]);
  return std::clamp(angles[above - 1] + along * (angles[above] - angles[above - 1]), low, high);
}

}  // namespace dmf::chip
