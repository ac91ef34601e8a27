#include "engine/observe/virial.h"

#include "engine/observe/pair_stress-inl.h"

namespace dmf::engine {

Virial virial_of(const Beads& beads, const std::vector<NeighbourBlock>& blocks, const Ghosts& ghosts,
                 const Bonds& bonds, const Parameters& parameters) {
  Virial result;
  result.of_bead.resize(beads.size());
  std::vector<Eigen::Matrix3d> of_bead(beads.size(), Eigen::Matrix3d::Zero());
  const auto share = [&](std::uint32_t i, const Vector3d& apart, double force_over_distance) {
    of_bead[i] += 0.5 * force_over_distance * apart * apart.transpose();
  };
  for (const NeighbourBlock& block : blocks) {
    for_each_pair_stress<PairForce::conservative>(block, beads, ghosts, parameters, share);
    if (parameters.boundaries.shear_rate != 0)
      for_each_pair_stress<PairForce::friction>(block, beads, ghosts, parameters, share);
  }
  bonds.for_each_stress(
      beads, [&](std::uint32_t i, const Vector3d&, const Eigen::Matrix3d& stress) { of_bead[i] += stress; });
  for (std::size_t i = 0; i < beads.size(); ++i) {
    result.total += of_bead[i];
    result.of_bead[i] = static_cast<float>(of_bead[i].trace() / 3.0);
  }
  return result;
}

}  // namespace dmf::engine
