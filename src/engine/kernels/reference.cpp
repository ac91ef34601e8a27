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

std::size_t index_of(std::uint32_t byte_offset) { return byte_offset / sizeof(Record); }

void list_candidates(const std::vector<CandidateRun>& runs, const float* xs, const float* ys, const float* zs,
                     const Vector3d& at, double range, std::uint32_t self, std::vector<std::uint32_t>& to,
                     std::uint16_t& count) {
  for (const CandidateRun& run : runs)
    for (std::uint32_t j = run.begin; j < run.end; ++j) {
      const Vector3d d = at - Vector3d(xs[j] + run.shift_x, ys[j] + run.shift_y, zs[j] + run.shift_z);
      if (j == self || d.squaredNorm() >= range * range) continue;
      to.push_back(j * static_cast<std::uint32_t>(sizeof(Record)));
      ++count;
    }
}

void list(const ListPass& pass, NeighbourBlock& block) {
  block.rows.assign(block.end - block.begin, {});
  block.liquid.clear();
  block.wall.clear();
  std::vector<CandidateRun> runs;
  for (std::uint32_t bead = block.begin; bead < block.end; ++bead) {
    NeighbourRow& row = block.rows[bead - block.begin];
    const Vector3d at(pass.x[bead], pass.y[bead], pass.z[bead]);
    row.across_periodic =
        candidate_runs(*pass.grid, *pass.domain, pass.grid->coordinate(0, pass.x[bead]),
                       pass.grid->coordinate(1, pass.y[bead]), pass.grid->coordinate(2, pass.z[bead]), runs);
    row.liquid_begin = static_cast<std::uint32_t>(block.liquid.size());
    list_candidates(runs, pass.x, pass.y, pass.z, at, pass.range, bead, block.liquid, row.liquid_count);
    if (pass.z[bead] > pass.wall_reach) continue;
    row.across_periodic |=
        candidate_runs(*pass.wall_grid, *pass.domain, pass.wall_grid->coordinate(0, pass.x[bead]),
                       pass.wall_grid->coordinate(1, pass.y[bead]), 0, runs);
    row.wall_begin = static_cast<std::uint32_t>(block.wall.size());
    list_candidates(runs, pass.wall_x, pass.wall_y, pass.wall_z, at, pass.range, 0xffffffffu, block.wall,
                    row.wall_count);
  }
  block.in_range.resize(block.liquid.size());
}

void density(const PairPass& pass, NeighbourBlock& block) {
  const MdpdLaw<double>& law = pass.laws(Species::liquid, Species::liquid);
  const double cutoff = 1.0 / law.inverse_cutoff_radius;
  for (std::uint32_t bead = block.begin; bead < block.end; ++bead) {
    NeighbourRow& row = block.rows[bead - block.begin];
    double total = 0;
    row.hits = 0;
    for (std::uint32_t k = 0; k < row.liquid_count; ++k) {
      const std::uint32_t offset = block.liquid[row.liquid_begin + k];
      const double r = separation(pass, pass.position[bead], pass.position[index_of(offset)]).norm();
      if (r >= cutoff) continue;
      total += density_weight(r, law.inverse_repulsion_radius);
      block.in_range[row.liquid_begin + row.hits++] = offset;
    }
    pass.predicted[bead].w = static_cast<float>(pass.density_normalization * total);
  }
}

template <PairForce part>
void force(const PairPass& pass, const NeighbourBlock& block) {
  const MdpdLaw<double>& law = pass.laws(Species::liquid, Species::liquid);
  const MdpdLaw<double>& wall_law = pass.laws(Species::liquid, Species::wall);
  const double cutoff = 1.0 / wall_law.inverse_cutoff_radius;
  for (std::uint32_t bead = block.begin; bead < block.end; ++bead) {
    const NeighbourRow& row = block.rows[bead - block.begin];
    const Record& i = pass.position[bead];
    const Record& moving = pass.predicted[bead];
    Vector3d total = Vector3d::Zero();
    for (std::uint32_t k = 0; k < row.hits; ++k) {
      const std::size_t other = index_of(block.in_range[row.liquid_begin + k]);
      const Record& j = pass.position[other];
      const Vector3d d = separation(pass, i, j);
      const double r = std::max(d.norm(), 1e-6);
      const double approach = d.dot(velocity_of(moving) - velocity_of(pass.predicted[other])) / r;
      const double zeta = pair_noise<double>(key_bits(i.w), key_bits(j.w));
      const double density_sum = double(moving.w) + pass.predicted[other].w;
      total += pair_force<part>(law, law.attraction, r, density_sum, approach, zeta) / r * d;
    }
    for (std::uint32_t k = 0; k < row.wall_count; ++k) {
      const std::size_t other = index_of(block.wall[row.wall_begin + k]);
      const Record& j = pass.wall[other];
      const Vector3d d = separation(pass, i, j);
      if (d.norm() >= cutoff) continue;
      const double r = std::max(d.norm(), 1e-6);
      const double approach = d.dot(velocity_of(moving)) / r;
      const double zeta = pair_noise<double>(key_bits(i.w), wall_key(static_cast<std::uint32_t>(other)));
      total += pair_force<part>(wall_law, double(j.w), r, double(moving.w), approach, zeta) / r * d;
    }
    pass.force[bead] = {static_cast<float>(total.x()), static_cast<float>(total.y()),
                        static_cast<float>(total.z()), 0};
  }
}

}  // namespace

Kernels reference_kernels() {
  return {"reference",
          1,
          &list,
          &density,
          {&force<PairForce::all>, &force<PairForce::conservative>, &force<PairForce::random>,
           &force<PairForce::friction>}};
}

}  // namespace dmf::engine
