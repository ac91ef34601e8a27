#include <gtest/gtest.h>

#include <algorithm>

#include "engine/observe/wetted_area.h"

namespace dmf::engine {
namespace {

/// A plate of 10.4 x 8 r_c, x periodic: 10 cells of 1.04 along x, 8 of 1 along y.
Parameters plate() {
  Parameters parameters;
  parameters.domain.lower = {-5.2, -4, 2};
  parameters.domain.upper = {5.2, 4, 12};
  parameters.domain.lower_side[0] = parameters.domain.upper_side[0] = Side::periodic;
  return parameters;
}

void add(Beads& beads, int count, float x, float y, float z) {
  for (int k = 0; k < count; ++k) beads.add({x, y, z, 0}, {}, static_cast<std::uint32_t>(beads.size()));
}

int wet_cells(const WettedArea& area) {
  return static_cast<int>(std::count(area.wet.begin(), area.wet.end(), true));
}

TEST(PlateCells, AreWholeAcrossTheDomain) {
  const PlateCells cells(plate().domain);
  EXPECT_EQ(cells.columns, 10);
  EXPECT_EQ(cells.rows, 8);
  EXPECT_DOUBLE_EQ(cells.length_x, 1.04);
  EXPECT_DOUBLE_EQ(cells.length_y, 1);
  EXPECT_EQ(cells.lower_x, -5.2);
}

TEST(WettedArea, ACellIsWetFromHalfOfTheBulksDensityOn) {
  // 6.06 * 1.04 * 1 / 2 = 3.15: three beads.
  Beads beads;
  add(beads, 2, 0.5f, 0.5f, 2.5f);
  EXPECT_EQ(wet_cells(wetted_area(beads, 2, plate())), 0);
  add(beads, 1, 0.5f, 0.5f, 2.99f);
  const WettedArea area = wetted_area(beads, 2, plate());
  EXPECT_EQ(wet_cells(area), 1);
  EXPECT_TRUE(area.at(5, 4));
  EXPECT_FALSE(area.at(4, 4));
  EXPECT_FALSE(area.at(0, 0)) << "beyond what it holds";
  EXPECT_EQ(area.columns * area.rows, 1) << "only where there are beads";
}

TEST(WettedArea, LiquidHigherThanOneRangeDoesNotWet) {
  Beads beads;
  add(beads, 50, 0.5f, 0.5f, 3.01f);
  EXPECT_EQ(wet_cells(wetted_area(beads, 2, plate())), 0);
  EXPECT_TRUE(wetted_area(Beads{}, 2, plate()).wet.empty());
}

TEST(WettedArea, BeadsBeyondAPeriodicSideCountOnTheOther) {
  Beads beads;
  add(beads, 2, 5.25f, -3.5f, 2.5f);
  add(beads, 2, -5.1f, -3.5f, 2.5f);
  const WettedArea area = wetted_area(beads, 2, plate());
  EXPECT_EQ(wet_cells(area), 1);
  EXPECT_TRUE(area.at(0, 0));
}

// The edge of a film from (0, -4) to (2, 4): the cells of which at least half is covered add up to its area.
TEST(WettedArea, OfAFilmWithASlantingEdgeIsItsArea) {
  Beads beads;
  Parameters parameters = plate();
  parameters.domain.lower_side[0] = parameters.domain.upper_side[0] = Side::reflecting;
  const double spacing = 0.1;
  parameters.liquid.bulk_density = 1 / (spacing * spacing * 0.5);
  for (double x = -5.15; x < 5.2; x += spacing)
    for (double y = -3.95; y < 4; y += spacing)
      for (const double z : {2.25, 2.75})
        if (x < 1 + y / 4) add(beads, 1, static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  const double exact = (5.2 + 1) * 8;
  EXPECT_NEAR(wet_cells(wetted_area(beads, 2, parameters)) * 1.04 / exact, 1, 0.03);
}

}  // namespace
}  // namespace dmf::engine
