#include "tools/pancake.h"

#include <gtest/gtest.h>

#include <cmath>

#include "yaml/units.h"

namespace dmf::tools {
namespace {

TEST(BridgePressure, IsThatOfACylinderAtNinetyDegrees) {
  EXPECT_NEAR(bridge_pressure(3, 90, 12), 1.0 / 12, 1e-9);
  EXPECT_NEAR(bridge_pressure(3, 90.01, 12), 1.0 / 12, 2e-4);
  EXPECT_NEAR(bridge_pressure(3, 89.99, 12), 1.0 / 12, 2e-4);
}

TEST(BridgePressure, OfAFlatPancakeIsParkAndHomsys) {
  // Non-wetting, much wider than high: 2 / h + (pi / 4) / R, Park and Homsy (1984), where R is the rim's
  // radius. The next term is of the order of h / R^2.
  const double height = 1, equator = 200;
  EXPECT_NEAR(bridge_pressure(height, 180, equator), 2 / height + M_PI / 4 / equator,
              2 * height / (equator * equator));
}

TEST(BridgePressure, OfABridgeThatIsASphericalZoneIsTheSpheres) {
  // Cut a sphere of radius 10 by planes at +-3: its angle there is 90 + asin(0.3) degrees.
  EXPECT_NEAR(bridge_pressure(6, 90 + std::asin(0.3) / degree, 10), 2.0 / 10, 1e-7);
}

TEST(Pancake, HasThePressureOfLaplace) {
  // Of a film at rest, by `dmf_study liquid`: a few tau of one leave 4 % of scatter in the tension.
  const double tension = 7.54, normal_pressure = -0.69;
  PancakeRun run;
  run.radius = 8;
  run.contact_angle = 130;
  run.settle = 15;
  run.measure = 25;
  const auto curve = engine::ContactAngleCurve({{-22, 35, 1}, {-12, 131.76, 0.21}, {-8, 155, 1}});
  const PancakeResult pancake = run_pancake(run, curve);
  const double expected =
      tension * bridge_pressure(run.gap - 2 * pancake.wall_distance, run.contact_angle, pancake.equator);
  // One r_c more or less between the plates would make a fifth.
  EXPECT_NEAR(pancake.pressure - normal_pressure, expected, 0.1 * expected);
  EXPECT_NEAR(pancake.equator, run.radius, 1.0);
  EXPECT_GT(pancake.wall_distance, 0);
  EXPECT_LT(pancake.wall_distance, 0.5);
}

}  // namespace
}  // namespace dmf::tools
