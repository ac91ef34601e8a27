#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/beads.h"
#include "engine/cell_grid.h"
#include "engine/neighbours.h"
#include "engine/species.h"

namespace dmf::engine {

/// Beads of microparticles, as the loops over pairs read and write them.
struct BodyPass {
  const Record* position = nullptr;    ///< x, y, z, A_ls
  Record* moving = nullptr;            ///< velocities; density pass writes w = rho
  const float* own_density = nullptr;  ///< what the beads of its own body count in rho
  const std::uint32_t* key = nullptr;  ///< of their noise
  Record* liquid_force = nullptr;      ///< force pass writes
  Record* wall_force = nullptr;        ///< force pass writes
  bool count_liquid = true, counted_by_liquid = true;
  const MicroparticleRow* row = nullptr;  ///< of mixtures
};

/// How the walls move, r_c / tau. Their beads stay where they are: only their friction feels it.
struct WallMotion {
  Eigen::Vector3f lower = Eigen::Vector3f::Zero(), upper = Eigen::Vector3f::Zero();
  float middle = 0;  ///< z: above it a bead meets the upper wall

  /// A bead's velocity relative to the wall that it is near, with its density.
  Record relative(const Record& position, const Record& moving) const {
    const Eigen::Vector3f& wall = position.z > middle ? upper : lower;
    return {moving.x - wall.x(), moving.y - wall.y(), moving.z - wall.z(), moving.w};
  }
};

/// What the two loops over pairs read and write.
struct PairPass {
  const Record* position;        ///< x, y, z, key
  Record* predicted;             ///< velocities; density pass writes w = rho
  Record* force;                 ///< force pass writes
  const Record* wall = nullptr;  ///< x, y, z, A_lw
  WallMotion wall_motion;
  BodyPass bodies;
  PairTable laws;
  const LawRow* rows = nullptr;  ///< by number of the liquid; of mixtures
  SplineShape<double> spline{};
  double density_normalization = 0;
  PeriodicImages images;
  Eigen::Vector3f period = Eigen::Vector3f::Zero();  ///< 0 along axes that are not periodic
  Eigen::Vector3f inverse_period = Eigen::Vector3f::Zero();
};

/// The loops that cost time, for one instruction set. The physics in them stands in pair_law-inl.h and
/// noise-inl.h.
struct Kernels {
  void (*density)(const PairPass&, NeighbourBlock&);  ///< rho of the block's beads, and who is in range
  /// By PairForce. `all` and `conservative` need the density of all beads.
  std::array<void (*)(const PairPass&, const NeighbourBlock&), 4> force;
  /// The same for a block of beads of microparticles.
  void (*body_density)(const PairPass&, NeighbourBlock&);
  void (*body_force)(const PairPass&, const NeighbourBlock&);
};

/// Names that this processor can run, best first.
std::vector<std::string> vector_kernels();
/// The best, or the one named, for laws of that weight and model. @throws InvalidInput naming those there
/// are.
Kernels select_kernels(const std::string& name, DissipativeWeight weight, PairModel model);

}  // namespace dmf::engine
