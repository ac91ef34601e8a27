// The two loops over pairs, compiled once per instruction set and chosen at run time.
//
// No list of neighbours is kept. Beads are sorted by cell now and then; every step, for every cell,
//
//   pack     beads of the cells around it that lie within r_c of the box around the cell's beads: side by
//   side sweep    each bead of the cell over them, a register at a time: who is in range, which slots (16
//   bits each) density  from the distances that the sweep kept
//
// and, once all densities are known, the force pass goes over the slots in range. Packing and sweeping a
// whole neighbourhood costs less than filtering lists with a skin and building them anew every third step
// (docs/performance.md).
#include "engine/kernels/kernels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

// A target for every x86-64 there is, two for those in use; the ones between bring little.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "engine/kernels/lanes-inl.h"
#include "engine/kernels/packed.h"
#include "engine/noise-inl.h"
#include "engine/pair_law-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dmf::engine::HWY_NAMESPACE {

HWY_INLINE MdpdLaw<Lanes> in_lanes(const MdpdLaw<double>& law) {
  const auto lanes = [](double value) HWY_ATTR { return Lanes(static_cast<float>(value)); };
  return {lanes(law.attraction),
          lanes(law.repulsion),
          lanes(law.inverse_cutoff_radius),
          lanes(law.inverse_repulsion_radius),
          lanes(law.friction),
          lanes(law.random_amplitude)};
}

HWY_INLINE Lanes squared_length(Lanes x, Lanes y, Lanes z) { return x * x + y * y + z * z; }

/// Closer than this is the bead itself. Two beads in the same place do not feel each other, instead of an
/// infinite force.
constexpr float smallest_squared_distance = 1e-12f;
constexpr float far_away = 1e15f;

// ---- pack and sweep: who is in range ----

/// Where the beads of a cell are.
struct Box {
  float middle[3], half[3];
};

HWY_INLINE Box box_around(const Record* beads, std::uint32_t begin, std::uint32_t end) {
  float lower[3] = {far_away, far_away, far_away}, upper[3] = {-far_away, -far_away, -far_away};
  for (std::uint32_t i = begin; i < end; ++i) {
    const float at[3] = {beads[i].x, beads[i].y, beads[i].z};
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], at[axis]);
      upper[axis] = std::max(upper[axis], at[axis]);
    }
  }
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.middle[axis] = 0.5f * (lower[axis] + upper[axis]);
    // The hair more covers the rounding of this and of the distances to it.
    box.half[axis] = 0.5f * (upper[axis] - lower[axis]) + 1e-3f;
  }
  return box;
}

/// Distance from the box along one axis.
HWY_INLINE Lanes outside(Lanes at, float middle, float half) {
  return maximum(absolute(at - Lanes(middle)) - Lanes(half), Lanes(0));
}

/// Packs the beads of `runs` that lie within the cutoff radius of the box. What names a packed bead is its
/// slot, or its index when `by_index`.
/// @returns how many; whole lanes behind them are far away.
template <bool by_index>
HWY_INLINE std::size_t pack(const Record* beads, const BeadRun* run, const BeadRun* end,
                            const PeriodicImages& images, const Box& box, Lanes squared_cutoff,
                            const Packed& to) {
  std::size_t count = 0;
  std::uint32_t slot = 0;
  for (; run != end; slot += run->end - run->begin, ++run) {
    const Eigen::Vector3f& shift = images.shift(run->image);
    const Lanes shift_x(shift.x()), shift_y(shift.y()), shift_z(shift.z());
    UnsignedLanes name = UnsignedLanes(by_index ? run->begin : slot) + lane_numbers();
    for (std::uint32_t j = run->begin; j < run->end; j += lane_count) {
      Lanes x, y, z;
      load_consecutive(beads + j, x, y, z);
      x = x + shift_x;
      y = y + shift_y;
      z = z + shift_z;
      const Lanes squared_distance =
          squared_length(outside(x, box.middle[0], box.half[0]), outside(y, box.middle[1], box.half[1]),
                         outside(z, box.middle[2], box.half[2]));
      const Selection near(both(first_lanes(run->end - j), squared_distance < squared_cutoff));
      append(x, near, to.x + count);
      append(y, near, to.y + count);
      append(z, near, to.z + count);
      append(name, near, to.name + count);
      count += near.count();
      name = name + UnsignedLanes(static_cast<std::uint32_t>(lane_count));
    }
  }
  store_lanes(Lanes(far_away), to.x + count);
  return count;
}

/// What a sweep looks for, as squared distances.
struct Ranges {
  Lanes cutoff, repulsion;
};

/// Who of the packed beads is in range of `bead`: appends their names to `names` and, for the density, the
/// squared distances of those in the range of the repulsion to `squared_distances`. Writes whole lanes.
/// @returns how many names; adds to `distances` how many distances.
template <bool with_distances, class Name>
HWY_INLINE std::size_t sweep(const Packed& packed, std::size_t packed_count, const Record& bead,
                             const Ranges& ranges, Name* names, float* squared_distances,
                             std::size_t& distances) {
  const Lanes at_x(bead.x), at_y(bead.y), at_z(bead.z);
  std::size_t found = 0;
  for (std::size_t k = 0; k < packed_count; k += lane_count) {
    const Lanes r2 = squared_length(at_x - load_lanes(packed.x + k), at_y - load_lanes(packed.y + k),
                                    at_z - load_lanes(packed.z + k));
    const Mask another = Lanes(smallest_squared_distance) < r2;
    const Selection in_range(both(another, r2 < ranges.cutoff));
    append(load_lanes(packed.name + k), in_range, names + found);
    found += in_range.count();
    if constexpr (with_distances) {
      const Selection repelled(both(another, r2 < ranges.repulsion));
      append(r2, repelled, squared_distances + distances);
      distances += repelled.count();
    }
  }
  return found;
}

HWY_INLINE Ranges ranges_of(const MdpdLaw<double>& law) {
  const auto squared = [](double inverse)
                           HWY_ATTR { return Lanes(static_cast<float>(1.0 / (inverse * inverse))); };
  return {squared(law.inverse_cutoff_radius), squared(law.inverse_repulsion_radius)};
}

// ---- density ----

/// Room for `count` more entries after `used` and for what whole lanes write past them. Grows by a
/// sixteenth: a block's count hardly changes.
HWY_INLINE void make_room(std::vector<std::uint16_t>& entries, std::size_t used, std::size_t count) {
  const std::size_t needed = used + count + 2 * lane_count;
  if (entries.size() >= needed) return;
  entries.reserve(needed + needed / 16);
  entries.resize(needed + needed / 16);
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
  }
  block.in_range_begin[block.end - block.begin] = static_cast<std::uint32_t>(used);
  // The force pass loads whole lanes: behind the last row, too, slots must exist.
  make_room(block.in_range, used, 0);
  std::fill_n(block.in_range.begin() + used, 2 * lane_count, std::uint16_t{0});
}

// ---- force ----

/// Separation r_i - r_j, by the nearest image where `across_periodic`.
struct Separation {
  Lanes x, y, z;
};

HWY_INLINE Lanes nearest_image(Lanes d, float period, float inverse_period) {
  return d - Lanes(period) * nearest_integer(d * Lanes(inverse_period));
}

template <bool across_periodic>
HWY_INLINE Separation separation(const PairPass& pass, const Record& i, Lanes x, Lanes y, Lanes z) {
  Separation d{Lanes(i.x) - x, Lanes(i.y) - y, Lanes(i.z) - z};
  if constexpr (across_periodic) {
    d.x = nearest_image(d.x, pass.period.x(), pass.inverse_period.x());
    d.y = nearest_image(d.y, pass.period.y(), pass.inverse_period.y());
    d.z = nearest_image(d.z, pass.period.z(), pass.inverse_period.z());
  }
  return d;
}

using ForceSum = LaneSums<3>;

HWY_INLINE void add_force(ForceSum& total, std::size_t k, const Separation& d, Lanes magnitude_over_r) {
  total.add(k, magnitude_over_r * d.x, magnitude_over_r * d.y, magnitude_over_r * d.z);
}

template <PairForce part, bool across_periodic>
HWY_INLINE void liquid_force(const PairPass& pass, const MdpdLaw<Lanes>& law, std::uint32_t bead,
                             const SlotsOfBeads& in_range, std::size_t count, ForceSum& total) {
  const Record& i = pass.position[bead];
  const Record& moving = pass.predicted[bead];
  const UnsignedLanes key_i = bits_of(Lanes(i.w));
  for (std::size_t k = 0; k < count; k += lane_count) {
    Lanes x, y, z, key, vx, vy, vz, density;
    load_records(pass.position, in_range.from(k), x, y, z, key);
    load_records(pass.predicted, in_range.from(k), vx, vy, vz, density);
    const Separation d = separation<across_periodic>(pass, i, x, y, z);
    const Lanes r = square_root(maximum(squared_length(d.x, d.y, d.z), Lanes(smallest_squared_distance)));
    const Lanes inverse_r = Lanes(1) / r;
    const Lanes approach =
        (d.x * (Lanes(moving.x) - vx) + d.y * (Lanes(moving.y) - vy) + d.z * (Lanes(moving.z) - vz)) *
        inverse_r;
    const Lanes zeta = pair_noise<Lanes>(key_i, bits_of(key));
    const Lanes force = pair_force<part>(law, law.attraction, r, Lanes(moving.w) + density, approach, zeta);
    add_force(total, k, d, zero_unless(first_lanes(count - k), force * inverse_r));
  }
}

template <PairForce part, bool across_periodic>
HWY_INLINE void wall_force(const PairPass& pass, const MdpdLaw<Lanes>& law, std::uint32_t bead,
                           const std::uint32_t* in_range, std::size_t count, ForceSum& total) {
  const Record& i = pass.position[bead];
  const Record& moving = pass.predicted[bead];
  const UnsignedLanes key_i = bits_of(Lanes(i.w));
  for (std::size_t k = 0; k < count; k += lane_count) {
    Lanes x, y, z, attraction;
    load_records(pass.wall, BeadIndices{in_range + k}, x, y, z, attraction);
    const Separation d = separation<across_periodic>(pass, i, x, y, z);
    const Lanes r = square_root(maximum(squared_length(d.x, d.y, d.z), Lanes(smallest_squared_distance)));
    const Lanes inverse_r = Lanes(1) / r;
    const Lanes approach =
        (d.x * Lanes(moving.x) + d.y * Lanes(moving.y) + d.z * Lanes(moving.z)) * inverse_r;
    const Lanes zeta = pair_noise<Lanes>(key_i, wall_key(load_lanes(in_range + k)));
    const Lanes force = pair_force<part>(law, attraction, r, Lanes(moving.w), approach, zeta);
    add_force(total, k, d, zero_unless(first_lanes(count - k), force * inverse_r));
  }
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

template <PairForce part, bool across_periodic>
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
    const SlotsOfBeads in_range{block.in_range.data() + block.in_range_begin[bead - block.begin],
                                packed.bead_in_slot};
    liquid_force<part, across_periodic>(pass, law, bead, in_range, block.in_range_count(bead), total);
    if (wall_candidates > 0) {
      std::size_t no_distances = 0;
      const std::size_t count = sweep<false>(packed, wall_candidates, pass.position[bead], wall_ranges,
                                             packed.wall_in_range, nullptr, no_distances);
      // Whole lanes are loaded: what stands behind the last must name a bead.
      store_lanes(UnsignedLanes(0), packed.wall_in_range + count);
      wall_force<part, across_periodic>(pass, wall_law, bead, packed.wall_in_range, count, total);
    }
    pass.force[bead] = {total.total(0), total.total(1), total.total(2), 0.f};
  }
}

template <PairForce part>
void force(const PairPass& pass, const NeighbourBlock& block) {
  const Packed packed = Workbench::of_this_thread().room_for(block);
  for (const NeighbourCell& cell : block.cells)
    if (cell.across_periodic)
      force_on_cell<part, true>(pass, block, cell, packed);
    else
      force_on_cell<part, false>(pass, block, cell, packed);
}

Kernels table() {
  return {hwy::TargetName(HWY_TARGET),
          lane_count,
          &density,
          {&force<PairForce::all>, &force<PairForce::conservative>, &force<PairForce::random>,
           &force<PairForce::friction>}};
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

Kernels select_kernels(const std::string& name) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (name != "auto" && name != kernel_name(target)) continue;
    // Highway dispatches on a process-wide choice; make it only for this look-up.
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    const Kernels kernels = HWY_DYNAMIC_DISPATCH(table)();
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return kernels;
  }
  throw InvalidInput(
      fmt::format("kernel: {}, allowed: auto, {}, reference", name, fmt::join(vector_kernels(), ", ")));
}

}  // namespace dmf::engine
#endif
