#include <gtest/gtest.h>

#include <map>
#include <set>

#include "engine/simulation.h"
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

/// Moves every bead by less than half the skin, its own way: what happens between two sorts.
void jiggle(System& system) {
  const float reach = 0.49f * static_cast<float>(system.parameters.list_skin);
  for (std::size_t i = 0; i < system.beads.size(); ++i) {
    const auto step = [&](std::uint32_t k) {
      return reach * static_cast<float>(2 * scatter(31 * system.beads.id[i] + k) - 1) / 1.7321f;
    };
    Record& p = system.beads.position[i];
    const Domain& domain = system.parameters.domain;
    p.x += step(0);
    p.y += step(1);
    p.z += step(2);
    if (domain.has_wall()) p.z = std::max(p.z, 0.f);
    if (domain.has_top_plate()) p.z = std::min(p.z, static_cast<float>(domain.upper.z()));
  }
}

IdPairs found_in_range(System& system, const std::string& kernel) {
  IdPairs found;
  Sorted sorted(system, kernel);
  jiggle(system);
  sorted.forces.density(system.beads, sorted.wall, sorted.bodies, sorted.pairs);
  for (const NeighbourBlock& block : sorted.pairs.blocks())
    for_each_pair_in_range(block, [&](std::uint32_t i, std::uint32_t j) {
      EXPECT_TRUE(found.insert({system.beads.id[i], system.beads.id[j]}).second) << "found twice";
    });
  return found;
}

TEST(Pairs, InRangeAreFoundOnceAndNoOthersUntilABeadMovedHalfTheSkin) {
  for (const std::string& kernel : available_kernels())
    for (System& system : all_systems()) {
      SCOPED_TRACE(kernel + ", " + system.name);
      const IdPairs found = found_in_range(system, kernel);
      // Rounding decides about pairs within 1e-5 of the range.
      const double cutoff = system.parameters.liquid.range();
      const IdPairs must = all_within(system, cutoff - 1e-5), may = all_within(system, cutoff + 1e-5);
      for (const auto& pair : must) EXPECT_EQ(found.count(pair), 1u);
      for (const auto& pair : found) EXPECT_EQ(may.count(pair), 1u);
    }
}

TEST(Pairs, RunsHoldEveryWallBeadThatMayComeIntoRange) {
  for (System& system : all_systems()) {
    if (!system.parameters.domain.has_wall()) continue;
    SCOPED_TRACE(system.name);
    const Walls wall = wall_of(system);
    Pairs pairs(system.parameters);
    pairs.rebuild(system.beads, wall);
    const double reach = system.parameters.liquid.range() + 0.5 * system.parameters.list_skin;
    for (const NeighbourBlock& block : pairs.blocks())
      for (const NeighbourCell& cell : block.cells) {
        std::map<std::uint32_t, std::set<std::uint32_t>> images_of_wall_bead;
        for (std::uint32_t run = cell.first_wall_run; run < cell.end_wall_run; ++run)
          for (std::uint32_t w = block.wall_runs[run].begin; w < block.wall_runs[run].end; ++w)
            EXPECT_TRUE(images_of_wall_bead[w].insert(block.wall_runs[run].image).second) << "twice";
        for (std::uint32_t i = cell.begin; i < cell.end; ++i)
          for (std::uint32_t w = 0; w < wall.size(); ++w)
            if (apart(system.parameters.domain, system.beads.position[i], wall.beads()[w]).norm() < reach) {
              EXPECT_EQ(images_of_wall_bead.count(w), 1u);
            }
      }
  }
}

TEST(Pairs, AreStaleOnceABeadMovedHalfTheSkin) {
  Pairs pairs(periodic_box(8));
  EXPECT_TRUE(pairs.stale(0));
  System system = all_systems().front();
  pairs.rebuild(system.beads, wall_of(system));
  const float half_skin = 0.5f * static_cast<float>(system.parameters.list_skin);
  EXPECT_FALSE(pairs.stale(0.99f * half_skin * half_skin));
  EXPECT_TRUE(pairs.stale(1.01f * half_skin * half_skin));
  pairs.invalidate();
  EXPECT_TRUE(pairs.stale(0));
}

TEST(Pairs, CostMemoryForBeadsNotForTheChip) {
  System small{"small chip", plate(40, 12), {}}, large{"large chip", plate(400, 12), {}};
  for (System* system : {&small, &large})
    scatter_beads(*system, 6, {10, 10, 0}, {18, 18, 6}, [](const Vector3d&) { return true; });
  const auto bytes = [](System& system) {
    // Closed sides: the grid covers the beads.
    for (int axis = 0; axis < 2; ++axis)
      system.parameters.domain.lower_side[axis] = system.parameters.domain.upper_side[axis] =
          Side::reflecting;
    Pairs pairs(system.parameters);
    pairs.rebuild(system.beads, wall_of(system));
    return pairs.memory_bytes();
  };
  // The wall lattice fits each chip a little differently: a few wall neighbours more or less.
  EXPECT_NEAR(static_cast<double>(bytes(small)) / static_cast<double>(bytes(large)), 1.0, 0.02);
}

}  // namespace
}  // namespace dmf::engine
