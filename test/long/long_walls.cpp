// Walls of voxels over as many steps as a study has.
#include <gtest/gtest.h>

#include "chip/experiment.h"
#include "engine/walls/solid.h"

namespace dmf {
namespace {

// Faces, convex and concave edges and corners, and a force that presses the liquid on all of them.
TEST(VoxelWalls, NoBeadGetsThroughInAHundredThousandSteps) {
  const chip::Scene scene = chip::parse_scene(
      "liquid: {attraction: 25, repulsion: 0, random_amplitude: 3, initial_density: 3, bulk_density: 3}\n"
      "domain: {lower: [0, 0, 0], upper: [8, 6, 6], sides: {x: periodic, y: closed, z: closed}}\n"
      "label_grid:\n"
      "  attraction: 5\n"
      "  density: 3\n"
      "  voxel_size: [0.5, 0.5, 0.5]\n"
      "  shapes:\n"
      "    - {box: {lower: [0, 0, 0], upper: [8, 6, 6]}}\n"
      "    - {box: {lower: [0, 1, 1], upper: [8, 5, 5]}, label: fluid}\n"
      "    - {ball: {center: [4, 3, 3], radius: 1.3}}\n"
      "fills: [{lower: [0, 1, 1], upper: [8, 5, 5]}]\n"
      "body_forces: {gravity: [0.5, 0.5, 0.5]}\n"
      "watchdog: {evaporation: 1, temperature: [0.5, 100]}\n",
      "voxels.yaml");
  chip::Experiment experiment(scene, {1, "auto"}, 1);
  const engine::Solid solid(scene.parameters);
  const std::size_t beads = experiment.observe()->moving_beads;
  EXPECT_GT(beads, 200u);
  for (int look = 0; look < 2000; ++look) {
    for (int k = 0; k < 50; ++k) experiment.step();
    const auto snapshot = experiment.observe({true});
    ASSERT_EQ(snapshot->positions.size(), beads);
    for (const Eigen::Vector3f& at : snapshot->positions)
      ASSERT_FALSE(solid.contains_deep(at, 1e-3f)) << "step " << 50 * (look + 1) << " at " << at.transpose();
  }
}

}  // namespace
}  // namespace dmf
