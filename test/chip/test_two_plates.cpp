// A closed chip: a top plate over the electrodes, droplets as pancakes.
#include <gtest/gtest.h>

#include <cmath>

#include "chip/experiment.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

// As coarse as a closed chip goes: three electrodes of 7 r_c, 3 r_c between the plates.
const char* const kScene = R"(
domain: {lower: [-14, -8, 0], upper: [14, 8, 3], sides: {z: plates}}
wettability: {rest_angle: 120, top_angle: 115}
chip:
  gap: 1
  grids: [{origin: [-7, 0], columns: 3, rows: 1, pitch: 7}]
  electrowetting: {reference_voltage: 60, reference_angle: 50, saturation_angle: 50}
)";

Scene scene(const std::string& more = "") { return parse_scene(kScene + more, "closed.yaml"); }

void run(Experiment& experiment, double time) {
  const double steps = time / experiment.scene().parameters.time_step;
  for (int k = 0; k < steps; ++k) experiment.step();
}

const engine::DropletObservation& largest(const engine::Snapshot& snapshot) {
  return *std::max_element(snapshot.droplets.begin(), snapshot.droplets.end(),
                           [](const auto& a, const auto& b) { return a.volume < b.volume; });
}

TEST(ClosedChip, ADropletFillsAsManyElectrodesAsItWasAskedFor) {
  const Scene closed = scene("droplets: [{center: [0, 0], fills: 1.5}]\n");
  EXPECT_TRUE(closed.parameters.domain.has_top_plate());
  EXPECT_EQ(closed.parameters.wall.top_contact_angle, 115);
  const double footprint = M_PI * std::pow(pancake_radius(closed.droplets.at(0), closed.parameters), 2);
  EXPECT_NEAR(footprint, 1.5 * 7 * 7, 1e-6);
  // The same by command; its volume is what the droplet reports.
  Experiment chip(scene(), {1, "auto"});
  DispenseDroplet command;
  command.fills = 1.5;
  const Reply reply = chip.apply(command);
  ASSERT_TRUE(reply.success) << reply.message;
  const double expected = 1.5 * 49 * engine::liquid_height(closed.parameters);
  EXPECT_NEAR(chip.observe()->droplets.at(0).volume, expected, 0.02 * expected);
  EXPECT_EQ(std::get<DispenseDroplet>(command_from_json(to_json(command))).fills, 1.5);
}

TEST(ClosedChip, ADropletMovesOnlyWhenItsFootprintReachesTheActuatedElectrode) {
  // 1.3 electrodes' worth reach over the edge to the next electrode, not to the one after it.
  for (const std::uint32_t channel : {1u, 2u}) {
    Experiment chip(scene("droplets: [{center: [-7, 0], fills: 1.3}]\n"), {1, "auto"});
    run(chip, 20);
    const double before = largest(*chip.observe()).centroid.x();
    chip.apply(SetHv{60, 1000, true});
    chip.apply(SetElectrodes{{channel}});
    run(chip, 130);
    const double moved = largest(*chip.observe()).centroid.x() - before;
    if (channel == 1)
      EXPECT_GT(moved, 4);
    else
      EXPECT_LT(std::abs(moved), 1.5);  // it wanders: k_BT is not small for so few beads
  }
}

TEST(ClosedChip, TwoDropletsMergeOnTheElectrodeBetweenThem) {
  Experiment chip(scene("droplets: [{center: [-7, 0], fills: 1.1}, {center: [7, 0], fills: 1.1}]\n"),
                  {1, "auto"});
  const double volume = chip.observe()->droplets.at(0).volume + chip.observe()->droplets.at(1).volume;
  chip.apply(SetHv{60, 1000, true});
  chip.apply(SetElectrodes{{1}});
  run(chip, 100);
  const auto merged = chip.observe();
  ASSERT_EQ(merged->droplets.size(), 1u);
  EXPECT_NEAR(merged->droplets[0].volume, volume, 0.02 * volume);
  EXPECT_NEAR(merged->droplets[0].centroid.x(), 0, 1);
}

TEST(ClosedChip, WhatDoesNotFitIsRefusedWithWhatWould) {
  EXPECT_TRUE(holds(refusal([] { scene("droplets: [{center: [0, 0], fills: 0}]\n"); }), "fills"));
  EXPECT_TRUE(
      holds(refusal([] { scene("droplets: [{center: [0, 0], fills: 1, radius: 2}]\n"); }), "given together"));
  EXPECT_TRUE(holds(refusal([] { scene("droplets: [{center: [9, 0], fills: 2}]\n"); }), "allowed"));
  // Spheres of these volumes would not meet, the pancakes do.
  EXPECT_TRUE(holds(
      refusal([] { scene("droplets: [{center: [-5, 0], fills: 1.5}, {center: [5, 0], fills: 1.5}]\n"); }),
      "from another droplet"));
  const std::string open = "domain: {lower: [-14, -8, 0], upper: [14, 8, 9]}\n";
  EXPECT_TRUE(
      holds(refusal([&] { parse_scene(open + "droplets: [{center: [0, 0], fills: 1}]\n", "open.yaml"); }),
            "plates"));
  EXPECT_TRUE(holds(refusal([&] { parse_scene(open + "wettability: {top_angle: 100}\n", "open.yaml"); }),
                    "top_angle"));
  const std::string hot =
      "domain: {lower: [-14, -8, 0], upper: [14, 8, 3], sides: {z: plates}}\n"
      "wettability: {top_angle: 179}\n";
  EXPECT_TRUE(holds(refusal([&] { parse_scene(hot, "hot.yaml"); }), "wettability.top_angle"));
  Experiment chip(scene(), {1, "auto"});
  DispenseDroplet both{0, 0, 1e-15, 1};
  EXPECT_FALSE(chip.apply(both).success);
  EXPECT_FALSE(chip.apply(DispenseDroplet{0, 0, 0, -1}).success);
  EXPECT_FALSE(chip.apply(DispenseDroplet{0, 0, 0, 0}).success);
  EXPECT_EQ(chip.observe()->moving_beads, 0u);
}

}  // namespace
}  // namespace dmf::chip
