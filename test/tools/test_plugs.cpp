// Plugs of one liquid in another: the angle of their ends, and what Young's equation says of it.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/noise.h"
#include "tools/meniscus.h"
#include "tools/plug.h"
#include "tools/wall_tension.h"
#include "yaml/units.h"

namespace dmf::tools {
namespace {

/// s of an arc that meets walls at h = -half and half under an angle, 0 in the middle: by its circle.
double arc_place(double angle, double half, double h) {
  if (std::abs(angle - 90) < 1e-9) return 0;
  const double radius = half / -std::cos(angle * degree), side = radius > 0 ? 1 : -1;
  return side * std::sqrt(radius * radius - h * h) - radius;
}

TEST(MeniscusArc, IsExactOnArcsOfAnyAngleAndOnAStraightOne) {
  for (const double angle : {20.0, 60.0, 89.0, 90.0, 91.0, 135.0, 170.0}) {
    std::vector<MeniscusPoint> points;
    for (double h = 0.25; h < 5.5; h += 0.5) points.push_back({8 + arc_place(angle, 7, h), h});
    const auto arc = fit_arc(points);
    ASSERT_TRUE(arc);
    EXPECT_NEAR(arc->angle(7), angle, 1e-5);
    EXPECT_NEAR(arc->place, 8, 1e-6);
  }
  EXPECT_FALSE(fit_arc({{1, 0}, {1, 1}, {1, 2}, {1, 3}}));
}

TEST(MeniscusProfile, FindsTheAngleOfScatteredBeadsOfTwoLiquids) {
  for (const double angle : {50.0, 90.0, 125.0, 155.0}) {
    MeniscusProfile profile(15, 7);
    std::uint32_t draw = 0;
    const auto number = [&] { return engine::mix32(++draw * 2654435761u) / 4294967296.0; };
    for (int bead = 0; bead < 200'000; ++bead) {
      const double s = 15 * number(), h = 7 * (2 * number() - 1);
      // One in twenty is in the wrong liquid.
      profile.add(s, h, (s < 8 + arc_place(angle, 7, h)) != (number() < 0.05));
    }
    const auto arc = profile.arc();
    ASSERT_TRUE(arc);
    EXPECT_NEAR(arc->angle(7), angle, 2) << angle;
    EXPECT_NEAR(arc->place, 8, 0.1) << angle;
  }
}

TEST(Young, TakesEachTensionAtThePressureOfItsLiquid) {
  const WallTensionResult plug{12, 35, 0.25, 0, 1}, carrier{9, 34, 0.125, 0, 1};
  // Laplace's difference and Young's angle by turns until they agree.
  double cosine = 0;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.6 * 35 + 0.4 * 34, difference = -5 * cosine / 10;
    const double of_plug = 12 + 0.25 * (middle + 0.4 * difference - 35),
                 of_carrier = 9 + 0.125 * (middle - 0.6 * difference - 34);
    cosine = (of_carrier - of_plug) / 5;
  }
  EXPECT_NEAR(young_cosine(plug, carrier, 5, 10, 0.6), cosine, 1e-12);
  EXPECT_EQ(young_cosine(plug, plug, 5, 10, 0.5), 0);
}

TEST(WallTension, GrowsWithTheWallsRepulsionByTheMeanOfItsPotential) {
  // d tension = (mean potential over a) da + (liquid kept off) dp: Gibbs's adsorption equation, against the
  // stress. By Simpson's rule over three films.
  std::vector<WallTensionResult> films;
  for (const double repulsion : {10.0, 15.0, 20.0}) {
    WallTensionRun run;
    run.width = 4;
    run.gap = 8;
    run.time_step = 0.02;
    run.wall_repulsion = repulsion;
    run.reflection = engine::Reflection::bounce_back;
    run.settle = 10;
    run.measure = 100;
    films.push_back(run_wall_tension(run));
    EXPECT_NEAR(films.back().temperature, 1, 0.02);
  }
  const double by_stress = films[2].tension - films[0].tension;
  const double by_potential =
      10 * (films[0].slope + 4 * films[1].slope + films[2].slope) / 6 +
      0.5 * (films[0].lacking + films[1].lacking) * (films[1].pressure - films[0].pressure) +
      0.5 * (films[1].lacking + films[2].lacking) * (films[2].pressure - films[1].pressure);
  EXPECT_GT(by_stress, 4);
  // A film of 16 r_c^2 over 100 tau: 0.3 each.
  EXPECT_NEAR(by_stress, by_potential, 0.9);
}

PlugRun small_plug(double wall_repulsion, double carrier_wall_repulsion) {
  PlugRun run;
  run.time_step = 0.02;
  run.length = 20;
  run.half_gap = 5;
  run.width = 4;
  run.plug = 10;
  run.wall_repulsion = wall_repulsion;
  run.carrier_wall_repulsion = carrier_wall_repulsion;
  run.settle = 20;
  run.measure = 40;
  return run;
}

// The ends of such small plugs swing by +-0.2 in the cosine, about 13 times in 40 tau.
TEST(Plug, ShowsChensAngleAndItsSupplementWhenTheLiquidsChangePlaces) {
  const PlugResult hydrophobic = run_plug(small_plug(16, 10)), hydrophilic = run_plug(small_plug(10, 16));
  EXPECT_NEAR(hydrophobic.angle, 135, 13);
  EXPECT_NEAR(hydrophobic.angle + hydrophilic.angle, 180, 15);
  EXPECT_NEAR(hydrophobic.temperature, 1, 0.03);
  EXPECT_NEAR(hydrophobic.section, 1, 0.02);
}

TEST(Plug, AdvancesUnderALargerAngleThanItRecedes) {
  PlugRun run = small_plug(10, 10);
  run.acceleration = 0.1;
  const PlugResult driven = run_plug(run);
  EXPECT_GT(driven.velocity, 0.1);
  EXPECT_GT(driven.advancing, 100);
  EXPECT_LT(driven.receding, 80);
}

}  // namespace
}  // namespace dmf::tools
