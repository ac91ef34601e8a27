#include "chip/board.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <type_traits>
#include <variant>

namespace dmf::chip {

namespace {

constexpr double kThere = 0.05;  // degrees from its end at which a charging pad has arrived

}  // namespace

Board::Board(std::shared_ptr<const Scene> scene)
    : scene_(std::move(scene)), pads_(scene_->layout.electrodes().size()) {
  update_angles();
  if (scene_->program) apply(*scene_->program);
}

void Board::apply(const SetElectrodes& command) {
  for (Pad& pad : pads_) {
    pad.on = false;
    pad.own_voltage.reset();
  }
  for (const std::uint32_t channel : command.channels) pads_[scene_->layout.index_of(channel)].on = true;
  program_.reset();
  update_angles();
}

void Board::apply(const SetHv& command) {
  rail_ = {command.voltage, command.frequency, command.enabled, command.enabled ? "" : rail_.halted};
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

void Board::apply(const InjectFault& command) {
  if (command.all) {
    disconnected_ = false;
    for (Pad& pad : pads_) pad.faults = {};
  } else if (command.kind == fault::kDisconnected) {
    disconnected_ = true;
  } else {
    PadFaults& faults = pads_[scene_->layout.index_of(command.channel)].faults;
    if (command.kind == fault::kClear) faults = {};
    if (command.kind == fault::kStuckOn) faults.stuck_on = true;
    if (command.kind == fault::kStuckOff) faults.stuck_off = true;
    if (command.kind == fault::kShort) faults.shorted = true;
    if (command.kind == fault::kWeak) faults.strength = command.strength;
  }
  update_angles();
}

void Board::apply(const SetDisabledChannels& command) {
  for (Pad& pad : pads_) {
    // Who frees a channel does not switch it on.
    if (pad.disabled) {
      pad.on = false;
      pad.own_voltage.reset();
    }
    pad.disabled = false;
  }
  for (const std::uint32_t channel : command.channels)
    pads_[scene_->layout.index_of(channel)].disabled = true;
  update_angles();
}

void Board::apply(const Halt& command) {
  rail_.enabled = false;
  rail_.halted = command.reason.empty() ? "it was commanded" : command.reason;
  apply(SetElectrodes{});
}

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
  SetDisabledChannels disabled;
  for (std::size_t index = 0; index < pads_.size(); ++index) {
    const std::uint32_t channel = scene_->layout.electrodes()[index].channel;
    if (pads_[index].on) on.channels.push_back(channel);
    if (!pads_[index].own_voltage) continue;
    driven.channels.push_back(channel);
    driven.voltages.push_back(*pads_[index].own_voltage);
  }
  std::vector<Command> commands{SetHv{rail_.voltage, rail_.frequency, rail_.enabled}};
  if (!rail_.halted.empty()) commands.push_back(Halt{rail_.halted});
  if (disconnected_) commands.push_back(InjectFault{fault::kDisconnected});
  for (std::size_t index = 0; index < pads_.size(); ++index) {
    const std::uint32_t channel = scene_->layout.electrodes()[index].channel;
    const PadFaults& faults = pads_[index].faults;
    if (faults.stuck_on) commands.push_back(InjectFault{fault::kStuckOn, channel});
    if (faults.stuck_off) commands.push_back(InjectFault{fault::kStuckOff, channel});
    if (faults.shorted) commands.push_back(InjectFault{fault::kShort, channel});
    if (faults.strength < 1) commands.push_back(InjectFault{fault::kWeak, channel, faults.strength});
    if (pads_[index].disabled) disabled.channels.push_back(channel);
  }
  if (!disabled.channels.empty()) commands.push_back(disabled);
  commands.push_back(on);
  if (!driven.channels.empty()) commands.push_back(driven);
  if (program_) commands.push_back(*program_);
  return commands;
}

double Board::commanded_voltage(std::size_t index) const {
  const Pad& pad = pads_[index];
  return pad.own_voltage.value_or(rail_.enabled && pad.on ? rail_.voltage : 0.0);
}

double Board::voltage(std::size_t index) const {
  const Pad& pad = pads_[index];
  if (disconnected_ || pad.disabled || pad.faults.stuck_off) return 0;
  const bool from_rail = pad.faults.stuck_on && rail_.enabled;
  return pad.faults.strength * (from_rail ? rail_.voltage : commanded_voltage(index));
}

double Board::sensed_share(std::size_t index) const {
  const PadFaults& faults = pads_[index].faults;
  return disconnected_ || faults.stuck_off ? 0 : faults.strength;
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

double Board::target_number(std::size_t index) const {
  const Electrowetting& law = scene_->electrowetting;
  return std::min(law.number(voltage(index), rail_.frequency), law.saturation_number());
}

void Board::set_number(std::size_t index, double number) {
  const Electrowetting& law = scene_->electrowetting;
  const double target = target_number(index);
  const double end = law.contact_angle(voltage(index), rail_.frequency);
  const double angle = law.contact_angle_of_number(number);
  const bool there = number == target || std::abs(angle - end) < kThere;
  pads_[index].number = there ? target : number;
  pads_[index].angle = there ? end : angle;
}

void Board::update_angles() {
  const bool at_once = scene_->electrowetting.charging_time <= 0;
  for (std::size_t index = 0; index < pads_.size(); ++index) {
    set_number(index, at_once ? target_number(index) : pads_[index].number);
  }
}

void Board::charge_until(std::uint64_t step) {
  assert(step >= charged_step_);
  const double elapsed = static_cast<double>(step - charged_step_) * scene_->parameters.time_step;
  charged_step_ = step;
  if (!charging()) return;
  const double share = 1 - std::exp(-elapsed / scene_->electrowetting.charging_time);
  for (std::size_t index = 0; index < pads_.size(); ++index) {
    const double number = pads_[index].number;
    set_number(index, number + share * (target_number(index) - number));
  }
}

void Board::settle() {
  for (std::size_t index = 0; index < pads_.size(); ++index) set_number(index, target_number(index));
}

bool Board::charging() const {
  if (scene_->electrowetting.charging_time <= 0) return false;
  for (std::size_t index = 0; index < pads_.size(); ++index) {
    if (pads_[index].number != target_number(index)) return true;
  }
  return false;
}

PadCharge Board::charge() const {
  PadCharge charge;
  charge.step = charged_step_;
  for (const Pad& pad : pads_) charge.numbers.push_back(pad.number);
  return charge;
}

void Board::set_charge(const PadCharge& charge) {
  if (charge.numbers.size() != pads_.size()) {
    throw engine::InvalidInput(
        fmt::format("charge: {} numbers, allowed: {}", charge.numbers.size(), pads_.size()));
  }
  const double most = scene_->electrowetting.saturation_number();
  for (const double number : charge.numbers) {
    if (!(number >= 0 && number <= most))
      throw engine::InvalidInput(fmt::format("charge: {}, allowed: 0 to {}", number, most));
  }
  charged_step_ = charge.step;
  for (std::size_t index = 0; index < pads_.size(); ++index) set_number(index, charge.numbers[index]);
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
