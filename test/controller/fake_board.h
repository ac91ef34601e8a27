#pragma once
#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "controller/coordinator.h"

namespace dmf::controller {

/// A grid of square pads of 1 mm, a row after the other from channel 0; holes have no pad.
inline BoardDescription grid_board(unsigned columns, unsigned rows, const Channels& holes = {}) {
  constexpr double kPitch = 1e-3, kGap = 1e-4;
  BoardDescription board;
  board.gap = kGap;
  board.sensing = {2e-5, 1e-6, 3e-13, 0};
  for (Channel channel = 0; channel < columns * rows; ++channel) {
    if (holes.count(channel)) continue;
    const unsigned column = channel % columns, row = channel / columns;
    const double x = column * kPitch, y = row * kPitch, half = (kPitch - kGap) / 2;
    Electrode pad{channel,
                  {{x - half, y - half}, {x + half, y - half}, {x + half, y + half}, {x - half, y + half}},
                  {}};
    const auto add = [&](bool inside, Channel neighbour) {
      if (inside && !holes.count(neighbour)) pad.neighbours.push_back(neighbour);
    };
    add(column > 0, channel - 1);
    add(column + 1 < columns, channel + 1);
    add(row > 0, channel - columns);
    add(row + 1 < rows, channel + columns);
    board.electrodes.push_back(pad);
  }
  return board;
}

/// A board of pads that hold liquid, as amounts of what one pad holds. Liquid flows from pads that are off to
/// neighbours that are on, and between those that are on until they are level: a droplet follows, stretches,
/// is torn and merges, which is all that a controller sees. No physics.
class FakeBoard {
 public:
  explicit FakeBoard(const BoardDescription& description) : description_(description), layout_(description) {}

  std::map<Channel, double> amount;  ///< in pads
  std::set<Channel> stuck_off;       ///< switched on, nothing happens
  std::set<Channel> disabled;        ///< refused by the board
  std::map<Channel, double> neck;    ///< so much stays on it while it is off, between neighbours that are on
  std::map<Channel, int> slow;       ///< answers only after so many times that it was switched on
  Rail rail{63, 1000, true};
  double time = 0;

  const Channels& on() const { return on_; }
  double total() const {
    double sum = 0;
    for (const auto& [channel, liquid] : amount) sum += liquid;
    return sum;
  }

  void set_electrodes(const Channels& channels) {
    Channels applied;
    for (const Channel channel : channels) {
      if (disabled.count(channel)) continue;
      applied.insert(channel);
      if (!on_.count(channel) && slow.count(channel)) --slow[channel];
    }
    on_ = applied;
  }

  void step(double seconds) {
    time += seconds;
    if (!rail.enabled) return;
    const auto pulls = [&](Channel channel) {
      const auto late = slow.find(channel);
      return on_.count(channel) && !stuck_off.count(channel) && (late == slow.end() || late->second < 0);
    };
    std::map<Channel, double> flow;
    for (const auto& [channel, liquid] : amount) {
      if (liquid <= 0) continue;
      std::vector<Channel> towards;
      for (const Channel neighbour : layout_.neighbours(channel))
        if (pulls(neighbour) && (!pulls(channel) || level(neighbour) < liquid)) towards.push_back(neighbour);
      for (const Channel neighbour : towards) {
        const double stays = towards.size() > 1 && neck.count(channel) ? neck.at(channel) : 0;
        const double whole = pulls(channel) ? 0.4 * (liquid - level(neighbour))
                                            : std::clamp(liquid - stays, 0.0, std::max(0.7 * liquid, 0.3));
        flow[channel] -= whole / static_cast<double>(towards.size());
        flow[neighbour] += whole / static_cast<double>(towards.size());
      }
    }
    for (const auto& [channel, change] : flow) amount[channel] += change;
  }

  Reading read() const {
    Reading reading{time, {}};
    const Sensing& sensing = description_.sensing;
    for (const Channel channel : layout_.channels()) {
      const double wetted = std::min(1.0, level(channel));
      reading.capacitance[channel] =
          sensing.offset + layout_.area(channel) * (wetted * sensing.liquid_capacitance +
                                                    (1 - wetted) * sensing.filler_capacitance);
    }
    return reading;
  }

 private:
  double level(Channel channel) const {
    const auto found = amount.find(channel);
    return found == amount.end() ? 0 : found->second;
  }

  BoardDescription description_;
  Layout layout_;
  Channels on_;
};

/// The coordinator and its board, reading by reading.
struct Bench {
  explicit Bench(const BoardDescription& description)
      : board(description), coordinator(Layout(description)) {}

  void look() {
    coordinator.update(board.read(), board.rail);
    if (const auto on = coordinator.on(); on && *on != board.on()) {
      board.set_electrodes(*on);
      coordinator.note_disabled(board.disabled);
    }
    if (coordinator.on()) each_look();
  }
  /// Until all operations are over; false when that takes longer than this.
  bool run(double seconds) {
    const double end = board.time + seconds;
    while (!coordinator.is_idle()) {
      if (board.time > end) return false;
      board.step(0.1);
      look();
    }
    return true;
  }
  Status status(Coordinator::Key key) const { return coordinator.report(key).status; }

  FakeBoard board;
  Coordinator coordinator;
  std::function<void()> each_look = [] {};
};

}  // namespace dmf::controller
