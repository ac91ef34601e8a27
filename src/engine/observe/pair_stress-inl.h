#pragma once
#include <algorithm>
#include <cmath>

#include "engine/beads.h"
#include "engine/kernels/lanes-inl.h"
#include "engine/neighbours.h"
#include "engine/pair_law-inl.h"
#include "engine/parameters.h"
#include "engine/species.h"

namespace dmf::engine {

/// Calls visit(i, r_i - r_j, F / r) for every liquid bead i of the block and every liquid bead j in its
/// range, in double precision, from densities and neighbours of the present positions. F is the wanted part
/// of the force on i along r_i - r_j; of friction that which the velocities `moving` make.
template <PairForce part, class Visit>
void for_each_pair_stress(const NeighbourBlock& block, const Beads& beads,
                          const AlignedVector<Record>& moving, const Parameters& parameters, Visit visit) {
  const PairTable laws = pair_table(parameters);
  const SplineShape<double> spline = spline_shape(parameters.spline);
  for_each_pair_in_range(block, [&](std::uint32_t i, std::uint32_t j) {
    const Record &a = beads.position[i], &b = beads.position[j];
    const Record &v = moving[i], &w = moving[j];
    const Vector3d apart =
        parameters.domain.nearest_image(Vector3d(double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z));
    const double r = std::max(apart.norm(), 1e-6);
    const double approach = apart.dot(Vector3d(double(v.x) - w.x, double(v.y) - w.y, double(v.z) - w.z)) / r;
    const double density_sum = double(beads.predicted[i].w) + beads.predicted[j].w;
    const MdpdLaw<double>& law =
        laws(liquid_species(beads.species_of(i)), liquid_species(beads.species_of(j)));
    const auto force = [&](const auto& of_law) {
      return HWY_NAMESPACE::weighted_force<part>(of_law, law.attraction, r, density_sum, approach, 0.0);
    };
    visit(i, apart, (parameters.spline.used ? force(SplineLaw<double>{law, spline}) : force(law)) / r);
  });
}

}  // namespace dmf::engine
