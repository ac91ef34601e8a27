#pragma once
#include <algorithm>
#include <cmath>

#include "engine/beads.h"
#include "engine/kernels/lanes-inl.h"
#include "engine/neighbours.h"
#include "engine/pair_law-inl.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// Calls visit(i, r_i - r_j, F / r) for every liquid bead i of the block and every liquid bead j in its
/// range, in double precision, from densities and neighbours of the present positions. F is the wanted part
/// of the force on i along r_i - r_j; of friction that which the velocities `moving` make.
template <PairForce part, class Visit>
void for_each_pair_stress(const NeighbourBlock& block, const Beads& beads,
                          const AlignedVector<Record>& moving, const Parameters& parameters, Visit visit) {
  const MdpdLaw<double> law = liquid_law(parameters.liquid, parameters.time_step);
  for_each_pair_in_range(block, [&](std::uint32_t i, std::uint32_t j) {
    const Record &a = beads.position[i], &b = beads.position[j];
    const Record &v = moving[i], &w = moving[j];
    const Vector3d apart =
        parameters.domain.nearest_image(Vector3d(double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z));
    const double r = std::max(apart.norm(), 1e-6);
    const double approach = apart.dot(Vector3d(double(v.x) - w.x, double(v.y) - w.y, double(v.z) - w.z)) / r;
    const double density_sum = double(beads.predicted[i].w) + beads.predicted[j].w;
    visit(i, apart,
          HWY_NAMESPACE::weighted_force<part>(law, law.attraction, r, density_sum, approach, 0.0) / r);
  });
}

}  // namespace dmf::engine
