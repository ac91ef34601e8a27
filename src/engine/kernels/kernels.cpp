// The two loops over pairs, compiled once per instruction set and chosen at run time.
//
// No list of neighbours is kept. Beads are sorted by cell now and then; every step, for every cell:
// - pack: beads of the cells around it that lie within r_c of the box around its beads, side by side;
// - sweep: each of its beads over them, a register at a time: who is in range, as slots of 16 bits;
// - density: from the distances that the sweep kept.
// Once all densities are known, the force pass goes over the slots in range. Packing and sweeping a whole
// neighbourhood costs less than filtering lists with a skin and building them anew every third step
// (docs/performance.md).
//
// Wall beads and beads of microparticles near a cell come after its liquid, each kind packed and swept by
// itself. What the liquid does to a microparticle is found from the other side: its beads form cells of
// their own, with runs of liquid around them.
#include "engine/kernels/kernels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <type_traits>

// A target for every x86-64 there is, two for those in use; the ones between bring little.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "engine/kernels/lanes-inl.h"
#include "engine/kernels/packed.h"
#include "engine/kernels/partners-inl.h"
#include "engine/kernels/sweep-inl.h"
#include "engine/noise-inl.h"
#include "engine/pair_law-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dmf::engine::HWY_NAMESPACE {

// ---- density ----

/// Room for `count` more entries after `used` and for what whole lanes write past them. Grows by a
/// sixteenth: a block's count hardly changes.
template <class Entry>
HWY_INLINE void make_room(std::vector<Entry>& entries, std::size_t used, std::size_t count) {
  const std::size_t needed = used + count + 2 * lane_count;
  if (entries.size() >= needed) return;
  entries.reserve(needed + needed / 16);
  entries.resize(needed + needed / 16);
}

/// The force pass loads whole lanes: behind the last row, too, entries must name something that exists.
template <class Entry>
HWY_INLINE void end_rows(std::vector<Entry>& entries, std::size_t used) {
  make_room(entries, used, 0);
  std::fill_n(entries.begin() + static_cast<std::ptrdiff_t>(used), 2 * lane_count, Entry{0});
}

HWY_INLINE float density_from(const float* squared_distances, std::size_t count,
                              Lanes inverse_repulsion_radius) {
  LaneSums<1> density;
  for (std::size_t k = 0; k < count; k += lane_count) {
    const Lanes weight =
        density_weight(square_root(load_lanes(squared_distances + k)), inverse_repulsion_radius);
    density.add(k, zero_unless(first_lanes(count - k), weight));
  }
  return density.total(0);
}

/// Beads of one kind in a cell, and beads of another kind near it.
struct Foreign {
  const Record* own;
  Record* moving;  ///< of the own; w is their density
  const Record* others;
  const BeadRun *run, *end;  ///< of the others
  bool counted;              ///< in the density
};

/// Notes who of another kind is in range of each bead of a cell, and adds to its density what those count.
HWY_INLINE void find_foreign(const PairPass& pass, const Foreign& near, const NeighbourCell& cell,
                             NeighbourBlock& block, const Packed& packed) {
  const MdpdLaw<double>& law = pass.laws(Species::liquid, Species::microparticle);
  const Ranges ranges = ranges_of(law);
  const Lanes inverse_repulsion_radius(static_cast<float>(law.inverse_repulsion_radius));
  const std::size_t candidates =
      near.run == near.end ? 0
                           : pack<true>(near.others, near.run, near.end, pass.images,
                                        box_around(near.own, cell.begin, cell.end), ranges.cutoff, packed);
  std::size_t used = block.foreign_begin[cell.begin - block.begin], distances = 0;
  for (std::uint32_t bead = cell.begin; bead < cell.end; ++bead) {
    packed.first_distance[bead - cell.begin] = static_cast<std::uint32_t>(distances);
    make_room(block.foreign, used, candidates);
    used += sweep<true>(packed, candidates, near.own[bead], ranges, block.foreign.data() + used,
                        packed.squared_distance, distances);
    block.foreign_begin[bead + 1 - block.begin] = static_cast<std::uint32_t>(used);
  }
  packed.first_distance[cell.end - cell.begin] = static_cast<std::uint32_t>(distances);
  if (distances == 0 || !near.counted) return;
  for (std::uint32_t bead = cell.begin; bead < cell.end; ++bead) {
    const std::uint32_t* first = &packed.first_distance[bead - cell.begin];
    near.moving[bead].w +=
        static_cast<float>(pass.density_normalization) *
        density_from(packed.squared_distance + first[0], first[1] - first[0], inverse_repulsion_radius);
  }
}

void density(const PairPass& pass, NeighbourBlock& block) {
  const MdpdLaw<double>& law = pass.laws(Species::liquid, Species::liquid);
  const Ranges ranges = ranges_of(law);
  const Lanes inverse_repulsion_radius(static_cast<float>(law.inverse_repulsion_radius));
  const Packed packed = Workbench::of_this_thread().room_for(block);
  std::size_t used = 0;
  for (const NeighbourCell& cell : block.cells) {
    const std::size_t candidates =
        pack<false>(pass.position, &block.runs[cell.first_run], block.runs.data() + cell.end_run, pass.images,
                    box_around(pass.position, cell.begin, cell.end), ranges.cutoff, packed);
    std::size_t slots = 0, distances = 0;
    for (std::uint32_t bead = cell.begin; bead < cell.end; ++bead) {
      block.in_range_begin[bead - block.begin] = static_cast<std::uint32_t>(used + slots);
      packed.first_distance[bead - cell.begin] = static_cast<std::uint32_t>(distances);
      slots += sweep<true>(packed, candidates, pass.position[bead], ranges, packed.in_range + slots,
                           packed.squared_distance, distances);
    }
    packed.first_distance[cell.end - cell.begin] = static_cast<std::uint32_t>(distances);
    make_room(block.in_range, used, slots);
    std::copy_n(packed.in_range, slots, block.in_range.begin() + static_cast<std::ptrdiff_t>(used));
    used += slots;
    // Not in the loop above: reading back what overlapping stores have just written stalls the processor.
    for (std::uint32_t bead = cell.begin; bead < cell.end; ++bead) {
      const std::uint32_t* first = &packed.first_distance[bead - cell.begin];
      pass.predicted[bead].w =
          static_cast<float>(pass.density_normalization) *
          density_from(packed.squared_distance + first[0], first[1] - first[0], inverse_repulsion_radius);
    }
    if (!block.body_runs.empty())
      find_foreign(
          pass,
          {pass.position, pass.predicted, pass.bodies.position, block.body_runs.data() + cell.first_body_run,
           block.body_runs.data() + cell.end_body_run, pass.bodies.counted_by_liquid},
          cell, block, packed);
  }
  block.in_range_begin[block.end - block.begin] = static_cast<std::uint32_t>(used);
  end_rows(block.in_range, used);
  if (!block.body_runs.empty()) end_rows(block.foreign, block.foreign_begin.back());
}

void body_density(const PairPass& pass, NeighbourBlock& block) {
  const Packed packed = Workbench::of_this_thread().room_for(block);
  for (const NeighbourCell& cell : block.cells) {
    for (std::uint32_t bead = cell.begin; bead < cell.end; ++bead)
      pass.bodies.moving[bead].w = pass.bodies.own_density[bead];
    find_foreign(pass,
                 {pass.bodies.position, pass.bodies.moving, pass.position, block.runs.data() + cell.first_run,
                  block.runs.data() + cell.end_run, pass.bodies.count_liquid},
                 cell, block, packed);
  }
  end_rows(block.foreign, block.foreign_begin.back());
}

// ---- force ----

using ForceSum = LaneSums<3>;

/// @param laws  what law_with() knows.
template <PairForce part, DissipativeWeight weight, bool across_periodic, class Laws, class Others>
HWY_INLINE void add_forces(const PairPass& pass, const Laws& laws, const Receiver& i, const Others& others,
                           std::size_t count, ForceSum& total) {
  for (std::size_t k = 0; k < count; k += lane_count) {
    Partners j = others.load(k);
    const auto& law = law_with(laws, j);
    const Separation d = separation<across_periodic>(pass, i.position, j.x, j.y, j.z);
    const Lanes r = square_root(maximum(squared_length(d.x, d.y, d.z), Lanes(smallest_squared_distance)));
    const Lanes inverse_r = Lanes(1) / r;
    const Lanes approach = (d.x * (Lanes(i.moving.x) - j.vx) + d.y * (Lanes(i.moving.y) - j.vy) +
                            d.z * (Lanes(i.moving.z) - j.vz)) *
                           inverse_r;
    const Lanes zeta = pair_noise<Lanes>(i.key, j.key);
    const Lanes force =
        pair_force<part, weight>(law, j.attraction, r, Lanes(i.moving.w) + j.density, approach, zeta);
    const Lanes over_r = zero_unless(first_lanes(count - k), force * inverse_r);
    total.add(k, over_r * d.x, over_r * d.y, over_r * d.z);
  }
}

/// Indices of the packed wall beads in range of `bead`, in packed.wall_in_range. @returns how many.
HWY_INLINE std::size_t find_wall(const Packed& packed, std::size_t candidates, const Record& bead,
                                 const Ranges& ranges) {
  std::size_t no_distances = 0;
  const std::size_t count =
      sweep<false>(packed, candidates, bead, ranges, packed.wall_in_range, nullptr, no_distances);
  // Whole lanes are loaded: what stands behind the last must name a bead.
  store_lanes(UnsignedLanes(0), packed.wall_in_range + count);
  return count;
}

/// Writes the index of the bead in each slot. Behind the last slot stands a bead that exists: whole lanes are
/// loaded there, and a lane that does not count must still hold finite numbers, for it is multiplied by zero.
HWY_INLINE void number_slots(const BeadRun* run, const BeadRun* end, std::uint32_t* bead_in_slot) {
  for (; run != end; ++run) {
    UnsignedLanes index = UnsignedLanes(run->begin) + lane_numbers();
    for (std::uint32_t j = 0; j < run->end - run->begin; j += lane_count) {
      store_lanes(index, bead_in_slot + j);
      index = index + UnsignedLanes(static_cast<std::uint32_t>(lane_count));
    }
    bead_in_slot += run->end - run->begin;
  }
  store_lanes(UnsignedLanes(0), bead_in_slot);
}

/// Adds what liquid in range does to a bead.
template <PairForce part, DissipativeWeight weight, PairModel model, bool across_periodic>
HWY_INLINE void add_liquid_forces(const PairPass& pass, const MdpdLaw<Lanes>& law, const Receiver& i,
                                  const SlotsOfBeads& in_range, std::size_t count, ForceSum& total) {
  const Liquid<SlotsOfBeads> liquid{pass, in_range, law.attraction};
  if constexpr (model == PairModel::one_liquid) {
    add_forces<part, weight, across_periodic>(pass, law, i, liquid, count, total);
  } else {
    const auto shared = law_between<model>(pass, Species::liquid, Species::liquid);
    const LawsOfLiquid<std::decay_t<decltype(shared)>> laws(shared, pass.rows[species_number(i.position)]);
    add_forces<part, weight, across_periodic>(pass, laws, i, liquid, count, total);
  }
}

/// Adds what the wall beads in range, whose indices are packed, do to it.
template <PairForce part, DissipativeWeight weight, PairModel model, bool across_periodic>
HWY_INLINE void add_wall_forces(const PairPass& pass, const MdpdLaw<Lanes>& law, const Receiver& i,
                                const Packed& packed, std::size_t count, ForceSum& total) {
  const WallBeads wall{pass, packed.wall_in_range};
  if constexpr (model == PairModel::one_liquid) {
    add_forces<part, weight, across_periodic>(pass, law, i, wall, count, total);
  } else {
    const std::uint32_t number = species_number(i.position);
    const auto own = law_between<model>(pass, liquid_species(number), Species::wall);
    const SeenInMixture<WallBeads> seen{wall, Lanes(number == 0 ? 1 : 0),
                                        number == 0 ? Lanes(0) : own.attraction};
    add_forces<part, weight, across_periodic>(pass, own, i, seen, count, total);
  }
}

template <PairForce part, DissipativeWeight weight, PairModel model, bool across_periodic>
HWY_INLINE void force_on_cell(const PairPass& pass, const NeighbourBlock& block, const NeighbourCell& cell,
                              const Packed& packed) {
  const MdpdLaw<Lanes> law = in_lanes(pass.laws(Species::liquid, Species::liquid));
  const MdpdLaw<Lanes> wall_law = in_lanes(pass.laws(Species::liquid, Species::wall));
  const Ranges wall_ranges = ranges_of(pass.laws(Species::liquid, Species::wall));
  std::size_t wall_candidates = 0;
  if (cell.first_wall_run < cell.end_wall_run)
    wall_candidates = pack<true>(pass.wall, &block.wall_runs[cell.first_wall_run],
                                 block.wall_runs.data() + cell.end_wall_run, pass.images,
                                 box_around(pass.position, cell.begin, cell.end), wall_ranges.cutoff, packed);
  number_slots(&block.runs[cell.first_run], block.runs.data() + cell.end_run, packed.bead_in_slot);
  for (std::uint32_t bead = cell.begin; bead < cell.end; ++bead) {
    ForceSum total;
    const Receiver i{pass.position[bead], pass.predicted[bead], bits_of(Lanes(pass.position[bead].w))};
    const SlotsOfBeads in_range{block.in_range.data() + block.in_range_begin[bead - block.begin],
                                packed.bead_in_slot};
    add_liquid_forces<part, weight, model, across_periodic>(pass, law, i, in_range,
                                                            block.in_range_count(bead), total);
    if (wall_candidates > 0) {
      const std::size_t count = find_wall(packed, wall_candidates, i.position, wall_ranges);
      const Record moving = pass.wall_motion.relative(i.position, i.moving);
      add_wall_forces<part, weight, model, across_periodic>(
          pass, wall_law, Receiver{i.position, moving, i.key}, packed, count, total);
    }
    pass.force[bead] = {total.total(0), total.total(1), total.total(2), 0.f};
  }
}

HWY_INLINE void add_to(Record& force, const ForceSum& total) {
  force.x += total.total(0);
  force.y += total.total(1);
  force.z += total.total(2);
}

/// Adds what the microparticles near a cell do to its liquid.
template <PairForce part, DissipativeWeight weight, PairModel model>
HWY_INLINE void add_body_forces(const PairPass& pass, const NeighbourBlock& block,
                                const NeighbourCell& cell) {
  const MdpdLaw<Lanes> law = in_lanes(pass.laws(Species::liquid, Species::microparticle));
  for (std::uint32_t bead = cell.begin; bead < cell.end; ++bead) {
    const auto [first, last] = block.foreign_in_range(bead);
    if (first == last) continue;
    const auto count = static_cast<std::size_t>(last - first);
    ForceSum total;
    const Receiver i{pass.position[bead], pass.predicted[bead], bits_of(Lanes(pass.position[bead].w))};
    const BodyBeads beads{pass, first};
    if constexpr (model == PairModel::one_liquid) {
      add_forces<part, weight, true>(pass, law, i, beads, count, total);
    } else {
      const std::uint32_t number = species_number(i.position);
      const SeenInMixture<BodyBeads> seen{beads, Lanes(pass.bodies.row->share_of_own[number]),
                                          Lanes(pass.bodies.row->attraction[number])};
      add_forces<part, weight, true>(
          pass, in_lanes(pass.laws(liquid_species(number), Species::microparticle)), i, seen, count, total);
    }
    add_to(pass.force[bead], total);
  }
}

template <PairForce part, DissipativeWeight weight, PairModel model>
void force(const PairPass& pass, const NeighbourBlock& block) {
  const Packed packed = Workbench::of_this_thread().room_for(block);
  for (const NeighbourCell& cell : block.cells) {
    if (cell.across_periodic)
      force_on_cell<part, weight, model, true>(pass, block, cell, packed);
    else
      force_on_cell<part, weight, model, false>(pass, block, cell, packed);
    if (cell.first_body_run < cell.end_body_run) add_body_forces<part, weight, model>(pass, block, cell);
  }
}

/// What liquid and wall do to the beads of microparticles, each by itself.
template <DissipativeWeight weight, bool mixture>
void body_force(const PairPass& pass, const NeighbourBlock& block) {
  const MdpdLaw<Lanes> law = in_lanes(pass.laws(Species::liquid, Species::microparticle));
  const MdpdLaw<Lanes> wall_law = in_lanes(pass.laws(Species::wall, Species::microparticle));
  const Ranges wall_ranges = ranges_of(pass.laws(Species::wall, Species::microparticle));
  const Packed packed = Workbench::of_this_thread().room_for(block);
  const auto receiver = [&](std::uint32_t bead) HWY_ATTR {
    return Receiver{pass.bodies.position[bead], pass.bodies.moving[bead], body_key(UnsignedLanes(bead))};
  };
  for (const NeighbourCell& cell : block.cells) {
    for (std::uint32_t bead = cell.begin; bead < cell.end; ++bead) {
      ForceSum total;
      const Receiver i = receiver(bead);
      const auto [first, last] = block.foreign_in_range(bead);
      const auto count = static_cast<std::size_t>(last - first);
      const Liquid<BeadIndices> liquid{pass, {first}, Lanes(i.position.w)};
      if constexpr (mixture)
        add_forces<PairForce::all, weight, true>(
            pass, LawsOfMicroparticle<MdpdLaw<Lanes>>(law, *pass.bodies.row), i, liquid, count, total);
      else
        add_forces<PairForce::all, weight, true>(pass, law, i, liquid, count, total);
      pass.bodies.liquid_force[bead] = {total.total(0), total.total(1), total.total(2), 0.f};
    }
    const std::size_t candidates = pack<true>(
        pass.wall, block.wall_runs.data() + cell.first_wall_run, block.wall_runs.data() + cell.end_wall_run,
        pass.images, box_around(pass.bodies.position, cell.begin, cell.end), wall_ranges.cutoff, packed);
    for (std::uint32_t bead = cell.begin; bead < cell.end; ++bead) {
      ForceSum total;
      const Receiver i = receiver(bead);
      const std::size_t count = find_wall(packed, candidates, i.position, wall_ranges);
      const WallUnderBody wall{{pass, packed.wall_in_range}, wall_law.attraction};
      add_forces<PairForce::conservative, weight, true>(pass, wall_law, i, wall, count, total);
      pass.bodies.wall_force[bead] = {total.total(0), total.total(1), total.total(2), 0.f};
    }
  }
}

template <DissipativeWeight weight, PairModel model>
Kernels table_for() {
  return {&density,
          {&force<PairForce::all, weight, model>, &force<PairForce::conservative, weight, model>,
           &force<PairForce::random, weight, model>, &force<PairForce::friction, weight, model>},
          &body_density,
          &body_force<weight, model != PairModel::one_liquid>};
}

Kernels table(DissipativeWeight weight, PairModel model) {
  const bool shared = weight == DissipativeWeight::shared;
  switch (model) {
    case PairModel::one_liquid:
      return shared ? table_for<DissipativeWeight::shared, PairModel::one_liquid>()
                    : table_for<DissipativeWeight::power, PairModel::one_liquid>();
    case PairModel::mixture:
      return shared ? table_for<DissipativeWeight::shared, PairModel::mixture>()
                    : table_for<DissipativeWeight::power, PairModel::mixture>();
    case PairModel::spline:  // it shares no weight with friction, so that any s is the same work
      break;
  }
  return table_for<DissipativeWeight::power, PairModel::spline>();
}

}  // namespace dmf::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "engine/parameters.h"

namespace dmf::engine {
namespace {
HWY_EXPORT(table);

/// Highway's name as a user knows it.
std::string kernel_name(std::int64_t target) {
  std::string name = hwy::TargetName(target);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name == "avx3" ? "avx512" : name;
}
}  // namespace

std::vector<std::string> vector_kernels() {
  std::vector<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) names.push_back(kernel_name(target));
  return names;
}

Kernels select_kernels(const std::string& name, DissipativeWeight weight, PairModel model) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (name != "auto" && name != kernel_name(target)) continue;
    // Highway dispatches on a process-wide choice; make it only for this look-up.
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    const Kernels kernels = HWY_DYNAMIC_DISPATCH(table)(weight, model);
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return kernels;
  }
  throw InvalidInput(
      fmt::format("kernel: {}, allowed: auto, {}, reference", name, fmt::join(vector_kernels(), ", ")));
}

}  // namespace dmf::engine
#endif
