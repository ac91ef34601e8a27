#pragma once
#include <algorithm>
#include <cmath>

#include "engine/beads.h"
#include "engine/kernels/lanes-inl.h"
#include "engine/neighbours.h"
#include "engine/pair_law-inl.h"
#include "engine/parameters.h"
#include "engine/species.h"
#include "engine/walls/ghosts.h"

namespace dmf::engine {

/// Calls visit(i, r_i - r_j, F / r) for every liquid bead i of the block and every liquid bead j in its
/// range, in double precision, from densities and neighbours of the present positions. F is the wanted part
/// of the force on i along r_i - r_j. j may be an image beyond a sheared or symmetric side.
template <PairForce part, class Visit>
void for_each_pair_stress(const NeighbourBlock& block, const Beads& beads, const Ghosts& ghosts,
                          const Parameters& parameters, Visit visit) {
  const PairTable laws = pair_table(parameters);
  const SplineShape<double> spline = spline_shape(parameters.spline);
  for_each_pair_in_range(block, [&](std::uint32_t i, std::uint32_t j) {
    const std::uint32_t source = ghosts.source(j);
    const Record &a = beads.position[i], &v = beads.velocity[i];
    const Record b = ghosts.position(j, beads), w = ghosts.velocity(j, beads.velocity[source]);
    const Vector3d apart =
        parameters.domain.nearest_image(Vector3d(double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z));
    const double r = std::max(apart.norm(), 1e-6);
    const double approach = apart.dot(Vector3d(double(v.x) - w.x, double(v.y) - w.y, double(v.z) - w.z)) / r;
    const double density_sum = double(beads.predicted[i].w) + beads.predicted[source].w;
    const MdpdLaw<double>& law =
        laws(liquid_species(beads.species_of(i)), liquid_species(beads.species_of(source)));
    const auto force = [&](const auto& of_law) {
      return HWY_NAMESPACE::weighted_force<part>(of_law, law.attraction, r, density_sum, approach, 0.0);
    };
    visit(i, apart, (parameters.spline.used ? force(SplineLaw<double>{law, spline}) : force(law)) / r);
  });
}

}  // namespace dmf::engine
