// Chains in a channel that narrows.
#include <gtest/gtest.h>

#include <cmath>

#include "tools/sloping_channel.h"

namespace dmf::tools {
namespace {

chip::Scene small_channel() {
  return chip::parse_scene(
      "liquid: {attraction: 25, repulsion: 0, random_amplitude: 3, initial_density: 3, bulk_density: 3}\n"
      "domain: {lower: [-10, -2, -5], upper: [10, 2, 5], sides: {x: periodic, y: periodic, z: closed}}\n"
      "label_grid:\n"
      "  attraction: 25\n"
      "  density: 3\n"
      "  voxel_size: [0.5, 0.5, 0.5]\n"
      "  shapes:\n"
      "    - {box: {lower: [-10, -2, -5], upper: [10, 2, -4]}}\n"
      "    - {box: {lower: [-10, -2, 4], upper: [10, 2, 5]}}\n"
      "fills: [{}]\n"
      "chains: [{spring: {kind: wlc, max_length: 1.2, persistence_length: 0.06}, count: 20, beads: 12,\n"
      "  bond_length: 0.5}]\n"
      "body_forces: {gravity: [0.15, 0, 0]}\n"
      "watchdog: {evaporation: 1, temperature: [0.5, 100]}\n",
      "slopes.yaml");
}

SlopingChannelRun small_run() {
  SlopingChannelRun run{small_channel()};
  lay_slopes({4, 2, 5, 4}, run.scene);
  run.settle = 20;
  run.measure = 40;
  return run;
}

TEST(SlopingChannel, HasTheHeightsOfItsSlopes) {
  SlopingChannelRun run = small_run();
  run.settle = run.measure = 0;
  const SlopingChannelResult result = run_sloping_channel(run);
  ASSERT_EQ(result.sections.size(), 40u);
  for (const ChannelSection& section : result.sections) {
    const double from_middle = std::abs(section.x);
    const double wall = from_middle < 3 ? 2 : from_middle > 7 ? 4 : 2 + (from_middle - 3) / 2;
    EXPECT_NEAR(section.height, 2 * wall, 0.5) << "at " << section.x;  // a voxel
    EXPECT_EQ(section.reach == Reach::narrow, section.height == 4) << "at " << section.x;
    EXPECT_EQ(section.reach == Reach::wide, section.height == 8) << "at " << section.x;
  }
  EXPECT_EQ(result.sections[8].reach, Reach::narrowing);  // x = -5.75
  EXPECT_EQ(result.sections[31].reach, Reach::widening);
  EXPECT_NEAR((Slopes{4, 2, 5, 4}).angle(), 26.57, 0.01);
}

TEST(SlopingChannel, CarriesAsMuchEverywhereAndStretchesChainsWhereItIsNarrow) {
  const SlopingChannelResult result = run_sloping_channel(small_run());
  const ReachMeans narrow = result.over(Reach::narrow), wide = result.over(Reach::wide);
  // What flows through a section is rho u h. It is faster where it is narrow than the heights' 2 say: half an
  // r_c at each wall is all but empty there as elsewhere, hence (8 - 1) / (4 - 1) about.
  EXPECT_NEAR(narrow.velocity / wide.velocity, 7.0 / 3, 0.3);
  EXPECT_NEAR(narrow.velocity * narrow.density * narrow.height, wide.velocity * wide.density * wide.height,
              0.05 * wide.velocity * wide.density * wide.height);
  // A coil at rest has a third of R^2 along x.
  EXPECT_GT(narrow.stretch_square, 0.5 * narrow.end_to_end_square);
  EXPECT_GT(narrow.stretch_square, 1.3 * wide.stretch_square);
  EXPECT_LT(result.longest, 1);
}

}  // namespace
}  // namespace dmf::tools
