// The two loops over pairs and the list build, compiled once per instruction set and chosen at run time.
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

/// Separation r_i - r_j, by the nearest image where `across_periodic`.
struct Separation {
  Lanes x, y, z;
};

HWY_INLINE Lanes squared_length(Lanes x, Lanes y, Lanes z) { return x * x + y * y + z * z; }

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

/// Coincident beads feel no force from each other instead of an infinite one.
constexpr float smallest_squared_distance = 1e-12f;

// ---- density ----

template <bool across_periodic>
HWY_INLINE void density_of_bead(const PairPass& pass, std::uint32_t bead, NeighbourBlock& block,
                                NeighbourRow& row) {
  const Record& i = pass.position[bead];
  const MdpdLaw<double>& law = pass.laws(Species::liquid, Species::liquid);
  const Lanes squared_cutoff(
      static_cast<float>(1.0 / (law.inverse_cutoff_radius * law.inverse_cutoff_radius)));
  const Lanes inverse_repulsion_radius(static_cast<float>(law.inverse_repulsion_radius));
  const std::uint32_t* neighbours = block.liquid.data() + row.liquid_begin;
  std::uint32_t* hits = block.in_range.data() + row.liquid_begin;
  std::size_t hit_count = 0;
  Lanes density(0);
  for (std::size_t k = 0; k < row.liquid_count; k += lane_count) {
    Lanes x, y, z, key;
    load_records(pass.position, neighbours + k, x, y, z, key);
    const Separation d = separation<across_periodic>(pass, i, x, y, z);
    const Lanes r2 = squared_length(d.x, d.y, d.z);
    const Mask in_range = both(first_lanes(row.liquid_count - k), r2 < squared_cutoff);
    density = density + zero_unless(in_range, density_weight(square_root(r2), inverse_repulsion_radius));
    hit_count += append(load_lanes(neighbours + k), in_range, hits + hit_count);
  }
  // The force pass loads whole lanes: let the tail point at a valid record.
  for (std::size_t k = 0; k < lane_count; ++k) hits[hit_count + k] = bead * sizeof(Record);
  row.hits = static_cast<std::uint16_t>(hit_count);
  pass.predicted[bead].w = static_cast<float>(pass.density_normalization) * sum(density);
}

void density(const PairPass& pass, NeighbourBlock& block) {
  for (std::uint32_t bead = block.begin; bead < block.end; ++bead) {
    NeighbourRow& row = block.rows[bead - block.begin];
    if (row.across_periodic)
      density_of_bead<true>(pass, bead, block, row);
    else
      density_of_bead<false>(pass, bead, block, row);
  }
}

// ---- force ----

struct ForceSum {
  Lanes x, y, z;
  HWY_INLINE void add(const Separation& d, Lanes magnitude_over_r) {
    x = x + magnitude_over_r * d.x;
    y = y + magnitude_over_r * d.y;
    z = z + magnitude_over_r * d.z;
  }
};

template <PairForce part, bool across_periodic>
HWY_INLINE void liquid_force(const PairPass& pass, const MdpdLaw<Lanes>& law, std::uint32_t bead,
                             const NeighbourBlock& block, const NeighbourRow& row, ForceSum& total) {
  const Record& i = pass.position[bead];
  const Record& moving = pass.predicted[bead];
  const UnsignedLanes key_i = bits_of(Lanes(i.w));
  const std::uint32_t* hits = block.in_range.data() + row.liquid_begin;
  for (std::size_t k = 0; k < row.hits; k += lane_count) {
    Lanes x, y, z, key, vx, vy, vz, density;
    load_records(pass.position, hits + k, x, y, z, key);
    load_records(pass.predicted, hits + k, vx, vy, vz, density);
    const Separation d = separation<across_periodic>(pass, i, x, y, z);
    const Lanes r = square_root(maximum(squared_length(d.x, d.y, d.z), Lanes(smallest_squared_distance)));
    const Lanes inverse_r = Lanes(1) / r;
    const Lanes approach =
        (d.x * (Lanes(moving.x) - vx) + d.y * (Lanes(moving.y) - vy) + d.z * (Lanes(moving.z) - vz)) *
        inverse_r;
    const Lanes zeta = pair_noise<Lanes>(key_i, bits_of(key));
    const Lanes force = pair_force<part>(law, law.attraction, r, Lanes(moving.w) + density, approach, zeta);
    total.add(d, zero_unless(first_lanes(row.hits - k), force * inverse_r));
  }
}

template <PairForce part, bool across_periodic>
HWY_INLINE void wall_force(const PairPass& pass, const MdpdLaw<Lanes>& law, std::uint32_t bead,
                           const NeighbourBlock& block, const NeighbourRow& row, ForceSum& total) {
  const Record& i = pass.position[bead];
  const Record& moving = pass.predicted[bead];
  const UnsignedLanes key_i = bits_of(Lanes(i.w));
  const Lanes squared_cutoff = Lanes(1) / (law.inverse_cutoff_radius * law.inverse_cutoff_radius);
  const std::uint32_t* neighbours = block.wall.data() + row.wall_begin;
  for (std::size_t k = 0; k < row.wall_count; k += lane_count) {
    Lanes x, y, z, attraction;
    load_records(pass.wall, neighbours + k, x, y, z, attraction);
    const Separation d = separation<across_periodic>(pass, i, x, y, z);
    const Lanes r2 = squared_length(d.x, d.y, d.z);
    const Lanes r = square_root(maximum(r2, Lanes(smallest_squared_distance)));
    const Lanes inverse_r = Lanes(1) / r;
    const Lanes approach =
        (d.x * Lanes(moving.x) + d.y * Lanes(moving.y) + d.z * Lanes(moving.z)) * inverse_r;
    const Lanes zeta = pair_noise<Lanes>(key_i, wall_key(load_lanes(neighbours + k) >> 4));
    const Lanes force = pair_force<part>(law, attraction, r, Lanes(moving.w), approach, zeta);
    const Mask in_range = both(first_lanes(row.wall_count - k), r2 < squared_cutoff);
    total.add(d, zero_unless(in_range, force * inverse_r));
  }
}

template <PairForce part>
void force(const PairPass& pass, const NeighbourBlock& block) {
  const MdpdLaw<Lanes> law = in_lanes(pass.laws(Species::liquid, Species::liquid));
  const MdpdLaw<Lanes> wall_law = in_lanes(pass.laws(Species::liquid, Species::wall));
  for (std::uint32_t bead = block.begin; bead < block.end; ++bead) {
    const NeighbourRow& row = block.rows[bead - block.begin];
    ForceSum total{Lanes(0), Lanes(0), Lanes(0)};
    if (row.across_periodic) {
      liquid_force<part, true>(pass, law, bead, block, row, total);
      wall_force<part, true>(pass, wall_law, bead, block, row, total);
    } else {
      liquid_force<part, false>(pass, law, bead, block, row, total);
      if (row.wall_count > 0) wall_force<part, false>(pass, wall_law, bead, block, row, total);
    }
    pass.force[bead] = {sum(total.x), sum(total.y), sum(total.z), 0.f};
  }
}

// ---- list ----

/// Appends the offsets of all candidates within `range` of (x, y, z), but not `self`. `to` has room for all
/// of them.
HWY_INLINE std::size_t list_in_range(const std::vector<CandidateRun>& runs, const float* xs, const float* ys,
                                     const float* zs, float x, float y, float z, float range,
                                     std::uint32_t self, std::uint32_t* to) {
  const Lanes squared_range(range * range);
  std::size_t found = 0;
  for (const CandidateRun& run : runs) {
    const Lanes from_x(x - run.shift_x), from_y(y - run.shift_y), from_z(z - run.shift_z);
    for (std::uint32_t j = run.begin; j < run.end; j += lane_count) {
      // Three numbers, not a struct: GCC 12 copies a struct of vectors through memory here, four times the
      // cost.
      const Lanes r2 = squared_length(from_x - load_lanes(xs + j), from_y - load_lanes(ys + j),
                                      from_z - load_lanes(zs + j));
      const UnsignedLanes index = UnsignedLanes(j) + lane_numbers();
      const Mask near = both(first_lanes(run.end - j), r2 < squared_range);
      found += append(index * UnsignedLanes(static_cast<std::uint32_t>(sizeof(Record))),
                      both(near, different(index, UnsignedLanes(self))), to + found);
    }
  }
  return found;
}

HWY_INLINE std::size_t candidate_count(const std::vector<CandidateRun>& runs) {
  std::size_t count = 0;
  for (const CandidateRun& run : runs) count += run.end - run.begin;
  return count;
}

/// Room for `count` more entries after `used`, plus what whole lanes write past the end. Grows by half, so
/// that a run reaches its size within a few builds.
HWY_INLINE void make_room(std::vector<std::uint32_t>& entries, std::size_t used, std::size_t count) {
  const std::size_t needed = used + count + 2 * lane_count;
  if (entries.size() < needed) entries.resize(needed + needed / 2);
}

void list(const ListPass& pass, NeighbourBlock& block) {
  constexpr std::uint32_t no_self = 0xffffffffu;
  std::vector<CandidateRun> liquid_runs, wall_runs;
  std::size_t listed_cell = static_cast<std::size_t>(-1), candidates = 0;
  bool liquid_across = false;
  block.liquid_used = block.wall_used = 0;
  block.rows.assign(block.end - block.begin, {});
  for (std::uint32_t bead = block.begin; bead < block.end; ++bead) {
    const float x = pass.x[bead], y = pass.y[bead], z = pass.z[bead];
    // Beads come sorted by cell: those of one cell share their candidates.
    const std::size_t cell = pass.grid->cell_of(x, y, z);
    if (cell != listed_cell) {
      liquid_across = candidate_runs(*pass.grid, *pass.domain, pass.grid->coordinate(0, x),
                                     pass.grid->coordinate(1, y), pass.grid->coordinate(2, z), liquid_runs);
      candidates = candidate_count(liquid_runs);
      listed_cell = cell;
    }
    NeighbourRow& row = block.rows[bead - block.begin];
    make_room(block.liquid, block.liquid_used, candidates);
    row.liquid_begin = static_cast<std::uint32_t>(block.liquid_used);
    row.liquid_count =
        static_cast<std::uint16_t>(list_in_range(liquid_runs, pass.x, pass.y, pass.z, x, y, z, pass.range,
                                                 bead, block.liquid.data() + block.liquid_used));
    block.liquid_used += row.liquid_count;
    row.across_periodic = liquid_across;
    if (z > pass.wall_reach) continue;
    const bool wall_across = candidate_runs(*pass.wall_grid, *pass.domain, pass.wall_grid->coordinate(0, x),
                                            pass.wall_grid->coordinate(1, y), 0, wall_runs);
    make_room(block.wall, block.wall_used, candidate_count(wall_runs));
    row.wall_begin = static_cast<std::uint32_t>(block.wall_used);
    row.wall_count =
        static_cast<std::uint16_t>(list_in_range(wall_runs, pass.wall_x, pass.wall_y, pass.wall_z, x, y, z,
                                                 pass.range, no_self, block.wall.data() + block.wall_used));
    block.wall_used += row.wall_count;
    row.across_periodic |= wall_across;
  }
  // Whole lanes are read past the last row: they must name records that exist.
  make_room(block.liquid, block.liquid_used, 0);
  make_room(block.wall, block.wall_used, 0);
  std::fill_n(block.liquid.begin() + block.liquid_used, 2 * lane_count, 0u);
  std::fill_n(block.wall.begin() + block.wall_used, 2 * lane_count, 0u);
  block.in_range.resize(block.liquid.size());
}

Kernels table() {
  return {hwy::TargetName(HWY_TARGET),
          lane_count,
          &list,
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
