#pragma once
#include <cstdint>
#include <vector>

#include "engine/beads.h"
#include "engine/parameters.h"
#include "engine/simulation.h"

namespace dmf::engine {

/// Lattice sites (fcc, of the initial density) of a droplet: the sphere without what lies within half a
/// lattice constant of a wall plane, or of a pancake as many sites as the sphere would have. @throws
/// InvalidInput outside the domain, or for fewer than DropletTracker::fewest_beads sites.
std::vector<Vector3d> droplet_sites(const DropletPlacement& placement, const Parameters& parameters);

/// Lattice sites that fill lower <= position < upper. @throws InvalidInput when that leaves the domain or
/// holds none.
std::vector<Vector3d> slab_sites(const Vector3d& lower, const Vector3d& upper, const Parameters& parameters);

/// Puts a bead on every site, with thermal velocities of no net momentum that depend on (seed, step, bead id)
/// only. Ids of beads that were taken out are given anew.
/// @param next_id  above all ids that were ever given; advanced.
/// @throws InvalidInput, unchanged, when a site is within r_c of a bead.
/// @returns the number of beads placed.
std::size_t place_beads(Beads& beads, const std::vector<Vector3d>& sites, const Parameters& parameters,
                        std::uint64_t step, std::uint32_t& next_id);

/// The same wherever other beads are. @returns the ids, site by site.
std::vector<std::uint32_t> add_beads(Beads& beads, const std::vector<Vector3d>& sites,
                                     const Parameters& parameters, std::uint64_t step,
                                     std::uint32_t& next_id);

}  // namespace dmf::engine
