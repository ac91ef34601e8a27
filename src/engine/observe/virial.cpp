#include "engine/observe/virial.h"

#include <cmath>

#include "engine/kernels/lanes-inl.h"
#include "engine/pair_law-inl.h"

namespace dmf::engine {

Virial virial_of(const Beads& beads, const std::vector<NeighbourBlock>& blocks,
                 const Parameters& parameters) {
  const MdpdLaw<double> law = liquid_law(parameters.liquid, parameters.time_step);
  Virial result;
  result.of_bead.resize(beads.size());
  for (const NeighbourBlock& block : blocks)
    for (std::uint32_t i = block.begin; i < block.end; ++i) {
      const NeighbourRow& row = block.rows[i - block.begin];
      Eigen::Matrix3d of_bead = Eigen::Matrix3d::Zero();
      for (std::uint32_t k = 0; k < row.hits; ++k) {
        const std::uint32_t j = block.in_range[row.liquid_begin + k] / sizeof(Record);
        const Record &a = beads.position[i], &b = beads.position[j];
        Vector3d d(double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z);
        for (int axis = 0; axis < 3; ++axis)
          if (parameters.domain.periodic(axis)) {
            const double period = parameters.domain.size()[axis];
            d[axis] -= period * std::nearbyint(d[axis] / period);
          }
        const double r = std::max(d.norm(), 1e-6);
        const double density_sum = double(beads.predicted[i].w) + beads.predicted[j].w;
        const double force = HWY_NAMESPACE::mdpd_force(law, law.attraction, r, density_sum, 0.0, 0.0);
        of_bead += 0.5 * force / r * d * d.transpose();
      }
      result.total += of_bead;
      result.of_bead[i] = static_cast<float>(of_bead.trace() / 3.0);
    }
  return result;
}

}  // namespace dmf::engine
