#pragma once
#include <cstdint>

#include "engine/beads.h"
#include "engine/parameters.h"
#include "engine/walls/solid.h"

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
/// A bead that would leave through a side that is not periodic is sent back (walls/reflection.h); one that
/// would enter a solid voxel goes back along its path with reversed velocity. Sets the beads' noise keys for
/// `step`.
DriftReport drift(Beads& beads, const Parameters& parameters, std::uint64_t step, const Solid& solid = {});

/// Adds gravity, r_c / tau^2, to the forces.
void add_gravity(Beads& beads, const Vector3d& gravity);

/// Second half: v = v' + dt/2 f with the new forces.
void finish(Beads& beads, const Parameters& parameters);

/// BAOAB (Leimkuhler and Matthews 2013) with the two half kicks on both sides of a step's end taken together:
///
///   kick_and_half_drift   v += dt f,  r += dt/2 v     f: conservative forces only
///   thermostat            friction and noise at the middle of the way (thermostat.h)
///   half_drift            r += dt/2 v                 then new forces
///
/// So between two steps the velocities are those of the drift, half a kick behind the positions. That is what
/// carries momentum and energy from place to place: the temperature and stress that it gives are right to
/// higher order in dt than those of the velocity after a half kick. Reflections and noise keys as in drift().
DriftReport kick_and_half_drift(Beads& beads, const Parameters& parameters, std::uint64_t step,
                                const Solid& solid = {});
DriftReport half_drift(Beads& beads, const Parameters& parameters, std::uint64_t step,
                       const Solid& solid = {});

}  // namespace dmf::engine
