#include "controller/route.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>

namespace dmf::controller {

namespace {

/// Where the search is: on an electrode, having passed so many of the electrodes that it has to go over.
struct Place {
  Channel cell;
  std::size_t passed;
  bool operator<(const Place& other) const {
    return std::tie(cell, passed) < std::tie(other.cell, other.passed);
  }
};

/// Answers what a droplet may do at which time. From `horizon()` on nothing moves any more, so that all later
/// times are one and the search is finite.
class Rules {
 public:
  Rules(const Layout& layout, const Journey& journey, const Surroundings& surroundings)
      : layout_(layout), reach_(journey.reach) {
    for (const Channel cell : surroundings.dead) barred_.insert(cell);
    for (const Obstacle& obstacle : surroundings.obstacles) {
      if (journey.may_touch.count(obstacle.droplet)) continue;
      if (obstacle.owner && obstacle.owner == journey.owner) continue;
      for (const Channel cell : obstacle.cells) {
        const Channels guard = layout.within(cell, 1 + reach_);
        barred_.insert(guard.begin(), guard.end());
      }
    }
    for (const Traveller& traveller : surroundings.travellers) {
      if (journey.may_touch.count(traveller.droplet)) continue;
      travellers_.push_back(&traveller);
      horizon_ = std::max(horizon_, traveller.cells.size());
    }
  }

  std::size_t horizon() const { return horizon_; }

  bool may_step(Channel from, Channel to, std::size_t time) const {
    if (from != to && barred_.count(to)) return false;
    for (const Traveller* other : travellers_) {
      const Channel before = other->at(time), after = other->at(time + 1);
      // Who stands still while the other does makes nothing worse.
      if (from == to && before == after) continue;
      const int rings = 1 + reach_ + other->reach;
      if (near(to, after, rings) || near(to, before, rings)) return false;
      if (before != after && near(from, after, rings)) return false;
    }
    return true;
  }

  /// A droplet that arrives at this time can stay for good.
  bool may_stay(Channel cell, std::size_t time) const {
    for (; time < horizon_; ++time)
      if (!may_step(cell, cell, time)) return false;
    return true;
  }

 private:
  bool near(Channel a, Channel b, int rings) const {
    if (rings == 1) return layout_.near(a).count(b) > 0;
    return layout_.within(a, rings).count(b) > 0;
  }

  const Layout& layout_;
  int reach_;
  Channels barred_;
  std::vector<const Traveller*> travellers_;
  std::size_t horizon_ = 0;
};

/// Steps to a destination over an empty board: what A* may hope for at best.
std::map<Channel, std::size_t> steps_to(const Layout& layout, Channel destination) {
  std::map<Channel, std::size_t> steps{{destination, 0}};
  std::queue<Channel> ahead({destination});
  while (!ahead.empty()) {
    const Channel channel = ahead.front();
    ahead.pop();
    for (const Channel neighbour : layout.neighbours(channel))
      if (steps.emplace(neighbour, steps.at(channel) + 1).second) ahead.push(neighbour);
  }
  return steps;
}

}  // namespace

std::optional<std::vector<Channel>> find_route(const Layout& layout, const Journey& journey,
                                               const Surroundings& surroundings) {
  const Rules rules(layout, journey, surroundings);
  const bool free_way = !journey.as_given || journey.over.empty();
  const Channel destination = journey.over.empty() ? journey.from : journey.over.back();
  const auto steps = free_way ? steps_to(layout, destination) : std::map<Channel, std::size_t>{};
  if (free_way && !steps.count(journey.from)) return std::nullopt;
  const auto hoped = [&](const Place& place) {
    return free_way ? steps.at(place.cell) : journey.over.size() - place.passed;
  };
  const auto arrived = [&](const Place& place) {
    return free_way ? place.cell == destination : place.passed == journey.over.size();
  };
  const auto next_places = [&](const Place& place) {
    std::vector<Place> next{place};
    if (free_way) {
      for (const Channel neighbour : layout.neighbours(place.cell))
        if (steps.count(neighbour)) next.push_back({neighbour, 0});
    } else if (place.passed < journey.over.size()) {
      next.push_back({journey.over[place.passed], place.passed + 1});
    }
    return next;
  };

  struct Node {
    Place place;
    std::size_t time;  // true, beyond the horizon too
    std::size_t moves;
    std::ptrdiff_t before;  // index of the node it was reached from
  };
  std::vector<Node> nodes{{{journey.from, 0}, 0, 0, -1}};
  // Of equally quick ways the one with fewest moves, then the first that was found: the same on every run.
  using Entry = std::tuple<std::size_t, std::size_t, std::size_t>;  // time + hoped, moves, index
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  open.emplace(hoped(nodes[0].place), 0, 0);
  std::set<std::pair<Place, std::size_t>> closed;
  while (!open.empty()) {
    const std::size_t index = std::get<2>(open.top());
    open.pop();
    const Node node = nodes[index];
    if (!closed.insert({node.place, std::min(node.time, rules.horizon())}).second) continue;
    if (arrived(node.place) && rules.may_stay(node.place.cell, node.time)) {
      std::vector<Channel> route;
      for (auto at = static_cast<std::ptrdiff_t>(index); at >= 0; at = nodes[at].before)
        route.push_back(nodes[at].place.cell);
      std::reverse(route.begin(), route.end());
      return route;
    }
    for (const Place& next : next_places(node.place)) {
      if (!rules.may_step(node.place.cell, next.cell, node.time)) continue;
      const std::size_t moves = node.moves + (next.cell != node.place.cell);
      nodes.push_back({next, node.time + 1, moves, static_cast<std::ptrdiff_t>(index)});
      open.emplace(node.time + 1 + hoped(next), moves, nodes.size() - 1);
    }
  }
  return std::nullopt;
}

bool is_clear(const Layout& layout, const Traveller& traveller, const Journey& journey,
              const Surroundings& surroundings) {
  const std::vector<Channel>& cells = traveller.cells;
  const Surroundings standing{{}, surroundings.obstacles, surroundings.dead};
  const Rules rules(layout, journey, standing);
  for (std::size_t step = 1; step < cells.size(); ++step)
    if (!rules.may_step(cells[step - 1], cells[step], 0)) return false;
  return true;
}

std::string why_no_route(const Layout& layout, const Journey& journey, const Surroundings& surroundings) {
  const auto has_route = [&](const Surroundings& others) {
    return find_route(layout, journey, others).has_value();
  };
  const Surroundings no_droplets{{}, {}, surroundings.dead};
  if (!has_route(no_droplets)) {
    std::string reason = fmt::format("no way from channel {} to {}", journey.from,
                                     journey.over.empty() ? journey.from : journey.over.back());
    if (!surroundings.dead.empty())
      reason += fmt::format(": electrodes {} do not answer", channels_text(surroundings.dead));
    return reason;
  }
  // One alone may be in the way, or several together: then those without which there would be a way are named
  // one after the other.
  std::set<std::uint32_t> ids, in_the_way;
  for (const Traveller& traveller : surroundings.travellers) ids.insert(traveller.droplet);
  for (const Obstacle& obstacle : surroundings.obstacles) ids.insert(obstacle.droplet);
  Surroundings left = no_droplets;
  for (const std::uint32_t id : ids) {
    Surroundings more = left;
    for (const Traveller& traveller : surroundings.travellers)
      if (traveller.droplet == id) more.travellers.push_back(traveller);
    for (const Obstacle& obstacle : surroundings.obstacles)
      if (obstacle.droplet == id) more.obstacles.push_back(obstacle);
    if (has_route(more)) {
      left = more;
    } else {
      in_the_way.insert(id);
    }
  }
  std::vector<std::string> names;
  for (const std::uint32_t id : in_the_way) names.push_back(fmt::format("droplet {}", id));
  return fmt::format("blocked by {}", fmt::join(names, " and "));
}

}  // namespace dmf::controller
