#pragma once
#include "engine/beads.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// Frozen layers of an fcc(100) lattice behind a z side, the first layer on the bounce-back plane. That
/// placement, with walls absent from every density, is what shows Lan's contact angles (docs/physics.md).
struct Plate {
  double plane;                 ///< z of the bounce-back plane, r_c
  Vector3d lower, upper;        ///< box around its beads
  AlignedVector<Record> beads;  ///< w is 0
};

/// @param outward  -1: layers go down from the plane, +1: up, the mirror image.
/// @param dimensions  with 2, of each layer the beads of one row, half-way between the y sides: 2 / a^2 a
/// r_c^2.
Plate plate_at(const Domain& domain, const WallParameters& wall, double plane, int outward, int dimensions);

}  // namespace dmf::engine
