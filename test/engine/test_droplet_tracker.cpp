#include <gtest/gtest.h>

#include "engine/simulation.h"
#include "systems.h"

namespace dmf::engine {
namespace {

Parameters small_plate() { return plate(30, 12); }

TEST(DropletTracker, CountsDropletsAndReportsWhereTheyAre) {
  Simulation simulation(small_plate(), ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_droplet({{7, 15, 3}, 3});
  simulation.add_droplet({{20, 15, 3}, 2.5});
  const auto snapshot = simulation.observe({true, false});
  ASSERT_EQ(snapshot->droplets.size(), 2u);
  EXPECT_EQ(snapshot->droplets[0].id, 1u);
  EXPECT_EQ(snapshot->droplets[1].id, 2u);
  EXPECT_NEAR(snapshot->droplets[0].centroid.x(), 7, 0.2);
  EXPECT_NEAR(snapshot->droplets[1].centroid.x(), 20, 0.2);
  EXPECT_NEAR(snapshot->droplets[0].volume, 4.0 / 3 * 3.1416 * 27 * 6 / 6.05, 10);
  EXPECT_EQ(snapshot->droplets[0].beads + snapshot->droplets[1].beads + snapshot->vapour_beads,
            snapshot->moving_beads);
  for (std::size_t k = 0; k < snapshot->positions.size(); ++k)
    EXPECT_EQ(snapshot->bead_droplets[k], snapshot->positions[k].x() < 13 ? 1u : 2u);
}

TEST(DropletTracker, KeepsTheIdOfTheLargerDropletInAMergeAndNamesTheOther) {
  Simulation simulation(small_plate(), ContactAngleCurve::lan2016(), {2, "auto"});
  simulation.set_wettability([](double, double) { return 60.0; });  // they spread into each other
  simulation.add_droplet({{11, 15, 2.5}, 2.5});
  simulation.add_droplet({{17.7, 15, 3}, 3});
  for (int k = 0; k < 6000 && simulation.observe()->droplets.size() > 1; ++k) simulation.step();
  const auto snapshot = simulation.observe();
  ASSERT_EQ(snapshot->droplets.size(), 1u) << "they did not merge within 60 tau";
  EXPECT_EQ(snapshot->droplets[0].id, 2u);
  EXPECT_EQ(snapshot->droplets[0].parents, std::vector<std::uint32_t>{1});
  std::vector<DropletEvent> merges;
  for (const DropletEvent& event : simulation.take_events())
    if (event.kind == DropletEvent::Kind::merged) merges.push_back(event);
  ASSERT_EQ(merges.size(), 1u);
  EXPECT_EQ(merges[0].from, (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(merges[0].to, std::vector<std::uint32_t>{2});
  EXPECT_TRUE(simulation.take_events().empty());
}

TEST(DropletTracker, GivesTheSmallerHalfOfASplitANewIdWithItsParent) {
  // A liquid ridge over a water-repelling stripe between two wetting fields: it tears.
  Simulation simulation(small_plate(), ContactAngleCurve::lan2016(), {2, "auto"});
  simulation.set_wettability([](double x, double) { return x < 11 || x > 17 ? 42.0 : 150.0; });
  simulation.fill_slab({6, 13, 0.5}, {23, 17, 2.5});
  ASSERT_EQ(simulation.observe()->droplets.size(), 1u);
  for (int k = 0; k < 6000 && simulation.observe()->droplets.size() < 2; ++k) simulation.step();
  const auto snapshot = simulation.observe();
  ASSERT_EQ(snapshot->droplets.size(), 2u) << "it did not tear within 60 tau";
  EXPECT_EQ(snapshot->droplets[0].id, 1u);
  EXPECT_TRUE(snapshot->droplets[0].parents.empty());
  EXPECT_EQ(snapshot->droplets[1].id, 2u);
  EXPECT_EQ(snapshot->droplets[1].parents, std::vector<std::uint32_t>{1});
  EXPECT_GE(snapshot->droplets[0].beads, snapshot->droplets[1].beads);
  bool split_reported = false;
  for (const DropletEvent& event : simulation.take_events())
    split_reported |= event.kind == DropletEvent::Kind::split;
  EXPECT_TRUE(split_reported);
}

TEST(DropletTracker, SeesOneDropletAcrossAPeriodicEdge) {
  Simulation simulation(small_plate(), ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_droplet({{0.5, 15, 3}, 3});
  const auto snapshot = simulation.observe();
  ASSERT_EQ(snapshot->droplets.size(), 1u);
  const double x = snapshot->droplets[0].centroid.x();
  EXPECT_LT(std::min(std::abs(x - 0.5), std::abs(x - 30.5)), 0.2);
  EXPECT_LT(snapshot->droplets[0].upper.x() - snapshot->droplets[0].lower.x(), 6.1);
}

TEST(DropletTracker, ForgetsARemovedDropletAndNeverReusesItsId) {
  Simulation simulation(small_plate(), ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_droplet({{7, 15, 3}, 3});
  simulation.take_events();
  simulation.remove_droplet(1);
  EXPECT_TRUE(simulation.observe()->droplets.empty());
  EXPECT_EQ(simulation.observe()->moving_beads, 0u);
  const auto events = simulation.take_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, DropletEvent::Kind::vanished);
  EXPECT_THROW(simulation.remove_droplet(1), InvalidInput);
  simulation.add_droplet({{7, 15, 3}, 3});
  EXPECT_EQ(simulation.observe()->droplets.at(0).id, 2u);
  for (int k = 0; k < 40; ++k) simulation.step();
}

}  // namespace
}  // namespace dmf::engine
