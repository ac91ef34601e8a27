#include "controller/coordinator.h"

#include <fmt/format.h>

#include <algorithm>

#include "yaml/invalid_input.h"

namespace dmf::controller {

namespace {

/// For how long news of the rail may be late, s.
constexpr double kRailPatience = 0.3;

bool intersect(const Channels& a, const Channels& b) {
  return std::any_of(a.begin(), a.end(), [&](Channel channel) { return b.count(channel) > 0; });
}

}  // namespace

Coordinator::Coordinator(Layout layout, double wetted_fraction)
    : layout_(std::move(layout)), finder_(layout_, wetted_fraction), traffic_(layout_) {
  for (const Channel channel : layout_.channels()) wetting_[channel] = 0;
}

View Coordinator::view() {
  return {time_,     layout_, wetting_, finder_, rail_,      rail_is_off(),
          disabled_, true,    traffic_, dead_,   step_times_};
}

void Coordinator::update(const Reading& reading, const Rail& rail) {
  time_ = reading.time;
  rail_ = rail;
  if (rail.enabled && rail.voltage > 0) rail_on_ = time_;
  has_reading_ = true;
  wetting_ = wetting_of(layout_, reading);
  finder_.update(wetting_);

  View now = view();
  for (auto& [key, operation] : operations_) {
    if (!operation->is_running()) continue;
    now.alone = std::none_of(operations_.begin(), operations_.end(), [&, key = key](const auto& other) {
      return other.first != key && other.second->is_running() && !other.second->is_blocked();
    });
    operation->update(now);
    if (!operation->is_running()) holds_.insert(operation->on().begin(), operation->on().end());
  }
  traffic_.advance(obstacles(), dead_);
  update_holds();
}

bool Coordinator::rail_is_off() const {
  return !(rail_.enabled && rail_.voltage > 0) && time_ - rail_on_ > kRailPatience;
}

std::vector<Obstacle> Coordinator::obstacles() const {
  Channels walked_on;
  std::vector<Obstacle> obstacles;
  for (const auto& [key, operation] : operations_) {
    if (!operation->is_running()) continue;
    const Channels walks_on = operation->walks_on();
    walked_on.insert(walks_on.begin(), walks_on.end());
    Obstacle claimed{0, {}, key};
    for (const Channel channel : operation->claims())
      if (!walks_on.count(channel)) claimed.cells.insert(channel);
    for (const Channel channel : claimed.cells)
      if (const Droplet* droplet = finder_.on(channel)) claimed.droplet = droplet->id;
    if (!claimed.cells.empty()) obstacles.push_back(claimed);
  }
  for (const Droplet& droplet : finder_.droplets()) {
    if (intersect(droplet.channels, walked_on)) continue;
    Obstacle standing{droplet.id, droplet.channels, 0};
    for (const auto& [key, operation] : operations_)
      if (operation->is_running() && intersect(droplet.channels, operation->claims())) standing.owner = key;
    obstacles.push_back(standing);
  }
  return obstacles;
}

void Coordinator::update_holds() {
  Channels claimed;
  for (const auto& [key, operation] : operations_) {
    if (!operation->is_running()) continue;
    const Channels claims = operation->claims();
    claimed.insert(claims.begin(), claims.end());
  }
  Channels holds;
  for (const Droplet& droplet : finder_.droplets()) {
    if (intersect(droplet.channels, claimed)) continue;
    // The electrode that has held it goes on, so that it is not pulled to and fro.
    const auto held = std::find_if(droplet.channels.begin(), droplet.channels.end(),
                                   [&](Channel channel) { return holds_.count(channel) > 0; });
    holds.insert(held != droplet.channels.end() ? *held : droplet.main);
  }
  holds_ = std::move(holds);
}

Coordinator::Key Coordinator::start(const Goal& goal) {
  std::vector<std::string> wrong = violations(goal, layout_);
  if (!wrong.empty()) throw InvalidInput(fmt::format("{}", fmt::join(wrong, "\n")));
  if (!has_reading_) throw InvalidInput("the board has not sensed anything yet");
  const Channel channel = channel_of(goal);
  Channels wanted{channel};
  if (const auto* merge = std::get_if<Merge>(&goal)) wanted.insert(merge->into);
  for (const Channel of : wanted) {
    const Droplet* droplet = finder_.on(of);
    if (!droplet) {
      throw InvalidInput(
          fmt::format("no droplet on channel {}: {:.0f} % of it is wetted, a droplet wets {:.0f} % or more",
                      of, 100 * wetting_.at(of), 100 * finder_.threshold()));
    }
    for (const auto& [key, operation] : operations_) {
      if (operation->is_running() && intersect(droplet->channels, operation->claims())) {
        throw InvalidInput(fmt::format("droplet {} on channel {} is in the hands of another operation ({})",
                                       droplet->id, of, operation->status().text));
      }
    }
  }
  View now = view();
  operations_[next_key_] = make_operation(goal, next_key_, now);
  is_active_ = true;
  rail_on_ = time_;
  manual_.reset();
  update_holds();
  return next_key_++;
}

void Coordinator::cancel(Key key) {
  const auto found = operations_.find(key);
  if (found == operations_.end()) return;
  View now = view();
  found->second->cancel(now);
  holds_.insert(found->second->on().begin(), found->second->on().end());
  update_holds();
}

Report Coordinator::report(Key key) const {
  const Operation& operation = *operations_.at(key);
  const Channels cells = operation.is_running() ? operation.claims() : operation.on();
  Report report{operation.status(), {}};
  for (const Droplet& droplet : finder_.droplets())
    if (intersect(droplet.channels, cells)) report.droplets.push_back(droplet);
  return report;
}

void Coordinator::forget(Key key) {
  if (!is_running(key)) operations_.erase(key);
}

bool Coordinator::is_running(Key key) const {
  const auto found = operations_.find(key);
  return found != operations_.end() && found->second->is_running();
}

bool Coordinator::is_idle() const {
  return std::none_of(operations_.begin(), operations_.end(),
                      [](const auto& operation) { return operation.second->is_running(); });
}

void Coordinator::set_manual(std::optional<Channels> channels) {
  if (channels) {
    for (const Channel channel : *channels) layout_.require(channel);
    if (!is_idle()) throw InvalidInput("an operation runs: cancel it first");
    is_active_ = true;
    holds_.clear();
  }
  manual_ = std::move(channels);
}

std::optional<Channels> Coordinator::on() const {
  if (!is_active_) return std::nullopt;
  if (manual_) return manual_;
  Channels on = holds_;
  for (const auto& [key, operation] : operations_)
    if (operation->is_running()) on.insert(operation->on().begin(), operation->on().end());
  return on;
}

void Coordinator::note_disabled(const Channels& disabled) {
  for (const Channel channel : on().value_or(Channels{})) {
    if (disabled.count(channel)) {
      disabled_.insert(channel);
      dead_.insert(channel);
    } else if (disabled_.erase(channel)) {
      dead_.erase(channel);
    }
  }
}

void Coordinator::forget_dead_electrodes() {
  disabled_.clear();
  dead_.clear();
}

}  // namespace dmf::controller
