#pragma once
#include <cstdint>
#include <vector>

#include "engine/beads.h"
#include "engine/bodies/microparticles.h"
#include "engine/parameters.h"
#include "engine/simulation.h"

namespace dmf::engine {

/// Lattice sites (fcc, of the initial density) of a droplet: the sphere without what lies within half a
/// lattice constant of a wall plane, or of a pancake as many sites as the sphere would have. @throws
/// InvalidInput outside the domain, in the solid of a label grid, or for fewer than
/// DropletTracker::fewest_beads sites.
std::vector<Vector3d> droplet_sites(const DropletPlacement& placement, const Parameters& parameters);

/// Lattice sites that fill lower <= position < upper but for the solid of a label grid. @throws InvalidInput
/// when that leaves the domain or holds none.
std::vector<Vector3d> slab_sites(const FillPlacement& placement, const Parameters& parameters);

/// The same without those nearer than half a lattice constant to a bead, or half an r_c to a microparticle.
/// @throws InvalidInput when none is left, too.
std::vector<Vector3d> free_sites(const FillPlacement& placement, const Beads& beads,
                                 const Microparticles& bodies, const Parameters& parameters);

/// @throws InvalidInput when a site is within r_c of a bead.
void require_free(const Beads& beads, const std::vector<Vector3d>& sites, const Parameters& parameters);

/// Puts a bead on every site, with thermal velocities of no net momentum that depend on (seed, step, bead id)
/// only. Ids of beads that were taken out are given anew.
/// @param next_id  above all ids that were ever given; advanced.
/// @returns the ids, site by site.
std::vector<std::uint32_t> place_beads(Beads& beads, const std::vector<Vector3d>& sites,
                                       std::uint32_t species, const Parameters& parameters,
                                       std::uint64_t step, std::uint32_t& next_id);

}  // namespace dmf::engine
