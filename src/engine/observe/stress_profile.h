#pragma once
#include <Eigen/Core>
#include <vector>

#include "engine/beads.h"
#include "engine/bonds/bonds.h"
#include "engine/neighbours.h"
#include "engine/parameters.h"
#include "engine/walls/ghosts.h"

namespace dmf::engine {

/// Slabs across the domain, all of one thickness, for which the stress is wanted.
struct StressSlabs {
  int axis = 2;           ///< that the slabs are stacked along: 0, 1, 2
  std::size_t count = 1;  ///< [1, 100000]
};

/// What one slab of liquid carries at one instant.
struct SlabStress {
  /// P, k_BT / r_c^3, by Irving and Kirkwood (1950; Liu eq. 11, where S = -P):
  ///   P V = sum over beads of (v - u) (x) (v - u)  +  sum over pairs of r_ij (x) F_ij
  /// with u the slab's mean velocity; the first sum is scaled by n / (n - 1), because u is the mean of the
  /// same n beads. A pair counts in each slab with the part of the line between its beads that lies there, a
  /// chain's bond likewise, and what a membrane's bonds do to a bead in the bead's slab. F
  /// is the conservative force and the friction; noise, which has no mean, is left out, and so are walls and
  /// microparticles.
  Eigen::Matrix3d pressure = Eigen::Matrix3d::Zero();
  Vector3d velocity = Vector3d::Zero();  ///< u, r_c / tau; 0 without beads
  double density = 0;                    ///< beads per r_c^3
  double temperature = 0;                ///< from the velocities relative to u, k_BT; 0 below two beads
};

/// In double precision, from densities and neighbours of the present positions; lowest slab first.
/// @throws InvalidInput for an axis or a count that there is not.
std::vector<SlabStress> stress_profile(const StressSlabs& slabs, const Beads& beads,
                                       const std::vector<NeighbourBlock>& blocks, const Ghosts& ghosts,
                                       const Bonds& bonds, const Parameters& parameters);

}  // namespace dmf::engine
