// Membranes of the liquid and of a species of their own.
#include <gtest/gtest.h>

#include "tools/membrane_run.h"

namespace dmf::tools {
namespace {

MembraneRun small_sphere() {
  MembraneRun run;
  run.radius = 2.5;
  run.subdivisions = 2;  // edges of 0.75 r_c
  run.margin = 1.8;
  run.settle = 5;
  run.measure = 15;
  return run;
}

TEST(MembraneRun, LiquidChangesSidesThroughAMembraneOfItsOwnBeadsAndNotThroughOneThatRepelsIt) {
  MembraneRun run = small_sphere();
  const MembraneResult of_liquid = run_membrane(run);
  EXPECT_GT(of_liquid.crossed, 0.15);
  run.own_repulsion = 25;
  run.liquid_on_membrane = 60;
  const MembraneResult tight = run_membrane(run);
  EXPECT_EQ(tight.crossed, 0);
  EXPECT_GT(tight.inside_before, 100);
  EXPECT_LT(tight.largest_area_error, 0.04);
  EXPECT_LT(tight.largest_volume_error, 0.04);
  EXPECT_NEAR(tight.temperature, 1, 0.03);
}

}  // namespace
}  // namespace dmf::tools
