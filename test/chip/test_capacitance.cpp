#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "chip/capacitance.h"
#include "chip/experiment.h"
#include "chip/polygon.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

constexpr double kRadius = 8;

/// Nine pads, 11 r_c wide and 1 apart, and a half sphere that is at rest at 90 degrees.
Scene scene(double x, double y, const std::string& sensing = "noise: 0 F, offset: 0 F") {
  return parse_scene(
      fmt::format("domain: {{lower: [-20, -20, 0], upper: [20, 20, 14]}}\n"
                  "wettability: {{calibration: lan2016, rest_angle: 90}}\n"
                  "chip:\n"
                  "  gap: 1\n"
                  "  grids: [{{origin: [-12, -12], columns: 3, rows: 3, pitch: 12, first_channel: 7}}]\n"
                  "  electrowetting: {{reference_angle: 60, saturation_angle: 55}}\n"
                  "  sensing: {{{}}}\n"
                  "droplets: [{{center: [{}, {}, 0], radius: {}}}]\n",
                  sensing, x, y, kRadius),
      "scene.yaml");
}

void run(Experiment& chip, int steps) {
  for (int k = 0; k < steps; ++k) chip.step();
}

/// What a circle covers of a pad, r_c^2: strips of the closed form of its chords.
double circle_on_pad(double x, double y, double radius, const Electrode& pad) {
  const auto box = bounding_box(pad.outline);
  constexpr int kStrips = 20000;
  const double width = (box.max().x() - box.min().x()) / kStrips;
  double area = 0;
  for (int k = 0; k < kStrips; ++k) {
    const double across = box.min().x() + (k + 0.5) * width - x;
    if (std::abs(across) >= radius) continue;
    const double half = std::sqrt(radius * radius - across * across);
    area += width * std::max(0.0, std::min(box.max().y(), y + half) - std::max(box.min().y(), y - half));
  }
  return area;
}

// c = 2 gamma (cos 60 - cos 90) / 63^2 = 2 * 0.072 * 0.5 / 3969 = 1.81406e-5 F/m^2, 1.81406e-15 F a r_c^2.
constexpr double kLiquid = 1.81406e-15;

TEST(Capacitance, IsProportionalToTheWettedAreaWithinFivePercent) {
  double products = 0, squares = 0;
  const double full_pad = kLiquid * 11 * 11;
  for (const auto& [x, y] :
       {std::pair{0.0, 0.0}, {3.3, 0.0}, {6.0, 0.0}, {6.0, 6.0}, {-2.7, 8.1}, {-9.5, -4.2}}) {
    Experiment chip(scene(x, y), {1, "auto"});
    run(chip, 200);
    const auto reading = chip.sense().capacitance;
    // Of the half sphere that the liquid fills at its bulk density.
    const double radius = std::cbrt(chip.observe()->droplets.at(0).volume * 3 / (2 * M_PI));
    double sum = 0, exact_sum = 0;
    for (std::size_t pad = 0; pad < reading.size(); ++pad) {
      const double area = circle_on_pad(x, y, radius, chip.scene().layout.electrodes()[pad]);
      products += area * reading[pad];
      squares += area * area;
      sum += reading[pad];
      exact_sum += kLiquid * area;
      EXPECT_NEAR(reading[pad], kLiquid * area, 0.05 * full_pad) << "pad " << pad << " at " << x << ", " << y;
    }
    EXPECT_NEAR(sum / exact_sum, 1, 0.05) << "over all pads, at " << x << ", " << y;
  }
  EXPECT_NEAR(products / squares / kLiquid, 1, 0.05) << "slope through the origin";
}

TEST(Capacitance, OfADryBoardIsItsOffset) {
  Scene dry = scene(0, 0, "noise: 0 F, offset: 20 fF");
  dry.droplets.clear();
  const Experiment chip(dry, {1, "auto"});
  for (const double value : chip.sense().capacitance) EXPECT_DOUBLE_EQ(value, 20e-15);
}

TEST(Capacitance, BetweenTwoPlatesTheFillerCountsToo) {
  Scene plates = scene(0, 0, "noise: 0 F, offset: 0 F, filler_permittivity: 2.5");
  EXPECT_EQ(filler_capacitance(plates), 0) << "open";
  plates.parameters.domain.upper_side[2] = engine::Side::wall;
  // Oil: 8.8541878e-12 * 2.5 / 140e-6 = 1.58111e-7 F/m^2, in series with 1.81406e-5: 1.56744e-7.
  EXPECT_NEAR(filler_capacitance(plates), 1.56744e-7, 1e-12);
  const PadCapacitance pads(plates);
  const auto dry = pads.capacitances({});
  EXPECT_NEAR(dry[0], 1.56744e-7 * 121e-10, 1e-20);
  engine::WettedArea all;
  all.columns = all.rows = 40;
  all.wet.assign(1600, true);
  const auto wet = pads.capacitances(all);
  EXPECT_NEAR(wet[4], kLiquid * 121, 1e-18);
}

// A pancake of volume V between plates h of liquid apart has the cross-section V / h on the mean over its
// height. Its rim bulges by (h / 2) (1 - sin 110) / -cos 110 = 0.176 h over the contact line, two thirds of
// it on the mean.
TEST(Capacitance, OfAPancakeFollowsItsContactArea) {
  const auto closed = [](double x, double y) {
    return parse_scene(
        fmt::format("domain: {{lower: [-20, -20, 0], upper: [20, 20, 4], sides: {{z: plates}}}}\n"
                    "wettability: {{rest_angle: 110, top_angle: 110}}\n"
                    "chip:\n"
                    "  gap: 1\n"
                    "  grids: [{{origin: [-12, -12], columns: 3, rows: 3, pitch: 12}}]\n"
                    "  electrowetting: {{reference_angle: 60, saturation_angle: 55}}\n"
                    "  sensing: {{noise: 0 F, offset: 0 F}}\n"
                    "droplets: [{{center: [{}, {}], fills: 1.6}}]\n",
                    x, y),
        "scene.yaml");
  };
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {6.0, 2.0}, {-5.0, 6.5}}) {
    Experiment chip(closed(x, y), {1, "auto"});
    run(chip, 300);
    const double height = engine::liquid_height(chip.scene().parameters);
    const double mean = std::sqrt(chip.observe()->droplets.at(0).volume / (M_PI * height));
    const double radius = mean - 2.0 / 3 * 0.176 * height;
    const double liquid = liquid_capacitance(chip.scene()) * chip.scene().units.area_m2();
    const double filler = filler_capacitance(chip.scene()) * chip.scene().units.area_m2();
    const auto reading = chip.sense().capacitance;
    for (std::size_t pad = 0; pad < reading.size(); ++pad) {
      const double area = circle_on_pad(x, y, radius, chip.scene().layout.electrodes()[pad]);
      EXPECT_NEAR((reading[pad] - filler * 121) / (liquid - filler), area, 0.05 * 121)
          << "pad " << pad << " at " << x << ", " << y;
    }
  }
}

TEST(Capacitance, AWettedAreaCountsOnlyWhereAPadIs) {
  // Cells of 1 r_c; pad 0 reaches from -17.5 to -6.5: half of the cell from -18 to -17 is on it.
  const PadCapacitance pads(scene(0, 0));
  engine::WettedArea one;
  one.first_column = 2;
  one.first_row = 7;
  one.columns = one.rows = 1;
  one.wet = {true};
  EXPECT_NEAR(pads.wetted_areas(one)[0], 0.5, 1e-12);
  one.first_column = 13;  // -7 to -6
  EXPECT_NEAR(pads.wetted_areas(one)[0], 0.5, 1e-12);
  EXPECT_NEAR(pads.wetted_areas(one)[1], 0, 1e-12);
}

TEST(Capacitance, NoiseHasItsWidthAndNoMemory) {
  const Scene noisy = scene(0, 0, "noise: 3 fF, offset: 10 fF");
  std::vector<double> values, products;
  for (std::uint64_t step = 0; step < 2000; ++step) {
    const auto reading = read_channels(std::vector<double>(9, 0.0), noisy, 5, step);
    for (const double value : reading.capacitance) values.push_back((value - 10e-15) / 3e-15);
  }
  const double count = static_cast<double>(values.size());
  double mean = 0, square = 0, beyond = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    mean += values[k] / count;
    square += values[k] * values[k] / count;
    beyond += std::abs(values[k]) > 1 ? 1 / count : 0;
  }
  // 18000 numbers: the mean is off by 0.0075, the variance by 0.0105, the share beyond 1 by 0.0035.
  EXPECT_NEAR(mean, 0, 4 * 0.0075);
  EXPECT_NEAR(square, 1, 4 * 0.0105);
  EXPECT_NEAR(beyond, 0.3173, 4 * 0.0035);
  for (const std::size_t lag : {1, 9}) {  // the next channel, the next reading
    double correlation = 0;
    for (std::size_t k = lag; k < values.size(); ++k) correlation += values[k] * values[k - lag] / count;
    EXPECT_NEAR(correlation, 0, 4 * 0.0075) << lag;
  }
}

TEST(Capacitance, AReadingIsAFunctionOfTheRun) {
  const std::string sensing = "noise: 3 fF, interval: 0.2";
  Experiment watched(scene(0, 0, sensing), {1, "auto"}), looked_at(scene(0, 0, sensing), {1, "auto"});
  watched.want_readings(true);
  run(watched, 19);
  EXPECT_FALSE(watched.take_reading()) << "its time has not come";
  run(watched, 6);
  const auto kept = watched.take_reading();
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->step, 20u);
  EXPECT_FALSE(watched.take_reading()) << "it is taken once";
  run(looked_at, 20);
  EXPECT_EQ(looked_at.sense().capacitance, kept->capacitance);
  EXPECT_EQ(looked_at.sense().capacitance, kept->capacitance) << "and looking changes nothing";
  run(looked_at, 5);
  EXPECT_TRUE(looked_at.save() == watched.save());
  Experiment other(scene(0, 0, sensing), {1, "auto"}, 2);
  EXPECT_NE(other.sense().capacitance, Experiment(scene(0, 0, sensing), {1, "auto"}).sense().capacitance);
}

TEST(Sensing, DefaultsFollowTheSizeOfThePads) {
  const Sensing sensing = scene(0, 0, "").sensing;
  EXPECT_NEAR(sensing.noise, 0.005 * kLiquid * 121, 1e-20);
  EXPECT_NEAR(sensing.offset, 0.05 * kLiquid * 121, 1e-19);
  EXPECT_EQ(sensing.interval, 1);
  EXPECT_EQ(sensing.filler_permittivity, 1);
}

TEST(Sensing, WhatIsWrongIsTold) {
  const std::string text = refusal(
      [] { scene(0, 0, "noise: -1 fF, offset: 3 V, interval: 0, filler_permittivity: 0.5, nose: 1"); });
  EXPECT_TRUE(holds(text, "chip.sensing.noise: -1 fF, allowed: at least 0 F"));
  EXPECT_TRUE(holds(text, "chip.sensing.offset: 3 V, allowed: "));
  EXPECT_TRUE(holds(text, "chip.sensing.interval: 0, allowed: more than 0 tau"));
  EXPECT_TRUE(holds(text, "chip.sensing.filler_permittivity: 0.5, allowed: [1, 100000]"));
  EXPECT_TRUE(holds(text, "chip.sensing.nose: unknown key, did you mean `noise`?"));
}

}  // namespace
}  // namespace dmf::chip
