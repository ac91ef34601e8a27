#pragma once
#include <cstdint>
#include <vector>

#include "engine/beads.h"
#include "engine/bonds/bonds.h"
#include "engine/chain.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// Where the beads of a placement's chains are, chain by chain, all of one length. Random walks and places in
/// the box are functions of (seed, step, chain id). With two dimensions all are in the plane.
/// @param first_id  of the chains. @pre violations(placement, parameters) is empty.
/// @throws InvalidInput when a chain finds no room in the box.
std::vector<std::vector<Vector3d>> chain_sites(const ChainPlacement& placement, const Parameters& parameters,
                                               std::uint64_t step, std::uint32_t first_id);

/// Beads for these sites: the nearest bead within r_c that is not bound yet is put there and keeps its id and
/// velocity; where there is none, a new one is. Each becomes one of its site's species, whatever it was.
/// @param sites    may lie beyond periodic sides.
/// @param species  numbers of liquids, site by site.
/// @param next_id  above all bead ids that were ever given; advanced.
/// @returns the ids, site by site. Pairs must be rebuilt.
std::vector<std::uint32_t> take_sites(Beads& beads, const std::vector<Vector3d>& sites,
                                      const std::vector<std::uint8_t>& species, const Bonds& bonds,
                                      const Parameters& parameters, const ShearedDomain& images,
                                      std::uint64_t step, std::uint32_t& next_id);

}  // namespace dmf::engine
