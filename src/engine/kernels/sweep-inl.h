// Who is in range: packs what is near a cell and sweeps over it. Compiled per instruction set.
#if defined(DMF_ENGINE_SWEEP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DMF_ENGINE_SWEEP_INL_H
#undef DMF_ENGINE_SWEEP_INL_H
#else
#define DMF_ENGINE_SWEEP_INL_H
#endif

#include <algorithm>
#include <vector>

#include "engine/kernels/lanes-inl.h"
#include "engine/kernels/packed.h"
#include "engine/pair_law.h"

HWY_BEFORE_NAMESPACE();
namespace dmf::engine::HWY_NAMESPACE {

HWY_INLINE Lanes squared_length(Lanes x, Lanes y, Lanes z) { return x * x + y * y + z * z; }

/// Closer than this is the bead itself. Two beads in the same place do not feel each other, instead of an
/// infinite force.
constexpr float smallest_squared_distance = 1e-12f;
constexpr float far_away = 1e15f;

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
  return {squared(1.0 / law.range()), squared(law.inverse_repulsion_radius)};
}

}  // namespace dmf::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
