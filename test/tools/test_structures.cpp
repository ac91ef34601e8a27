// Liquid on ridges and in front of pores.
#include <gtest/gtest.h>

#include <cmath>

#include "tools/infiltration.h"
#include "tools/structured_wall.h"

namespace dmf::tools {
namespace {

TEST(CassieBaxter, LiesBetweenTheSmoothAngleAndNoContact) {
  EXPECT_NEAR(cassie_baxter_angle(1, 120), 120, 1e-9);
  EXPECT_NEAR(cassie_baxter_angle(0, 120), 180, 1e-6);
  // Half of the plane at 120 degrees: cos = 1/2 (1 - 1/2) - 1 = -3/4.
  EXPECT_NEAR(cassie_baxter_angle(0.5, 120), 138.59, 0.01);
}

StructuredWallRun small_droplet(double spacing) {
  StructuredWallRun run;
  run.attraction = -12;  // 132 degrees on the smooth wall
  run.ridge = 2;
  run.spacing = spacing;
  run.length = 30;
  run.area = 64;
  run.settle = 40;
  run.rest = 40;
  return run;
}

TEST(StructuredWall, RidgesMakeAHydrophobicWallMoreHydrophobic) {
  const StructuredWallResult smooth = run_structured_wall(small_droplet(0));
  const StructuredWallResult ridges = run_structured_wall(small_droplet(3));
  // A droplet of 4.5 r_c shows more than one of 10 on the same wall, as far as the liquid keeps off it: what
  // it shows there is what Cassie and Baxter's law begins with.
  EXPECT_GT(smooth.angle, 132);
  EXPECT_GT(ridges.angle, smooth.angle + 5);
  EXPECT_NEAR(ridges.angle, cassie_baxter_angle(2.0 / 5, smooth.angle), 4);
  EXPECT_LT(ridges.sunk, 0.5);  // it hangs over the grooves
}

TEST(StructuredWall, TheBottomOfTheGroovesDrawsInLiquidThatHangsOverBareOnes) {
  StructuredWallRun run = small_droplet(3);
  run.settle = run.rest = 15;
  const double over_beads = run_structured_wall(run).sunk;
  run.bottom = GrooveBottom::bare;
  const double over_nothing = run_structured_wall(run).sunk;
  EXPECT_LT(over_nothing, 0.1);
  EXPECT_GT(over_beads, over_nothing + 0.1);
}

InfiltrationRun small_slit(double angle) {
  InfiltrationRun run;
  run.space = PoreSpace::slit;
  run.contact_angle = angle;
  run.depth = 12;
  run.width = 8;
  run.slug = 7;
  run.time = 60;
  return run;
}

TEST(Infiltration, ALiquidThatWetsImbibesAndOneThatDoesNotStaysOut) {
  const engine::ContactAngleCurve curve = engine::ContactAngleCurve::lan2016();
  EXPECT_GT(run_infiltration(small_slit(50), curve), 0.25);
  EXPECT_LT(run_infiltration(small_slit(130), curve), 0.05);
}

TEST(Infiltration, APressureAboveTheEntryPressureDrivesALiquidInThatDoesNotWet) {
  const engine::ContactAngleCurve curve = engine::ContactAngleCurve::lan2016();
  InfiltrationRun run = small_slit(130);
  run.time = 40;
  const double entry = entry_pressure(7.54, 130, run.gap);  // 2.4
  EXPECT_NEAR(entry, 2.42, 0.01);
  const double weight = 6.06 * run.slug;
  run.acceleration = 0.5 * entry / weight;
  EXPECT_LT(run_infiltration(run, curve), 0.1);
  run.acceleration = 3 * entry / weight;
  EXPECT_GT(run_infiltration(run, curve), 0.3);
}

TEST(Washburn, GoesWithTheRootOfTime) {
  EXPECT_NEAR(washburn_depth(7.54, 8.2, 60, 4, 100), std::sqrt(7.54 * 4 * 0.5 * 100 / (3 * 8.2)), 1e-9);
  EXPECT_EQ(washburn_depth(7.54, 8.2, 120, 4, 100), 0);
}

}  // namespace
}  // namespace dmf::tools
