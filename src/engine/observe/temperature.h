#pragma once
#include <vector>

#include "engine/beads.h"
#include "engine/neighbours.h"

namespace dmf::engine {

/// Kinetic temperature of the beads, k_BT: what their velocities have a degree of freedom; 0 without beads.
/// @param dimensions  of space, 2 or 3.
double kinetic_temperature(const Beads& beads, int dimensions);

/// The same of the velocities relative to the mean of each sorting cell, so that a flow does not count but
/// for what it changes within a cell: a shear rate G adds about (G (r_c + skin))^2 / 36 in three dimensions.
/// 0 when no cell holds two beads.
double local_temperature(const Beads& beads, const std::vector<NeighbourBlock>& blocks, int dimensions);

}  // namespace dmf::engine
