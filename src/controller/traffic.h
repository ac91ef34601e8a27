#pragma once
#include <map>
#include <string>
#include <vector>

#include "controller/route.h"

namespace dmf::controller {

/// Several droplets on their way at once. All take their steps together: the next one begins when every
/// droplet has done its last, so that ways that keep clear of each other on paper do so on the board as well,
/// however long a step takes. (That is how boards are driven, by a list of activations; the price is that the
/// slowest sets the pace.) Who comes later finds its way around those before; where it finds none, those
/// before are asked to go another way.
class Traffic {
 public:
  using Key = std::uint32_t;  ///< of the operation that moves the droplet

  explicit Traffic(const Layout& layout) : layout_(layout) {}

  void enter(Key key, std::uint32_t droplet, const Journey& journey);
  void leave(Key key) { entries_.erase(key); }

  /// The electrode that the droplet shall be on in this step.
  Channel cell(Key key) const { return entries_.at(key).cells.front(); }
  /// It is there.
  void set_arrived(Key key) { entries_.at(key).arrived = true; }
  /// It did not get there, and stays where it was: a way is looked for from there.
  void turn_back(Key key, Channel cell);
  bool is_at_destination(Key key) const;
  std::size_t steps_left(Key key) const { return entries_.at(key).cells.size() - 1; }
  /// Why there is no way to the destination now; empty when there is one.
  const std::string& blocked(Key key) const { return entries_.at(key).blocked; }
  /// The electrodes that droplets on their way are on, or step to; that of `except` left out.
  Channels cells(Key except) const;

  /// Looks for ways anew where something has come into them, then begins the next step when all have done the
  /// last.
  void advance(const std::vector<Obstacle>& obstacles, const Channels& dead);

 private:
  struct Entry {
    std::uint32_t droplet = 0;
    Journey journey;             ///< from the cell of this step on
    std::vector<Channel> cells;  ///< of this step, of the next, ...
    bool arrived = true;
    std::string blocked;
  };

  bool plan(Key key, const Surroundings& surroundings);
  bool plan_before_others(Key key, const Surroundings& standing);
  Surroundings around(Key key, const Surroundings& standing) const;
  static bool is_at_destination(const Entry& entry);

  const Layout& layout_;
  std::map<Key, Entry> entries_;
};

}  // namespace dmf::controller
