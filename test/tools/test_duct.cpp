// Flow along a square channel of solid voxels.
#include <gtest/gtest.h>

#include <cmath>

#include "tools/duct.h"

namespace dmf::tools {
namespace {

TEST(DuctVelocity, SolvesStokesEquationWithoutSlip) {
  const double half_y = 3, half_z = 2, h = 0.02;
  for (const auto& [y, z] : {std::pair{0.0, 0.0}, {1.3, -0.7}, {-2.6, 1.7}, {0.4, 1.2}}) {
    const auto u = [&](double dy, double dz) { return duct_velocity(y + dy, z + dz, half_y, half_z); };
    const double laplacian = (u(h, 0) + u(-h, 0) + u(0, h) + u(0, -h) - 4 * u(0, 0)) / (h * h);
    EXPECT_NEAR(laplacian, -1, 1e-3) << y << " " << z;
  }
  for (const double at : {-1.5, 0.0, 0.9}) {
    EXPECT_NEAR(duct_velocity(half_y - 1e-9, at, half_y, half_z), 0, 1e-6);
    EXPECT_NEAR(duct_velocity(at, half_z - 1e-9, half_y, half_z), 0, 1e-3);
  }
}

TEST(DuctVelocity, HasTheTabulatedMeans) {
  // Shah and London (1978), f Re of the hydraulic diameter 4 A / P: 14.227 for a square, 15.548 for 2 : 1.
  const auto f_re = [](double half_y, double half_z) {
    const double diameter = 4 * half_y * half_z / (half_y + half_z);
    return diameter * diameter / (2 * mean_duct_velocity(half_y, half_z));
  };
  EXPECT_NEAR(f_re(1, 1), 14.227, 0.001);
  EXPECT_NEAR(f_re(2, 1), 15.548, 0.001);
  EXPECT_NEAR(f_re(1, 2), 15.548, 0.001);
  EXPECT_NEAR(duct_velocity(0, 0, 1, 1) / mean_duct_velocity(1, 1), 2.0962, 0.0005);
}

/// Chen's liquid in a smaller channel, driven harder.
chip::Scene driven_channel(double length, double half_width) {
  chip::Scene scene = chip::load_scene("square_channel");
  lay_duct(length, half_width, scene);
  scene.body_forces.gravity = {0.3, 0, 0};
  return scene;
}

// Friction with the walls' beads keeps the slip so low that this one does not tell how beads are sent back.
TEST(SquareChannel, FlowsAsTheSeriesSaysAndDoesNotSlip) {
  DuctRun run{driven_channel(8, 5)};
  run.settle = 30;
  run.measure = 25;
  const DuctResult result = run_duct(run);
  // Of the middle of a channel 10 wide, from beads of size 1: a tenth of a bead at the wall.
  EXPECT_NEAR(result.fitted_width, 5, 0.15);
  EXPECT_LT(result.deviation, 0.025);
  // dmf_study dpd_liquid, from waves of the liquid at rest: 2.66 +- 0.18.
  EXPECT_NEAR(result.viscosity, 2.66, 0.3);
  EXPECT_NEAR(result.temperature, 1, 0.03);
}

TEST(SquareChannel, IsHeldByBeadsThatBounceBackAloneWhereItsWallsDoNotRub) {
  DuctRun run{driven_channel(6, 4)};
  run.scene.parameters.mixture.pairs = {{"liquid", "wall", {9.68, 0, 0}}};
  run.settle = 20;
  run.measure = 20;
  const DuctResult result = run_duct(run);
  const double middle = result.velocity[result.velocity.size() / 2 + result.cells / 2],
               wall = result.velocity[result.cells / 2];
  // Bounced back, fluid moves in the cells half an r_c wide at a wall with 0.23 of its velocity in the
  // middle; sent back specularly it does with all of it.
  EXPECT_LT(wall, 0.35 * middle);
  EXPECT_LT(result.fitted_width, 4.35);
  EXPECT_LT(result.deviation, 0.05);
}

}  // namespace
}  // namespace dmf::tools
