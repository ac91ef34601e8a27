#pragma once
#include <cstdint>

#include "engine/beads.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// What a drift saw of the beads.
struct DriftReport {
  float largest_displacement_squared = 0;  ///< since beads were sorted, r_c^2
  std::int64_t wild_bead = -1;  ///< index of a bead that moved too far in this step, or not to a number
};

/// A bead that moves further than this in one step can jump through its neighbours: the run is unstable. r_c.
constexpr float largest_step = 0.5f;

/// First half of Groot and Warren's modified velocity-Verlet step (1997, eq. 21): half kick, move, and the
/// velocity that the forces shall see,
///   v' = v + dt/2 f,  r += dt v',  predicted = v + lambda dt f.
/// A bead that would leave through a side that is not periodic goes back along its path with reversed
/// velocity (bounce-back: no slip on average). Sets the beads' noise keys for `step`.
DriftReport drift(Beads& beads, const Parameters& parameters, std::uint64_t step);

/// Second half: v = v' + dt/2 f with the new forces.
void finish(Beads& beads, const Parameters& parameters);

}  // namespace dmf::engine
