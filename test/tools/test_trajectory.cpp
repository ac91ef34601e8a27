#include <gtest/gtest.h>

#include <cmath>

#include "tools/trajectory.h"

namespace dmf::tools {
namespace {

/// A look at microparticle 1 that droplet 1, the largest, carries.
TransportRecord carried(double time, double x) {
  TransportRecord record;
  record.microparticle = 1;
  record.time = time;
  record.x = x;
  record.z = -9;
  record.height = 0.9975;
  record.contact_fraction = 0.6;
  record.carrier = record.droplet = 1;
  record.droplet_x = x + 3;
  return record;
}

/// Picked up at t = 100; x = -30 + 2e-6 (t - 100)^2 until it is lost at t = 4100, x = 2; then it rests while
/// the droplet goes on.
std::vector<TransportRecord> lost_on_its_way() {
  std::vector<TransportRecord> records;
  for (double t = 5; t <= 5000; t += 5) {
    const double way = std::max(0.0, std::min(t, 4100.0) - 100);
    records.push_back(carried(t, -30 + 2e-6 * way * way));
    if (t == 100) records.back().picked_up = 1;
    if (t < 100) records.back().carrier = 0;
    if (t == 4100) records.back().dropped_off = 1;
    if (t >= 4100) records.back().carrier = 2;  // a satellite stays with it
    if (t > 4100) records.back().droplet_x = 20;
  }
  return records;
}

TEST(Trajectory, TellsPickupPassageAndDropOff) {
  const Trajectory way(lost_on_its_way(), 1);
  EXPECT_EQ(way.time_picked_up(), 100);
  EXPECT_NEAR(way.time_at(-10), 100 + std::sqrt(20 / 2e-6), 0.01);
  EXPECT_TRUE(std::isnan(way.time_at(10)));
  EXPECT_NEAR(way.droplet_time_at(-7), way.time_at(-10), 1e-9);  // 3 ahead of it
  EXPECT_EQ(way.time_dropped_off(), 4100);
  EXPECT_NEAR(way.x_dropped_off(), 2, 1e-9);
  EXPECT_FALSE(way.carried_at_end());
  EXPECT_NEAR(way.final_x(), 2, 1e-9);
  EXPECT_NEAR(way.final_droplet_x(), 20, 1e-9);
  EXPECT_NEAR(way.mean_height(), 0.9975, 1e-9);
}

TEST(Trajectory, CriticalVelocityIsTheParabolasSlopeBeforeTheDropOff) {
  // Half an r_c before the place of drop-off, at x = 1.5: t - 100 = sqrt(31.5 / 2e-6).
  const double time = std::sqrt(31.5 / 2e-6);
  EXPECT_NEAR(Trajectory(lost_on_its_way(), 1).critical_velocity(), 2 * 2e-6 * time, 2e-5);
  // The mean over 8 r_c: t - 100 is sqrt(23.5 / 2e-6) where they begin.
  EXPECT_NEAR(Trajectory(lost_on_its_way(), 1).velocity_before_drop_off(),
              8 / (time - std::sqrt(23.5 / 2e-6)), 2e-5);
}

TEST(Trajectory, DriveBeforeTheDropOffIsOfTheSameWay) {
  auto records = lost_on_its_way();
  for (auto& record : records) record.drive_x = record.x < -6.5 || record.x > 1.5 ? 1000 : 40;
  EXPECT_NEAR(Trajectory(records, 1).drive_before_drop_off(), 40, 1e-9);
}

TEST(Trajectory, HeldWithTheMeanForceBeforeTheDropletLetsGo) {
  auto records = lost_on_its_way();  // from t = 100 to 4100
  for (auto& record : records) record.drive_x = record.time > 3100 && record.time <= 3600 ? 50 : 10;
  EXPECT_NEAR(Trajectory(records, 1).held_with(), 50, 1e-9);
  for (auto& record : records) record.picked_up = record.time == 3105;
  EXPECT_TRUE(std::isnan(Trajectory(records, 1).held_with())) << "it has not been held for so long";
}

TEST(Trajectory, TakenUpAgainIsNotDroppedOff) {
  auto records = lost_on_its_way();
  records.back().carrier = 1;  // its satellite has merged into the droplet
  const Trajectory way(records, 1);
  EXPECT_TRUE(std::isnan(way.time_dropped_off()));
  EXPECT_TRUE(std::isnan(way.critical_velocity()));
  EXPECT_TRUE(std::isnan(way.velocity_before_drop_off()));
  EXPECT_TRUE(std::isnan(way.drive_before_drop_off()));
  EXPECT_TRUE(std::isnan(way.held_with()));
  EXPECT_TRUE(way.carried_at_end());
}

TEST(Trajectory, FastestWhereConcaveTurnsConvex) {
  std::vector<TransportRecord> records;
  for (double t = 5; t <= 6000; t += 5) records.push_back(carried(t, 35 * std::tanh((t - 2800) / 1200)));
  EXPECT_NEAR(Trajectory(records, 1).time_fastest(), 2800, 10);
}

TEST(Trajectory, LiftedWhenItStandsHigherThanOnTheWall) {
  auto records = lost_on_its_way();
  EXPECT_TRUE(std::isnan(Trajectory(records, 1).time_lifted()));
  for (auto& record : records)
    if (record.time >= 1153) record.z = -8;
  EXPECT_EQ(Trajectory(records, 1).time_lifted(), 1155);
}

TEST(Trajectory, OfADropletAloneIsItsCentroids) {
  auto records = lost_on_its_way();
  for (auto& record : records) record.microparticle = 0;
  EXPECT_NEAR(Trajectory(records, 0).final_x(), 20, 1e-9);
}

}  // namespace
}  // namespace dmf::tools
