#pragma once
#include <optional>
#include <string>
#include <vector>

#include "controller/layout.h"

namespace dmf::controller {

/// A droplet on its way, as others have to reckon with it.
struct Traveller {
  std::uint32_t droplet = 0;
  std::vector<Channel> cells;  ///< the electrode it is on now, after one step, ...; at the end it stays
  int reach = 0;               ///< rings of electrodes around its own that it covers too

  Channel at(std::size_t step) const { return cells[step < cells.size() ? step : cells.size() - 1]; }
};

/// Liquid that does not move, or a place that an operation keeps for itself.
struct Obstacle {
  std::uint32_t droplet = 0;
  Channels cells;
  std::uint32_t owner = 0;  ///< operation that it belongs to; 0: none
};

/// What a route has to keep clear of.
struct Surroundings {
  std::vector<Traveller> travellers;
  std::vector<Obstacle> obstacles;
  Channels dead;  ///< electrodes that hold no droplet
};

/// Where a droplet shall go.
struct Journey {
  Channel from = 0;
  /// The destination; when `as_given` the electrodes to go over, in this order, waiting allowed. Empty: it
  /// stays, and makes room for others at most.
  std::vector<Channel> over;
  bool as_given = false;
  int reach = 0;            ///< as Traveller::reach
  Channels may_touch;       ///< droplets (ids) that it may come near to: it is to merge with them
  std::uint32_t owner = 0;  ///< operation that moves it: what belongs to that is not in its way
};

/// The quickest way, in steps from one electrode to a neighbour or of waiting: the electrode now, after one
/// step, ... Empty when there is none.
///
/// The search is A* in space and time around droplets whose ways are fixed (Silver 2005, "Cooperative
/// pathfinding"), under the fluidic constraints of Su, Hwang and Chakrabarty (2006, "Droplet routing in the
/// synthesis of digital microfluidic biochips", DATE), for a grid: two droplets i and j never stand on
/// adjacent electrodes, at corners neither (static); and none steps next to where another was a step before
/// (dynamic):
///
///     near(x_i(t+1), x_j(t+1)),  near(x_i(t+1), x_j(t)),  near(x_i(t), x_j(t+1))   all false.
///
/// Here near() is Layout::near(), so that the electrodes may have any shape. A droplet that stands too near
/// to begin with may leave.
std::optional<std::vector<Channel>> find_route(const Layout& layout, const Journey& journey,
                                               const Surroundings& surroundings);

/// The rest of a way that a droplet is on keeps clear of obstacles and dead electrodes.
bool is_clear(const Layout& layout, const Traveller& traveller, const Journey& journey,
              const Surroundings& surroundings);

/// Why there is no way: "blocked by droplet 3", or "no way from channel 0 to 5: electrodes 2, 8 are dead".
std::string why_no_route(const Layout& layout, const Journey& journey, const Surroundings& surroundings);

}  // namespace dmf::controller
