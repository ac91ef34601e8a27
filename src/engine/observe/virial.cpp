#include "engine/observe/virial.h"

#include <cmath>

#include "engine/kernels/lanes-inl.h"
#include "engine/pair_law-inl.h"
#include "engine/species.h"

namespace dmf::engine {

Virial virial_of(const Beads& beads, const std::vector<NeighbourBlock>& blocks,
                 const Parameters& parameters) {
  const PairTable laws = pair_table(parameters);
  const SplineShape<double> spline = spline_shape(parameters.spline);
  Virial result;
  result.of_bead.resize(beads.size());
  std::vector<Eigen::Matrix3d> of_bead(beads.size(), Eigen::Matrix3d::Zero());
  for (const NeighbourBlock& block : blocks)
    for_each_pair_in_range(block, [&](std::uint32_t i, std::uint32_t j) {
      const Record &a = beads.position[i], &b = beads.position[j];
      Vector3d d(double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z);
      for (int axis = 0; axis < 3; ++axis)
        if (parameters.domain.periodic(axis)) {
          const double period = parameters.domain.size()[axis];
          d[axis] -= period * std::nearbyint(d[axis] / period);
        }
      const double r = std::max(d.norm(), 1e-6);
      const double density_sum = double(beads.predicted[i].w) + beads.predicted[j].w;
      const MdpdLaw<double>& law =
          laws(liquid_species(beads.species_of(i)), liquid_species(beads.species_of(j)));
      const double force =
          parameters.spline.used
              ? HWY_NAMESPACE::conservative_force_anywhere(SplineLaw<double>{law, spline}, law.attraction, r,
                                                           density_sum)
              : HWY_NAMESPACE::conservative_force_anywhere(law, law.attraction, r, density_sum);
      of_bead[i] += 0.5 * force / r * d * d.transpose();
    });
  for (std::size_t i = 0; i < beads.size(); ++i) {
    result.total += of_bead[i];
    result.of_bead[i] = static_cast<float>(of_bead[i].trace() / 3.0);
  }
  return result;
}

}  // namespace dmf::engine
