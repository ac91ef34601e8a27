#include "controller/goal.h"

#include <fmt/format.h>

#include <cmath>

namespace dmf::controller {

namespace {

constexpr unsigned kMostRetries = 100;
constexpr unsigned kMostLaps = 1000;

using Violations = std::vector<std::string>;

bool check_channel(const std::string& key, Channel channel, const Layout& layout, Violations& found) {
  if (layout.has(channel)) return true;
  found.push_back(
      fmt::format("{}: {}, allowed: a channel of {}", key, channel, channels_text(layout.channels())));
  return false;
}

/// Every electrode of a way is a neighbour of the one before.
void check_way(const std::string& key, Channel from, const std::vector<Channel>& way, const Layout& layout,
               Violations& found) {
  for (const Channel channel : way) {
    if (!check_channel(key, channel, layout, found)) return;
    if (!layout.has(from)) return;
    if (!layout.are_neighbours(from, channel)) {
      found.push_back(fmt::format("{}: from {} to {}, allowed: a neighbour of {}, one of {}", key, from,
                                  channel, from, channels_text(layout.neighbours(from))));
      return;
    }
    from = channel;
  }
}

void check_limits(const Limits& limits, Violations& found) {
  const auto refuse = [&](const char* key, double value, const char* allowed) {
    found.push_back(fmt::format("{}: {}, allowed: {}", key, value, allowed));
  };
  if (!(limits.success_threshold > 0 && limits.success_threshold <= 1))
    refuse("success_threshold", limits.success_threshold, "(0, 1]");
  if (!(limits.step_timeout > 0 && std::isfinite(limits.step_timeout)))
    refuse("step_timeout", limits.step_timeout, "more than 0 s");
  if (!(limits.timeout >= 0 && std::isfinite(limits.timeout)))
    refuse("timeout", limits.timeout, "at least 0 s, 0 for none");
  if (limits.retries > kMostRetries) refuse("retries", limits.retries, "0 to 100");
}

struct Check {
  const Layout& layout;
  Violations& found;

  void operator()(const Move& goal) const {
    if (goal.path.empty()) {
      check_channel("to", goal.to, layout, found);
    } else {
      check_way("path", goal.channel, goal.path, layout, found);
    }
  }
  void operator()(const Split& goal) const {
    if (goal.onto.empty()) return;
    if (goal.onto.size() != 2 || goal.onto[0] == goal.onto[1]) {
      found.push_back(fmt::format("onto: [{}], allowed: two channels, or none", fmt::join(goal.onto, ", ")));
      return;
    }
    const std::size_t before = found.size();
    for (const Channel side : goal.onto) check_way("onto", goal.channel, {side}, layout, found);
    if (found.size() > before || !layout.has(goal.channel)) return;
    if (!layout.are_opposite(goal.channel, goal.onto[0], goal.onto[1])) {
      found.push_back(fmt::format("onto: [{}], allowed: neighbours on opposite sides of {}",
                                  fmt::join(goal.onto, ", "), goal.channel));
    }
  }
  void operator()(const Merge& goal) const {
    check_channel("into", goal.into, layout, found);
    if (goal.into == goal.channel)
      found.push_back(fmt::format("into: {}, allowed: another channel than the droplet's own", goal.into));
  }
  void operator()(const Dispense& goal) const {
    if (goal.path.size() < 2) {
      found.push_back(
          fmt::format("path: {} channels, allowed: 2 or more, one for the neck and one for the droplet",
                      goal.path.size()));
    }
    check_way("path", goal.reservoir, goal.path, layout, found);
    Channels once(goal.path.begin(), goal.path.end());
    once.insert(goal.reservoir);
    if (once.size() != goal.path.size() + 1)
      found.push_back(fmt::format("path: [{}], allowed: each channel once", fmt::join(goal.path, ", ")));
    if (!(goal.least >= 0) || !std::isfinite(goal.least))
      found.push_back(fmt::format("least: {}, allowed: at least 0 electrodes", goal.least));
    if (!(goal.most == 0 || (goal.most >= goal.least && std::isfinite(goal.most))))
      found.push_back(
          fmt::format("most: {}, allowed: at least {} electrodes, 0 for any", goal.most, goal.least));
  }
  void operator()(const Mix& goal) const {
    if (goal.laps < 1 || goal.laps > kMostLaps)
      found.push_back(fmt::format("laps: {}, allowed: 1 to {}", goal.laps, kMostLaps));
    std::vector<Channel> round = goal.loop;
    if (!round.empty()) round.push_back(goal.channel);
    if (layout.has(goal.channel)) check_way("loop", goal.channel, round, layout, found);
  }
};

}  // namespace

std::string name_of(const Goal& goal) {
  constexpr const char* kNames[] = {"move", "split", "merge", "dispense", "mix"};
  static_assert(std::variant_size_v<Goal> == std::size(kNames));
  return kNames[goal.index()];
}

Channel channel_of(const Goal& goal) {
  return std::visit(
      [](const auto& any) {
        if constexpr (std::is_same_v<std::decay_t<decltype(any)>, Dispense>) {
          return any.reservoir;
        } else {
          return any.channel;
        }
      },
      goal);
}

std::vector<std::string> violations(const Goal& goal, const Layout& layout) {
  Violations found;
  check_channel(std::holds_alternative<Dispense>(goal) ? "reservoir" : "channel", channel_of(goal), layout,
                found);
  std::visit(Check{layout, found}, goal);
  std::visit([&](const auto& any) { check_limits(any.limits, found); }, goal);
  return found;
}

}  // namespace dmf::controller
