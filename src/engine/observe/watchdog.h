#pragma once
#include <string>

#include "engine/beads.h"
#include "engine/bodies/microparticles.h"
#include "engine/observe/carriage.h"
#include "engine/observe/droplet_tracker.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// Why a run must not go on, for a person: which bead, droplet or microparticle, where, and which setting to
/// look at. Empty while the run is sound. Looks at the state as it is after a look of the observers, so that
/// a run is stopped at the same step whoever watches:
///
///  - a bead that stands outside the domain, or nowhere,
///  - the kinetic temperature outside its band, of runs with as many beads as a droplet has; the band is
///    widened by six standard deviations of what so many beads fluctuate by, sqrt(2 / 3N); of a flow
///    the thermal part (temperature.h),
///  - the centre of a microparticle beyond a plate or a closed side,
///  - more than `leak` liquid beads deep in a microparticle,
///  - more than `evaporation` of a droplet's beads in the vapour, and no fewer than `fewest_evaporated`.
///
/// A bead that moves too far in one step, or to no number, is found in that step already (integrate.h).
/// Costs one pass over the beads a look.
/// @param temperature  kinetic, k_BT.
std::string find_fault(const Parameters& parameters, const Beads& beads, double temperature,
                       const Microparticles& microparticles, const DropletTracker& tracker,
                       const Carriage& carriage);

/// A satellite of some ten beads may come and go.
constexpr std::size_t fewest_evaporated = 100;

}  // namespace dmf::engine
