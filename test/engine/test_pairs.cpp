#include <gtest/gtest.h>

#include <set>

#include "systems.h"

namespace dmf::engine {
namespace {

using IdPairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

Vector3d apart(const Domain& domain, const Record& a, const Record& b) {
  Vector3d d(double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z);
  for (int axis = 0; axis < 3; ++axis)
    if (domain.periodic(axis)) d[axis] -= domain.size()[axis] * std::nearbyint(d[axis] / domain.size()[axis]);
  return d;
}

IdPairs all_within(const System& system, double range) {
  IdPairs found;
  const Beads& beads = system.beads;
  for (std::size_t i = 0; i < beads.size(); ++i)
    for (std::size_t j = 0; j < beads.size(); ++j)
      if (i != j && apart(system.parameters.domain, beads.position[i], beads.position[j]).norm() < range)
        found.insert({beads.id[i], beads.id[j]});
  return found;
}

IdPairs listed(const System& system, const Pairs& pairs) {
  IdPairs found;
  for (const NeighbourBlock& block : pairs.blocks())
    for (std::uint32_t i = block.begin; i < block.end; ++i) {
      const NeighbourRow& row = block.rows[i - block.begin];
      for (std::uint32_t k = 0; k < row.liquid_count; ++k) {
        const std::uint32_t j = block.liquid[row.liquid_begin + k] / sizeof(Record);
        EXPECT_TRUE(found.insert({system.beads.id[i], system.beads.id[j]}).second) << "listed twice";
      }
    }
  return found;
}

TEST(NeighbourList, HoldsEveryPairInRangeOnceAndNoOther) {
  for (System& system : all_systems()) {
    SCOPED_TRACE(system.name);
    const PlaneWall wall = wall_of(system);
    for (const std::string& kernel : vector_kernels()) {
      SCOPED_TRACE(kernel);
      Pairs pairs(system.parameters);
      pairs.rebuild(system.beads, wall, select_kernels(kernel));
      // Rounding decides about pairs within 1e-5 of the range.
      const IdPairs must = all_within(system, pairs.range() - 1e-5),
                    may = all_within(system, pairs.range() + 1e-5);
      const IdPairs found = listed(system, pairs);
      for (const auto& pair : must) EXPECT_EQ(found.count(pair), 1u);
      for (const auto& pair : found) EXPECT_EQ(may.count(pair), 1u);
    }
  }
}

TEST(NeighbourList, HoldsEveryWallBeadInRange) {
  for (System& system : all_systems()) {
    if (!system.parameters.domain.has_wall()) continue;
    SCOPED_TRACE(system.name);
    const PlaneWall wall = wall_of(system);
    Pairs pairs(system.parameters);
    pairs.rebuild(system.beads, wall, select_kernels("auto"));
    for (const NeighbourBlock& block : pairs.blocks())
      for (std::uint32_t i = block.begin; i < block.end; ++i) {
        const NeighbourRow& row = block.rows[i - block.begin];
        std::set<std::uint32_t> found;
        for (std::uint32_t k = 0; k < row.wall_count; ++k)
          EXPECT_TRUE(found.insert(block.wall[row.wall_begin + k] / sizeof(Record)).second);
        for (std::uint32_t w = 0; w < wall.size(); ++w) {
          const double r = apart(system.parameters.domain, system.beads.position[i], wall.beads()[w]).norm();
          if (std::abs(r - pairs.range()) < 1e-5) continue;
          EXPECT_EQ(found.count(w), r < pairs.range() ? 1u : 0u);
        }
      }
  }
}

TEST(NeighbourList, IsStaleOnceABeadMovedHalfTheSkin) {
  Pairs pairs(periodic_box(8));
  EXPECT_TRUE(pairs.stale(0));
  System system = all_systems().front();
  pairs.rebuild(system.beads, wall_of(system), select_kernels("auto"));
  const float half_skin = 0.5f * static_cast<float>(system.parameters.list_skin);
  EXPECT_FALSE(pairs.stale(0.99f * half_skin * half_skin));
  EXPECT_TRUE(pairs.stale(1.01f * half_skin * half_skin));
  pairs.invalidate();
  EXPECT_TRUE(pairs.stale(0));
}

TEST(NeighbourList, CostsMemoryForBeadsNotForTheChip) {
  System small{"small chip", plate(40, 12), {}}, large{"large chip", plate(400, 12), {}};
  for (System* system : {&small, &large})
    scatter_beads(*system, 6, {10, 10, 0}, {18, 18, 6}, [](const Vector3d&) { return true; });
  const auto bytes = [](System& system) {
    // Closed sides: the grid covers the beads.
    for (int axis = 0; axis < 2; ++axis)
      system.parameters.domain.lower_side[axis] = system.parameters.domain.upper_side[axis] =
          Side::reflecting;
    Pairs pairs(system.parameters);
    pairs.rebuild(system.beads, wall_of(system), select_kernels("auto"));
    return pairs.memory_bytes();
  };
  // The wall lattice fits each chip a little differently: a few wall neighbours more or less.
  EXPECT_NEAR(static_cast<double>(bytes(small)) / static_cast<double>(bytes(large)), 1.0, 0.02);
}

}  // namespace
}  // namespace dmf::engine
