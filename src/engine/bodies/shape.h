#pragma once
#include <cmath>
#include <vector>

#include "engine/bodies/microparticles.h"

namespace dmf::engine {

/// Most beads of one microparticle.
constexpr std::uint32_t largest_bead_count = 20000;

/// What Lan's microparticle has: 612 beads on a sphere of radius 1, per r_c^2.
constexpr double usual_beads_per_area = 612 / (4 * M_PI);
/// The fewest that keep the liquid out: 312 on a sphere of radius 1 (Lan 3.1.2), per r_c^2.
constexpr double fewest_beads_per_area = 312 / (4 * M_PI);
/// With two dimensions, on the circle around a disc, per r_c: to the liquid, of some 4 beads per r_c^2, they
/// are what those above are to one of 6 per r_c^3.
constexpr double usual_beads_per_length = 32, fewest_beads_per_length = 16;

/// The rigid body that a sound placement describes, at its place, at rest; without id and beads' indices.
/// @throws InvalidInput when it has no z and there is no wall to rest on.
Microparticle shaped(const MicroparticlePlacement& placement, const Parameters& parameters);

/// Density that the beads of a body count of each other (Lan 2.37).
std::vector<float> own_densities(const Microparticle& particle, const Parameters& parameters);

}  // namespace dmf::engine
