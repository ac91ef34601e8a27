#pragma once
#include <Eigen/Core>
#include <vector>

#include "engine/beads.h"
#include "engine/bonds/bonds.h"
#include "engine/neighbours.h"
#include "engine/parameters.h"
#include "engine/walls/ghosts.h"

namespace dmf::engine {

/// Conservative pair forces between liquid beads, and their bonds, as stress. Friction and noise cancel in
/// the mean, but for the friction of a liquid under a shear rate, which counts.
struct Virial {
  Eigen::Matrix3d total = Eigen::Matrix3d::Zero();  ///< sum over pairs of r_ij (x) F_ij, k_BT
  std::vector<float> of_bead;  ///< a third of the trace, half of each pair to each bead, by storage index
};

/// In double precision, from densities and neighbours of the present positions.
Virial virial_of(const Beads& beads, const std::vector<NeighbourBlock>& blocks, const Ghosts& ghosts,
                 const Bonds& bonds, const Parameters& parameters);

}  // namespace dmf::engine
