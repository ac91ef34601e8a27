#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>
#include <random>

#include "chip/layout.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

Electrode polygon(std::uint32_t channel, std::vector<Vector2d> outline) {
  Electrode electrode;
  electrode.channel = channel;
  electrode.outline = std::move(outline);
  return electrode;
}

Electrode square(std::uint32_t channel, double x, double y, double half = 5) {
  return polygon(channel,
                 {{x - half, y - half}, {x + half, y - half}, {x + half, y + half}, {x - half, y + half}});
}

Layout line(std::uint32_t columns) { return Layout(electrodes_of({{0, 0}, columns, 1, 12, 0, {}}, 2), 2); }

/// Weights by channel at a point; the bare plate's under -1.
std::map<int, double> weights(const Layout& layout, const Vector2d& point) {
  std::map<int, double> found;
  const double bare = layout.weights(point, [&](std::size_t index, double weight) {
    found[static_cast<int>(layout.electrodes()[index].channel)] = weight;
  });
  if (bare > 0) found[-1] = bare;
  return found;
}

using Weights = std::map<int, double>;

TEST(Wettability, RampsLinearlyAcrossTheGapBetweenParallelEdges) {
  const Layout layout = line(2);  // edges at x = 5 and x = 7
  EXPECT_EQ(weights(layout, {0, 0}), (Weights{{0, 1}}));
  EXPECT_EQ(weights(layout, {5, 0}), (Weights{{0, 1}}));
  EXPECT_EQ(weights(layout, {7, 3}), (Weights{{1, 1}}));
  for (double x = 5.1; x < 7; x += 0.1) {
    const Weights found = weights(layout, {x, 1});
    EXPECT_NEAR(found.at(0), (7 - x) / 2, 1e-12) << x;
    EXPECT_NEAR(found.at(1), (x - 5) / 2, 1e-12) << x;
    EXPECT_EQ(found.count(-1), 0u) << x;
  }
}

TEST(Wettability, FadesToTheBarePlateWithinAGap) {
  const Layout layout = line(1);
  EXPECT_EQ(weights(layout, {-6, 0}), (Weights{{0, 0.5}, {-1, 0.5}}));
  EXPECT_EQ(weights(layout, {-7, 0}), (Weights{{-1, 1}}));
  EXPECT_EQ(weights(layout, {1000, 0}), (Weights{{-1, 1}}));
}

TEST(Wettability, IsTheBarePlatesInTheMiddleOfAHole) {
  const Layout layout(electrodes_of({{0, 0}, 3, 3, 12, 0, {{1, 1}}}, 2), 2);
  EXPECT_EQ(weights(layout, {12, 12}), (Weights{{-1, 1}}));
  EXPECT_EQ(weights(layout, {12, 0}), (Weights{{1, 1}}));
}

TEST(Wettability, IsContinuousAndComplete) {
  Electrode triangle = polygon(7, {{14, 7}, {30, 7}, {22, 20}});
  auto electrodes = electrodes_of({{0, 0}, 3, 2, 12, 0, {{2, 1}}}, 2);
  electrodes.push_back(polygon(9, {{-12, -4}, {-6, 0}, {-12, 4}, {-9, 0}}));  // not convex
  electrodes.push_back(triangle);
  // The triangle stands in the grid's hole but reaches to within less than a gap of its neighbours.
  electrodes.back().outline = {{20, 8}, {28, 8}, {24, 16}};
  const Layout layout(electrodes, 2);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(-15, 35), y(-10, 25), angle(0, 6.283);
  constexpr double kStep = 1e-4;
  for (int sample = 0; sample < 20000; ++sample) {
    const Vector2d point(x(random), y(random));
    const double direction = angle(random);
    const Weights here = weights(layout, point);
    const Weights there = weights(layout, point + kStep * Vector2d(std::cos(direction), std::sin(direction)));
    double sum = 0;
    for (const auto& [channel, weight] : here) {
      sum += weight;
      const double other = there.count(channel) ? there.at(channel) : 0;
      // A weight over the sum: its slope is at most 1/gap times one more than how many electrodes are near.
      EXPECT_LT(std::abs(weight - other), 5 * kStep / layout.gap())
          << point.transpose() << " channel " << channel;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(Wettability, OfAWholeChipIsEvaluatedInUnder50Milliseconds) {
#if !defined(NDEBUG) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "times only what is built as it is used";
#endif
  const Layout layout(electrodes_of({{-54, -24}, 10, 4, 12, 0, {}}, 2), 2);
  const auto start = std::chrono::steady_clock::now();
  double sum = 0;
  std::size_t points = 0;
  for (double x = -75; x < 75; x += 0.437) {
    for (double y = -35; y < 35; y += 0.235) {  // as many points as three wall layers have beads
      sum += layout.weights({x, y}, [](std::size_t, double) {});
      ++points;
    }
  }
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  RecordProperty("milliseconds", std::to_string(took.count()));
  std::printf("%zu points in %.1f ms\n", points, took.count());
  EXPECT_GT(points, 100000u);
  EXPECT_LT(took.count(), 50);
  EXPECT_GT(sum, 0);
}

TEST(Grid, ChannelFollowsFromColumnAndRow) {
  const Layout layout(electrodes_of({{10, 20}, 3, 2, 12, 4, {{1, 1}}}, 2), 2);
  EXPECT_EQ(layout.channels_text(), "4-7, 9");
  EXPECT_TRUE(layout.electrodes()[layout.index_of(9)].centroid.isApprox(Vector2d(34, 32)));
  EXPECT_DOUBLE_EQ(layout.electrodes()[0].outline[0].x(), 5) << "pitch - gap wide";
}

TEST(Grid, NeighboursAreAcrossAnEdgeNotACorner) {
  const Layout layout(electrodes_of({{0.1, 0.2}, 3, 3, 12.3, 0, {}}, 2.7), 2.7);
  EXPECT_EQ(layout.electrodes()[4].neighbours, (std::vector<std::uint32_t>{1, 3, 5, 7}));
  EXPECT_EQ(layout.electrodes()[0].neighbours, (std::vector<std::uint32_t>{1, 3}));
}

TEST(Grid, WhatDoesNotFitIsRefused) {
  EXPECT_TRUE(holds(refusal([] {
                      electrodes_of({{0, 0}, 2, 2, 2, 0, {}}, 2);
                    }),
                    "pitch: 2 r_c, allowed: more than"));
  const std::string text = refusal([] { electrodes_of({{0, 0}, 2, 2, 12, 0, {{2, 0}, {1, 1}, {1, 1}}}, 2); });
  EXPECT_TRUE(holds(text, "holes: [2, 0], allowed: columns 0 to 1, rows 0 to 1"));
  EXPECT_TRUE(holds(text, "holes: [1, 1] given twice"));
}

TEST(Layout, OutlinesMayRunEitherWayRound) {
  const Layout layout({polygon(3, {{0, 0}, {0, 10}, {10, 10}, {10, 0}})}, 2);
  const auto& outline = layout.electrodes()[0].outline;
  double twice_area = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto &a = outline[i], &b = outline[(i + 1) % 4];
    twice_area += a.x() * b.y() - a.y() * b.x();
  }
  EXPECT_DOUBLE_EQ(twice_area, 200);
}

TEST(Layout, EveryUnsoundElectrodeIsNamed) {
  const std::string text = refusal([] {
    Layout({square(1, 0, 0), square(1, 50, 0), polygon(2, {{0, 0}, {1, 1}}),
            polygon(3, {{0, 20}, {10, 30}, {10, 20}, {0, 30}}), polygon(4, {{0, 40}, {NAN, 40}, {5, 50}}),
            polygon(5, {{0, 60}, {5, 60}, {9, 60}})},
           2);
  });
  EXPECT_TRUE(holds(text, "channel 1: given twice"));
  EXPECT_TRUE(holds(text, "channel 2: outline: 2 corners, allowed: 3 or more"));
  EXPECT_TRUE(holds(text, "channel 3: outline: not a simple polygon"));
  EXPECT_TRUE(holds(text, "channel 4: outline: a corner that is not finite"));
  EXPECT_TRUE(holds(text, "channel 5: outline: not a simple polygon"));
}

TEST(Layout, OverlapIsRefusedAndTouchingIsNot) {
  EXPECT_EQ(refusal([] {
              Layout({square(1, 0, 0), square(2, 9.9, 0)}, 2);
            }),
            "channels 1 and 2: outlines overlap");
  EXPECT_EQ(refusal([] {
              Layout({square(1, 0, 0), square(2, 0, 0, 2)}, 2);
            }),
            "channels 1 and 2: outlines overlap")
      << "one inside the other";
  EXPECT_NO_THROW(Layout({square(1, 0, 0), square(2, 10, 0)}, 2));
  EXPECT_TRUE(holds(refusal([] { Layout({}, 0); }), "gap: 0 r_c, allowed: more than 0"));
}

TEST(Layout, AChannelThatIsNotThereIsAnsweredWithThoseThatAre) {
  EXPECT_EQ(refusal([] { line(7).index_of(9); }), "channel 9 does not exist; channels are 0-6");
  EXPECT_EQ(refusal([] { Layout().index_of(0); }), "channel 0 does not exist; this chip has no electrodes");
  EXPECT_EQ(Layout({square(8, 0, 0), square(3, 20, 0), square(9, 40, 0)}, 2).channels_text(), "3, 8-9");
}

TEST(Layout, AFootprintLiesOverThePadsThatItSharesAnAreaWith) {
  const Layout layout = line(3);
  EXPECT_EQ(layout.overlapping({{4, -1}, {8, -1}, {8, 1}, {4, 1}}), (std::vector<std::size_t>{0, 1}));
  EXPECT_TRUE(layout.overlapping({{5, -1}, {7, -1}, {7, 1}, {5, 1}}).empty()) << "only touches both edges";
  EXPECT_TRUE(layout.overlapping({{0, 0}, {1, 0}}).empty());
  EXPECT_TRUE(layout.overlapping({}).empty());
}

}  // namespace
}  // namespace dmf::chip
