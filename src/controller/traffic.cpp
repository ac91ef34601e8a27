#include "controller/traffic.h"

#include <algorithm>

namespace dmf::controller {

void Traffic::enter(Key key, std::uint32_t droplet, const Journey& journey) {
  entries_[key] = {droplet, journey, {journey.from}, true, ""};
  entries_[key].journey.owner = key;
}

void Traffic::turn_back(Key key, Channel cell) {
  Entry& entry = entries_.at(key);
  entry.journey.from = cell;
  entry.cells = {cell};
  entry.arrived = true;
}

bool Traffic::is_at_destination(const Entry& entry) {
  const Journey& journey = entry.journey;
  return journey.over.empty() || (!journey.as_given && entry.cells.front() == journey.over.front());
}

bool Traffic::is_at_destination(Key key) const {
  const Entry& entry = entries_.at(key);
  return entry.arrived && entry.cells.size() == 1 && is_at_destination(entry);
}

Channels Traffic::cells(Key except) const {
  Channels cells;
  for (const auto& [key, entry] : entries_)
    if (key != except) cells.insert(entry.cells.front());
  return cells;
}

Surroundings Traffic::around(Key key, const Surroundings& standing) const {
  Surroundings surroundings = standing;
  for (const auto& [other, entry] : entries_)
    if (other != key) surroundings.travellers.push_back({entry.droplet, entry.cells, entry.journey.reach});
  return surroundings;
}

bool Traffic::plan(Key key, const Surroundings& surroundings) {
  Entry& entry = entries_.at(key);
  const auto route = find_route(layout_, entry.journey, surroundings);
  entry.cells = route.value_or(std::vector<Channel>{entry.journey.from});
  return route.has_value();
}

bool Traffic::plan_before_others(Key key, const Surroundings& standing) {
  std::map<Key, std::vector<Channel>> as_before;
  for (const auto& [any, entry] : entries_) as_before[any] = entry.cells;
  Surroundings surroundings = standing;
  const auto plan_next = [&](Key next) {
    if (!plan(next, surroundings)) return false;
    const Entry& entry = entries_.at(next);
    surroundings.travellers.push_back({entry.droplet, entry.cells, entry.journey.reach});
    return true;
  };
  bool all = plan_next(key);
  for (const auto& [other, cells] : as_before) all = all && (other == key || plan_next(other));
  if (!all)
    for (auto& [any, entry] : entries_) entry.cells = as_before.at(any);
  return all;
}

void Traffic::advance(const std::vector<Obstacle>& obstacles, const Channels& dead) {
  const Surroundings standing{{}, obstacles, dead};
  for (auto& [key, entry] : entries_) {
    const Traveller traveller{entry.droplet, entry.cells, entry.journey.reach};
    if (!is_clear(layout_, traveller, entry.journey, standing)) entry.cells.resize(1);
  }
  for (auto& [key, entry] : entries_) {
    if (entry.cells.size() > 1 || is_at_destination(entry)) continue;
    const Surroundings surroundings = around(key, standing);
    entry.blocked.clear();
    if (!plan(key, surroundings) && !plan_before_others(key, standing))
      entry.blocked = why_no_route(layout_, entry.journey, surroundings);
  }
  const bool all_arrived =
      std::all_of(entries_.begin(), entries_.end(), [](const auto& entry) { return entry.second.arrived; });
  if (!all_arrived) return;
  for (auto& [key, entry] : entries_) {
    if (entry.cells.size() == 1) continue;
    const Channel before = entry.cells.front();
    entry.cells.erase(entry.cells.begin());
    entry.journey.from = entry.cells.front();
    if (entry.journey.from == before) continue;
    entry.arrived = false;
    if (entry.journey.as_given) entry.journey.over.erase(entry.journey.over.begin());
  }
}

}  // namespace dmf::controller
