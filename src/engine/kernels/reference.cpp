#include "engine/kernels/reference.h"

#include <cmath>
#include <cstring>

#include "engine/kernels/lanes-inl.h"
#include "engine/noise-inl.h"
#include "engine/pair_law-inl.h"

namespace dmf::engine {
namespace {

using HWY_NAMESPACE::density_weight;
using HWY_NAMESPACE::pair_force;
using HWY_NAMESPACE::pair_noise;
using HWY_NAMESPACE::wall_key;

std::uint32_t key_bits(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

Vector3d separation(const PairPass& pass, const Record& i, const Record& j) {
  Vector3d d(double(i.x) - j.x, double(i.y) - j.y, double(i.z) - j.z);
  for (int axis = 0; axis < 3; ++axis)
    d[axis] -= double(pass.period[axis]) * std::nearbyint(d[axis] * double(pass.inverse_period[axis]));
  return d;
}

Vector3d velocity_of(const Record& record) { return {record.x, record.y, record.z}; }

/// Calls visit(index, slot, separation) for every bead of `runs` within `cutoff` of `at`, itself excepted.
template <class Visit>
void for_each_in_range(const PairPass& pass, const Record* beads, const BeadRun* run, const BeadRun* end,
                       const Record& at, double cutoff, Visit visit) {
  std::uint32_t slot = 0;
  for (; run != end; ++run)
    for (std::uint32_t j = run->begin; j < run->end; ++j, ++slot) {
      const Vector3d d =
          Vector3d(double(at.x) - beads[j].x, double(at.y) - beads[j].y, double(at.z) - beads[j].z) -
          pass.images.shift(run->image).cast<double>();
      if (&beads[j] != &at && d.norm() < cutoff) visit(j, slot, d);
    }
}

void density(const PairPass& pass, NeighbourBlock& block) {
  const MdpdLaw<double>& law = pass.laws(Species::liquid, Species::liquid);
  block.in_range.clear();
  block.in_range_begin.assign(1, 0);
  for (const NeighbourCell& cell : block.cells)
    for (std::uint32_t bead = cell.begin; bead < cell.end; ++bead) {
      double total = 0;
      for_each_in_range(pass, pass.position, block.runs.data() + cell.first_run,
                        block.runs.data() + cell.end_run, pass.position[bead],
                        1.0 / law.inverse_cutoff_radius,
                        [&](std::uint32_t, std::uint32_t slot, const Vector3d& d) {
                          total += density_weight(d.norm(), law.inverse_repulsion_radius);
                          block.in_range.push_back(static_cast<std::uint16_t>(slot));
                        });
      block.in_range_begin.push_back(static_cast<std::uint32_t>(block.in_range.size()));
      pass.predicted[bead].w = static_cast<float>(pass.density_normalization * total);
    }
}

template <PairForce part>
void force(const PairPass& pass, const NeighbourBlock& block) {
  const MdpdLaw<double>& law = pass.laws(Species::liquid, Species::liquid);
  const MdpdLaw<double>& wall_law = pass.laws(Species::liquid, Species::wall);
  std::vector<Vector3d> total(block.end - block.begin, Vector3d::Zero());
  for_each_pair_in_range(block, [&](std::uint32_t bead, std::uint32_t other) {
    const Record &i = pass.position[bead], &j = pass.position[other];
    const Record &moving = pass.predicted[bead], &other_moving = pass.predicted[other];
    const Vector3d d = separation(pass, i, j);
    const double r = std::max(d.norm(), 1e-6);
    const double approach = d.dot(velocity_of(moving) - velocity_of(other_moving)) / r;
    const double zeta = pair_noise<double>(key_bits(i.w), key_bits(j.w));
    const double density_sum = double(moving.w) + other_moving.w;
    total[bead - block.begin] +=
        pair_force<part>(law, law.attraction, r, density_sum, approach, zeta) / r * d;
  });
  for (const NeighbourCell& cell : block.cells)
    for (std::uint32_t bead = cell.begin; bead < cell.end; ++bead) {
      const Record &i = pass.position[bead], &moving = pass.predicted[bead];
      Vector3d& sum = total[bead - block.begin];
      for_each_in_range(pass, pass.wall, block.wall_runs.data() + cell.first_wall_run,
                        block.wall_runs.data() + cell.end_wall_run, i, 1.0 / wall_law.inverse_cutoff_radius,
                        [&](std::uint32_t other, std::uint32_t, const Vector3d& d) {
                          const double r = std::max(d.norm(), 1e-6);
                          const double approach = d.dot(velocity_of(moving)) / r;
                          const double zeta = pair_noise<double>(key_bits(i.w), wall_key(other));
                          sum += pair_force<part>(wall_law, double(pass.wall[other].w), r, double(moving.w),
                                                  approach, zeta) /
                                 r * d;
                        });
      pass.force[bead] = {static_cast<float>(sum.x()), static_cast<float>(sum.y()),
                          static_cast<float>(sum.z()), 0};
    }
}

}  // namespace

Kernels reference_kernels() {
  return {"reference",
          1,
          &density,
          {&force<PairForce::all>, &force<PairForce::conservative>, &force<PairForce::random>,
           &force<PairForce::friction>}};
}

}  // namespace dmf::engine
