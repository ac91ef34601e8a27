#include <fmt/format.h>

#include <algorithm>
#include <queue>

#include "controller/operations.h"
#include "controller/walk.h"
#include "yaml/invalid_input.h"

namespace dmf::controller {

namespace {

/// A droplet on a way: move and mix.
class WalkOperation : public Operation {
 public:
  WalkOperation(Traffic::Key key, const Limits& limits, const Droplet& droplet, const Journey& journey,
                std::string done, View& view)
      : Operation(key, limits, view.time),
        walk_(key, limits, droplet, journey, view),
        done_(std::move(done)) {
    on_ = walk_.on();
  }

  Channels claims() const override { return walk_.cells(); }
  Channels walks_on() const override { return walk_.cells(); }
  bool is_blocked() const override { return walk_.is_blocked(); }
  Channels hold(const Wetting& wetting) const override { return {walk_.hold(wetting)}; }

 protected:
  void advance(View& view) override {
    const Walk::Result result = walk_.update(view);
    on_ = walk_.on();
    status_.text = walk_.text();
    if (result == Walk::Result::failed) return fail(walk_.text());
    if (result == Walk::Result::arrived) return succeed(done_);
    const auto done = static_cast<double>(walk_.steps_done());
    const auto left = static_cast<double>(walk_.steps_left(view));
    // A way that is found only at the next look is at least a step.
    status_.progress = std::max(status_.progress, done / (done + std::max(left, 1.0)));
    status_.time_left = left * view.step_times.mean();
  }

 private:
  Walk walk_;
  std::string done_;
};

/// The shortest way round from a channel back to it over other electrodes; empty when there is none.
std::vector<Channel> shortest_loop(const Layout& layout, Channel channel, const Channels& dead) {
  std::vector<Channel> best;
  for (const Channel first : layout.neighbours(channel)) {
    if (dead.count(first)) continue;
    std::map<Channel, Channel> before{{first, first}};
    std::queue<Channel> ahead({first});
    while (!ahead.empty()) {
      const Channel at = ahead.front();
      ahead.pop();
      if (at != first && layout.are_neighbours(at, channel)) {
        std::vector<Channel> loop{at};
        while (loop.back() != first) loop.push_back(before.at(loop.back()));
        std::reverse(loop.begin(), loop.end());
        if (best.empty() || loop.size() < best.size()) best = loop;
        break;
      }
      for (const Channel next : layout.neighbours(at))
        if (next != channel && !dead.count(next) && before.emplace(next, at).second) ahead.push(next);
    }
  }
  return best;
}

}  // namespace

std::unique_ptr<Operation> make_move(const Move& goal, Traffic::Key key, View& view) {
  const bool as_given = !goal.path.empty();
  Journey journey{goal.channel, as_given ? goal.path : std::vector<Channel>{goal.to}, as_given, 0, {}, 0};
  if (const Surroundings empty_board{{}, {}, view.dead}; !find_route(view.layout, journey, empty_board))
    throw InvalidInput(why_no_route(view.layout, journey, empty_board));
  return std::make_unique<WalkOperation>(key, goal.limits, *view.droplets.on(goal.channel), journey,
                                         fmt::format("moved to electrode {}", journey.over.back()), view);
}

std::unique_ptr<Operation> make_mix(const Mix& goal, Traffic::Key key, View& view) {
  std::vector<Channel> loop = goal.loop;
  if (loop.empty()) loop = shortest_loop(view.layout, goal.channel, view.dead);
  if (loop.empty()) {
    for (const Channel neighbour : view.layout.neighbours(goal.channel))
      if (loop.empty() && !view.dead.count(neighbour)) loop = {neighbour};
  }
  if (loop.empty()) throw InvalidInput(fmt::format("channel {} has no neighbour to mix over", goal.channel));
  Journey journey{goal.channel, {}, true, 0, {}, 0};
  for (unsigned lap = 0; lap < goal.laps; ++lap) {
    journey.over.insert(journey.over.end(), loop.begin(), loop.end());
    journey.over.push_back(goal.channel);
  }
  return std::make_unique<WalkOperation>(
      key, goal.limits, *view.droplets.on(goal.channel), journey,
      fmt::format("mixed in {} laps over electrodes {}, {}", goal.laps, goal.channel, fmt::join(loop, ", ")),
      view);
}

std::unique_ptr<Operation> make_operation(const Goal& goal, Traffic::Key key, View& view) {
  struct Make {
    Traffic::Key key;
    View& view;
    std::unique_ptr<Operation> operator()(const Move& goal) const { return make_move(goal, key, view); }
    std::unique_ptr<Operation> operator()(const Mix& goal) const { return make_mix(goal, key, view); }
    std::unique_ptr<Operation> operator()(const Merge& goal) const { return make_merge(goal, key, view); }
    std::unique_ptr<Operation> operator()(const Split& goal) const { return make_split(goal, key, view); }
    std::unique_ptr<Operation> operator()(const Dispense& goal) const {
      return make_dispense(goal, key, view);
    }
  };
  return std::visit(Make{key, view}, goal);
}

}  // namespace dmf::controller
