#include <gtest/gtest.h>

#include <cmath>

#include "droplet_on_wall.h"

namespace dmf::engine {
namespace {

TEST(Run, DiffersBetweenSeeds) {
  Simulation one = droplet_on_wall(1, "auto", 1), two = droplet_on_wall(1, "auto", 2);
  start_droplet(one);
  start_droplet(two);
  EXPECT_NE(hash_after(one, 10), hash_after(two, 10));
}

TEST(Run, GoesOnWithTheSameBitsAfterBeingSavedAndLoaded) {
  Simulation whole = droplet_on_wall(2), first = droplet_on_wall(1), second = droplet_on_wall(2);
  start_droplet(whole);
  start_droplet(first);
  hash_after(first, 137);  // between two list builds and two looks of the tracker
  second.load_state(first.save_state());
  EXPECT_EQ(*second.observe({false, true})->state_hash, *first.observe({false, true})->state_hash);
  EXPECT_EQ(second.observe()->droplets.size(), first.observe()->droplets.size());
  const std::uint64_t expected = hash_after(whole, 500);
  EXPECT_EQ(hash_after(second, 363), expected);
  const auto a = whole.observe(), b = second.observe();
  ASSERT_EQ(a->droplets.size(), b->droplets.size());
  EXPECT_EQ(a->droplets[0].advancing_angle, b->droplets[0].advancing_angle);
  EXPECT_EQ(a->droplets[0].velocity, b->droplets[0].velocity);
}

TEST(Run, RefusesABrokenSavedStateAndStaysAsItWas) {
  Simulation simulation = droplet_on_wall(1);
  start_droplet(simulation);
  const std::uint64_t before = hash_after(simulation, 30);
  const std::string saved = simulation.save_state();
  EXPECT_THROW(simulation.load_state(saved.substr(0, saved.size() / 2)), InvalidInput);
  EXPECT_THROW(simulation.load_state(saved + "x"), InvalidInput);
  EXPECT_THROW(simulation.load_state(""), InvalidInput);
  EXPECT_EQ(*simulation.observe({false, true})->state_hash, before);
}

TEST(Run, RefusesAStateSortedIntoOtherCells) {
  Parameters parameters = plate(16, 14);
  Simulation saved(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  start_droplet(saved);
  parameters.list_skin = 0.4;
  Simulation other(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  start_droplet(other);
  const std::uint64_t before = hash_after(other, 0);
  EXPECT_THROW(other.load_state(saved.save_state()), InvalidInput);
  EXPECT_EQ(hash_after(other, 0), before);
}

TEST(Run, ScalarReferenceAndLanesAgreeUntilChaosParts) {
  // Rounding differs; a dozen steps amplify it little.
  Simulation lanes = droplet_on_wall(1, "auto"), reference = droplet_on_wall(1, "reference");
  start_droplet(lanes);
  start_droplet(reference);
  for (int k = 0; k < 12; ++k) {
    lanes.step();
    reference.step();
  }
  const auto a = lanes.observe({true, false}), b = reference.observe({true, false});
  ASSERT_EQ(a->positions.size(), b->positions.size());
  double largest = 0;
  for (std::size_t k = 0; k < a->positions.size(); ++k)
    largest = std::max(largest, double((a->positions[k] - b->positions[k]).norm()));
  EXPECT_LT(largest, 1e-4);
}

TEST(FreeDroplet, KeepsItsMomentum) {
  Parameters parameters = periodic_box(14);
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  const std::size_t beads = simulation.add_droplet({{7, 7, 7}, 4});
  for (int k = 0; k < 2000; ++k) simulation.step();
  // Rounding of N sums a step: a random walk of sqrt(steps N) times 2^-24 of a force of some hundred times
  // dt.
  EXPECT_LT(simulation.observe()->momentum.norm(), std::sqrt(2000.0 * beads) * 6e-8 * 300 * 0.01 * 10);
}

TEST(Bulk, HoldsItsTemperature) {
  Parameters parameters = periodic_box(8);
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {2, "auto"});
  simulation.fill_box();
  for (int k = 0; k < 1000; ++k) simulation.step();
  double sum = 0;
  for (int k = 0; k < 3000; ++k) {
    simulation.step();
    sum += simulation.observe()->temperature;
  }
  // 3,072 beads: one look deviates by sqrt(2 / 3N) = 1.5 %, correlated over about 10 steps: 0.1 % for the
  // mean. The integrator's own error at this step is below 1 % (docs/physics.md).
  EXPECT_NEAR(sum / 3000, 1.0, 0.01);
}

TEST(Droplet, RoundsUpAndSpreadsOnAWettingWall) {
  Simulation simulation = droplet_on_wall(2);
  simulation.set_wettability([](double, double) { return 60.0; });
  simulation.add_droplet({{8, 8, 3.5}, 3.5});
  for (int k = 0; k < 4000; ++k) simulation.step();
  const auto wetting = simulation.observe();
  Simulation other = droplet_on_wall(2);
  other.set_wettability([](double, double) { return 140.0; });
  other.add_droplet({{8, 8, 3.5}, 3.5});
  for (int k = 0; k < 4000; ++k) other.step();
  const auto repelling = other.observe();
  ASSERT_EQ(wetting->droplets.size(), 1u);
  ASSERT_EQ(repelling->droplets.size(), 1u);
  EXPECT_GT(wetting->droplets[0].footprint_area, 2 * repelling->droplets[0].footprint_area);
  EXPECT_LT(wetting->droplets[0].height, repelling->droplets[0].height);
  ASSERT_TRUE(wetting->droplets[0].contact_angle && repelling->droplets[0].contact_angle);
  EXPECT_LT(*wetting->droplets[0].contact_angle, *repelling->droplets[0].contact_angle - 30);
}

TEST(Wettability, OutsideTheCurveIsRefusedAndNothingChanges) {
  Simulation simulation = droplet_on_wall(1);
  start_droplet(simulation);
  const std::uint64_t before = *simulation.observe({false, true})->state_hash;
  EXPECT_THROW(simulation.set_wettability([](double x, double) { return x < 8 ? 90.0 : 200.0; }),
               InvalidInput);
  EXPECT_THROW(simulation.set_wettability([](double, double) { return std::nan(""); }), InvalidInput);
  EXPECT_EQ(*simulation.observe({false, true})->state_hash, before);
}

TEST(Placement, OnOccupiedPlaceOutsideOrTooManyBeadsIsRefusedAndNothingChanges) {
  Parameters parameters = plate(16, 14);
  parameters.max_beads = 1500;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_droplet({{5, 5, 3}, 3});
  const std::uint64_t before = *simulation.observe({false, true})->state_hash;
  for (const DropletPlacement& bad : {DropletPlacement{{6, 5, 3}, 2}, DropletPlacement{{5, 5, 12.5}, 2},
                                      DropletPlacement{{5, 5, 3}, std::nan("")},
                                      DropletPlacement{{11, 11, 4}, 4}, DropletPlacement{{12, 12, 5}, 0.3},
                                      DropletPlacement{{12, 12, 5}, -2}, DropletPlacement{{21, 5, 3}, 9}})
    EXPECT_THROW(simulation.add_droplet(bad), InvalidInput) << bad.center.transpose() << " " << bad.radius;
  EXPECT_EQ(*simulation.observe({false, true})->state_hash, before);
}

TEST(Instability, StopsTheRunAndSaysWhereToLook) {
  Parameters parameters = periodic_box(8);
  parameters.time_step = 0.1;
  parameters.liquid.random_amplitude = 50;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill_box();
  std::string said;
  try {
    for (int k = 0; k < 1000; ++k) simulation.step();
  } catch (const Instability& instability) {
    said = instability.what();
  }
  EXPECT_NE(said.find("time_step"), std::string::npos) << said;
  EXPECT_NE(said.find("step "), std::string::npos);
  EXPECT_THROW(simulation.step(), Instability);
}

TEST(Snapshot, StaysWhatItWasWhileTheRunGoesOn) {
  Simulation simulation = droplet_on_wall(1);
  start_droplet(simulation);
  const auto before = simulation.observe({true, false});
  const Eigen::Vector3f first = before->positions.front();
  for (int k = 0; k < 20; ++k) simulation.step();
  EXPECT_EQ(before->positions.front(), first);
  EXPECT_EQ(before->step, 0u);
  EXPECT_EQ(simulation.observe()->step, 20u);
}

}  // namespace
}  // namespace dmf::engine
