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

/// Notes for one bead who of another kind is in its range, as NeighbourBlock::foreign has it.
void note_foreign(const PairPass& pass, const Record* others, const BeadRun* run, const BeadRun* end,
                  const Record& at, NeighbourBlock& block) {
  for_each_in_range(pass, others, run, end, at, pass.laws(Species::liquid, Species::microparticle).range(),
                    [&](std::uint32_t j, std::uint32_t, const Vector3d&) { block.foreign.push_back(j); });
  block.foreign_begin.push_back(static_cast<std::uint32_t>(block.foreign.size()));
}

/// What the beads of `runs` count in the density of a bead at `at`.
double counted(const PairPass& pass, const Record* beads, const BeadRun* run, const BeadRun* end,
               const Record& at) {
  const double inverse_radius = pass.laws(Species::liquid, Species::liquid).inverse_repulsion_radius;
  double total = 0;
  for_each_in_range(pass, beads, run, end, at, 1.0 / inverse_radius,
                    [&](std::uint32_t, std::uint32_t, const Vector3d& d) {
                      total += density_weight(d.norm(), inverse_radius);
                    });
  return pass.density_normalization * total;
}

void density(const PairPass& pass, NeighbourBlock& block) {
  const MdpdLaw<double>& law = pass.laws(Species::liquid, Species::liquid);
  block.in_range.clear();
  block.in_range_begin.assign(1, 0);
  block.foreign.clear();
  block.foreign_begin.assign(1, 0);
  for (const NeighbourCell& cell : block.cells)
    for (std::uint32_t bead = cell.begin; bead < cell.end; ++bead) {
      const BeadRun *run = block.runs.data() + cell.first_run, *end = block.runs.data() + cell.end_run;
      for_each_in_range(pass, pass.position, run, end, pass.position[bead], law.range(),
                        [&](std::uint32_t, std::uint32_t slot, const Vector3d&) {
                          block.in_range.push_back(static_cast<std::uint16_t>(slot));
                        });
      block.in_range_begin.push_back(static_cast<std::uint32_t>(block.in_range.size()));
      const BeadRun *body_run = block.body_runs.data() + cell.first_body_run,
                    *body_end = block.body_runs.data() + cell.end_body_run;
      note_foreign(pass, pass.bodies.position, body_run, body_end, pass.position[bead], block);
      double total = counted(pass, pass.position, run, end, pass.position[bead]);
      if (pass.bodies.counted_by_liquid)
        total += counted(pass, pass.bodies.position, body_run, body_end, pass.position[bead]);
      pass.predicted[bead].w = static_cast<float>(total);
    }
}

void body_density(const PairPass& pass, NeighbourBlock& block) {
  block.foreign.clear();
  block.foreign_begin.assign(1, 0);
  for (const NeighbourCell& cell : block.cells)
    for (std::uint32_t bead = cell.begin; bead < cell.end; ++bead) {
      const BeadRun *run = block.runs.data() + cell.first_run, *end = block.runs.data() + cell.end_run;
      note_foreign(pass, pass.position, run, end, pass.bodies.position[bead], block);
      double total = pass.bodies.own_density[bead];
      if (pass.bodies.count_liquid)
        total += counted(pass, pass.position, run, end, pass.bodies.position[bead]);
      pass.bodies.moving[bead].w = static_cast<float>(total);
    }
}

/// One end of a pair.
struct End {
  Vector3d velocity = Vector3d::Zero();
  double density = 0;
  std::uint32_t key = 0;
};
End liquid_end(const PairPass& pass, std::uint32_t i) {
  return {velocity_of(pass.predicted[i]), pass.predicted[i].w, key_bits(pass.position[i].w)};
}
End body_end(const PairPass& pass, std::uint32_t i) {
  return {velocity_of(pass.bodies.moving[i]), pass.bodies.moving[i].w, pass.bodies.key[i]};
}
End wall_end(std::uint32_t i) { return {Vector3d::Zero(), 0, wall_key(i)}; }
/// As a wall sees the bead.
End end_at_wall(const PairPass& pass, std::uint32_t i) {
  End end = liquid_end(pass, i);
  end.velocity = velocity_of(pass.wall_motion.relative(pass.position[i], pass.predicted[i]));
  return end;
}

template <PairForce part, DissipativeWeight weight, class Law>
Vector3d force_between(const Law& law, double attraction, const Vector3d& d, const End& i, const End& j) {
  const double r = std::max(d.norm(), 1e-6);
  const double approach = d.dot(i.velocity - j.velocity) / r;
  const double zeta = pair_noise<double>(i.key, j.key);
  return pair_force<part, weight>(law, attraction, r, i.density + j.density, approach, zeta) / r * d;
}

template <PairModel model>
Species species_of(const PairPass& pass, std::uint32_t bead) {
  if constexpr (model == PairModel::one_liquid)
    return Species::liquid;
  else
    return liquid_species(key_bits(pass.position[bead].w) & species_bits);
}

template <PairModel model>
auto law_between(const PairPass& pass, Species a, Species b) {
  if constexpr (model == PairModel::spline)
    return SplineLaw<double>{pass.laws(a, b), pass.spline};
  else
    return pass.laws(a, b);
}

Record record_of(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0};
}

/// What a liquid has with a microparticle's bead whose own attraction is `own`.
MdpdLaw<double> law_with_body(const PairPass& pass, Species liquid, double own) {
  MdpdLaw<double> law = pass.laws(liquid, Species::microparticle);
  const auto number = static_cast<std::size_t>(liquid);
  if (!pass.bodies.row || pass.bodies.row->share_of_own[number] == 1) law.attraction = own;
  return law;
}

template <PairForce part, DissipativeWeight weight, PairModel model>
void force(const PairPass& pass, const NeighbourBlock& block) {
  std::vector<Vector3d> total(block.end - block.begin, Vector3d::Zero());
  for_each_pair_in_range(block, [&](std::uint32_t bead, std::uint32_t other) {
    const auto law = law_between<model>(pass, species_of<model>(pass, bead), species_of<model>(pass, other));
    total[bead - block.begin] += force_between<part, weight>(
        law, law.attraction, separation(pass, pass.position[bead], pass.position[other]),
        liquid_end(pass, bead), liquid_end(pass, other));
  });
  const double body_range = pass.laws(Species::liquid, Species::microparticle).range();
  for (const NeighbourCell& cell : block.cells)
    for (std::uint32_t bead = cell.begin; bead < cell.end; ++bead) {
      const Record& at = pass.position[bead];
      Vector3d& sum = total[bead - block.begin];
      const Species species = species_of<model>(pass, bead);
      const auto wall_law = law_between<model>(pass, species, Species::wall);
      for_each_in_range(pass, pass.wall, block.wall_runs.data() + cell.first_wall_run,
                        block.wall_runs.data() + cell.end_wall_run, at, wall_law.range(),
                        [&](std::uint32_t other, std::uint32_t, const Vector3d& d) {
                          const double attraction =
                              species == Species::liquid ? double(pass.wall[other].w) : wall_law.attraction;
                          sum += force_between<part, weight>(wall_law, attraction, d, end_at_wall(pass, bead),
                                                             wall_end(other));
                        });
      for_each_in_range(pass, pass.bodies.position, block.body_runs.data() + cell.first_body_run,
                        block.body_runs.data() + cell.end_body_run, at, body_range,
                        [&](std::uint32_t other, std::uint32_t, const Vector3d& d) {
                          const MdpdLaw<double> law =
                              law_with_body(pass, species, pass.bodies.position[other].w);
                          sum += force_between<part, weight>(law, law.attraction, d, liquid_end(pass, bead),
                                                             body_end(pass, other));
                        });
      pass.force[bead] = record_of(sum);
    }
}

template <DissipativeWeight weight, PairModel model>
void body_force(const PairPass& pass, const NeighbourBlock& block) {
  const MdpdLaw<double>& wall_law = pass.laws(Species::wall, Species::microparticle);
  const double range = pass.laws(Species::liquid, Species::microparticle).range();
  for (const NeighbourCell& cell : block.cells)
    for (std::uint32_t bead = cell.begin; bead < cell.end; ++bead) {
      const Record& at = pass.bodies.position[bead];
      Vector3d of_liquid = Vector3d::Zero(), of_wall = Vector3d::Zero();
      for_each_in_range(
          pass, pass.position, block.runs.data() + cell.first_run, block.runs.data() + cell.end_run, at,
          range, [&](std::uint32_t other, std::uint32_t, const Vector3d& d) {
            const MdpdLaw<double> law = law_with_body(pass, species_of<model>(pass, other), at.w);
            of_liquid += force_between<PairForce::all, weight>(law, law.attraction, d, body_end(pass, bead),
                                                               liquid_end(pass, other));
          });
      for_each_in_range(pass, pass.wall, block.wall_runs.data() + cell.first_wall_run,
                        block.wall_runs.data() + cell.end_wall_run, at, wall_law.range(),
                        [&](std::uint32_t other, std::uint32_t, const Vector3d& d) {
                          of_wall += force_between<PairForce::conservative, weight>(
                              wall_law, wall_law.attraction, d, body_end(pass, bead), wall_end(other));
                        });
      pass.bodies.liquid_force[bead] = record_of(of_liquid);
      pass.bodies.wall_force[bead] = record_of(of_wall);
    }
}

template <DissipativeWeight weight, PairModel model>
Kernels kernels() {
  return {&density,
          {&force<PairForce::all, weight, model>, &force<PairForce::conservative, weight, model>,
           &force<PairForce::random, weight, model>, &force<PairForce::friction, weight, model>},
          &body_density,
          &body_force<weight, model>};
}

template <DissipativeWeight weight>
Kernels kernels_of(PairModel model) {
  return model == PairModel::one_liquid ? kernels<weight, PairModel::one_liquid>()
         : model == PairModel::mixture  ? kernels<weight, PairModel::mixture>()
                                        : kernels<weight, PairModel::spline>();
}

}  // namespace

Kernels reference_kernels(DissipativeWeight weight, PairModel model) {
  return weight == DissipativeWeight::shared ? kernels_of<DissipativeWeight::shared>(model)
                                             : kernels_of<DissipativeWeight::power>(model);
}

}  // namespace dmf::engine
