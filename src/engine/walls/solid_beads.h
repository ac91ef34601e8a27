#pragma once
#include <vector>

#include "engine/beads.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// Distances between layers of the lattice of a label grid's beads along the axes, r_c: half the lattice
/// constant, stretched to whole layers a voxel where that is within 15 %, and to whole cells a period
/// along a periodic axis.
Vector3d layer_distance(const Parameters& parameters);

/// The frozen beads of a label grid: sites of an fcc lattice in or on its solid voxels, nearer than the
/// liquid's range to a fluid place of the domain. Where whole layers fit a voxel, a layer lies on every face,
/// as a plate's first layer lies on its plane: such a face shows the calibrated angle. What lies on a plate
/// belongs to the plate. w is 0. Empty without a label grid.
AlignedVector<Record> solid_beads(const Parameters& parameters);

/// Their number, before any of them is allocated.
std::size_t count_solid_beads(const Parameters& parameters);

}  // namespace dmf::engine
