#include "engine/observe/virial.h"

#include <cmath>

#include "engine/kernels/lanes-inl.h"
#include "engine/pair_law-inl.h"

namespace dmf::engine {

Virial virial_of(const Beads& beads, const std::vector<NeighbourBlock>& blocks, const Ghosts& ghosts,
                 const Parameters& parameters) {
  const MdpdLaw<double> law = liquid_law(parameters.liquid, parameters.time_step);
  Virial result;
  result.of_bead.resize(beads.size());
  std::vector<Eigen::Matrix3d> of_bead(beads.size(), Eigen::Matrix3d::Zero());
  for (const NeighbourBlock& block : blocks)
    for_each_pair_in_range(block, [&](std::uint32_t i, std::uint32_t j) {
      const bool image = j >= beads.size();
      const std::uint32_t source = image ? ghosts.source(j - beads.size()) : j;
      const Record& a = beads.position[i];
      const Record b = image ? ghosts.position(j - beads.size(), beads) : beads.position[j];
      Vector3d d(double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z);
      for (int axis = 0; axis < 3; ++axis)
        if (parameters.domain.periodic(axis)) {
          const double period = parameters.domain.size()[axis];
          d[axis] -= period * std::nearbyint(d[axis] / period);
        }
      const double r = std::max(d.norm(), 1e-6);
      const double density_sum = double(beads.predicted[i].w) + beads.predicted[source].w;
      double force = HWY_NAMESPACE::weighted_force<PairForce::conservative>(law, law.attraction, r,
                                                                            density_sum, 0.0, 0.0);
      if (parameters.boundaries.shear_rate != 0) {
        const Record& u = beads.velocity[i];
        const Record v =
            image ? ghosts.velocity(j - beads.size(), beads.velocity[source]) : beads.velocity[j];
        const double approach = Vector3d(u.x - v.x, u.y - v.y, u.z - v.z).dot(d) / r;
        force += HWY_NAMESPACE::weighted_force<PairForce::friction>(law, 0.0, r, 0.0, approach, 0.0);
      }
      of_bead[i] += 0.5 * force / r * d * d.transpose();
    });
  for (std::size_t i = 0; i < beads.size(); ++i) {
    result.total += of_bead[i];
    result.of_bead[i] = static_cast<float>(of_bead[i].trace() / 3.0);
  }
  return result;
}

}  // namespace dmf::engine
