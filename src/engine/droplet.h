#pragma once
#include <cstdint>

#include "engine/parameters.h"

namespace dmf::engine {

/// A droplet to be placed. On a plate: the sphere, cut by the wall when `center` is nearer to it than
/// `radius`. Between two plates that are nearer to each other than the sphere is wide: a pancake of the
/// sphere's volume around (x, y), from plate to plate.
struct DropletPlacement {
  Vector3d center;            ///< r_c; of a pancake z does not matter
  double radius;              ///< of the sphere, r_c
  std::uint32_t species = 0;  ///< number of the liquid (mixture.h)
};

/// A box to be filled with liquid, around whatever is there.
struct FillPlacement {
  Vector3d lower, upper;      ///< corners, r_c; inside the domain
  std::uint32_t species = 0;  ///< number of the liquid (mixture.h)
};

/// Height of the liquid between two plates, less than the gap by what the liquid keeps away from both
/// (LiquidParameters::wall_distance), r_c.
double liquid_height(const Parameters& parameters);

/// Radius of the footprint of a pancake, the sphere's volume over the liquid's height, r_c. 0 for a droplet
/// that is none.
double pancake_radius(const DropletPlacement& placement, const Parameters& parameters);

}  // namespace dmf::engine
