// A cell through a throat.
#include <gtest/gtest.h>

#include <cmath>

#include "tools/constriction.h"

namespace dmf::tools {
namespace {

TEST(Constriction, ARedCellGoesThroughAThroatNarrowerThanItselfStretchedAndKeepsAreaAndVolume) {
  ConstrictionRun run;
  run.scene = chip::parse_scene(
      "liquid: {attraction: 25, repulsion: 0, random_amplitude: 3, initial_density: 3, bulk_density: 3}\n"
      "species: {membrane: {attraction: 25}}\n"
      "pairs: {liquid: {membrane: {attraction: 60}}, membrane: {wall: {attraction: 60}}}\n"
      "domain: {lower: [-10, -4.5, -4.5], upper: [10, 4.5, 4.5],\n"
      "  sides: {x: periodic, y: closed, z: closed}}\n"
      "label_grid:\n"
      "  attraction: 25\n"
      "  density: 3\n"
      "  shapes:\n"
      "    - {box: {lower: [-10, -4.5, -4.5], upper: [10, 4.5, 4.5]}}\n"
      "    - {box: {lower: [-10, -3.5, -3.5], upper: [10, 3.5, 3.5]}, label: fluid}\n"
      "    - {box: {lower: [-1.5, -4.5, -4.5], upper: [1.5, 4.5, 4.5]}}\n"
      "    - {box: {lower: [-1.5, -2, -2], upper: [1.5, 2, 2]}, label: fluid}\n"
      "fills: [{}]\n"
      "membranes: [{center: [-5, 0, 0], shape: red_cell, radius: 2.8, subdivisions: 2, axis: [1, 0, 0],\n"
      "  species: membrane}]\n"
      "body_forces: {gravity: [0.4, 0, 0]}\n"
      "watchdog: {evaporation: 1}\n",
      "throat.yaml");
  run.begin = -1.5;
  run.end = 1.5;
  run.time = 20;
  const ConstrictionResult result = run_constriction(run);
  // It is 5.6 wide, the throat 4. A disc, whose two longer radii of gyration are equal, becomes a rod and a
  // disc again.
  EXPECT_FALSE(std::isnan(result.passage));
  EXPECT_LT(result.width, 4);
  EXPECT_GT(result.elongation, 1.3);
  EXPECT_LT(result.recovered, 1.15);
  EXPECT_LT(result.area_error, 0.08);
  EXPECT_LT(result.volume_error, 0.1);
  EXPECT_EQ(result.leaked, 0);
}

}  // namespace
}  // namespace dmf::tools
