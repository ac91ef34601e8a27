// Sides and dimensions in scene files.
#include <gtest/gtest.h>

#include "chip/experiment.h"
#include "chip/scene.h"
#include "chip/scene_hash.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

using engine::Reflection;

Scene parse(const std::string& text) { return parse_scene(text, "scene.yaml"); }
std::string refused(const std::string& text) {
  return refusal([&] { parse(text); });
}

const char* const kChannel = R"(
domain: {lower: [0, 0, 0], upper: [16, 16, 12], sides: {x: periodic, y: periodic, z: plates}}
wall: {attraction: -20}
boundaries: {z: bounce_forward, upper_z: maxwellian, lower_velocity: [0.5, -0.25]}
body_forces: {gravity: [0.01, 0, 0]}
droplets: [{center: [8, 8, 6], radius: 4}]
)";

TEST(BoundaryScene, ReadsWhatEachSideDoes) {
  const engine::Parameters parameters = parse(kChannel).parameters;
  EXPECT_EQ(parameters.boundaries.lower_reflection[2], Reflection::bounce_forward);
  EXPECT_EQ(parameters.boundaries.upper_reflection[2], Reflection::maxwellian);
  EXPECT_EQ(parameters.boundaries.upper_reflection[0], Reflection::bounce_back);
  EXPECT_EQ(parameters.boundaries.lower_velocity, Eigen::Vector2d(0.5, -0.25));
  EXPECT_EQ(parameters.wall.attraction, -20);
  EXPECT_EQ(parameters.dimensions, 3);

  const engine::Parameters sheared =
      parse(
          "domain: {lower: [0, 0, 0], upper: [9, 4, 9], sides: {x: periodic, z: periodic}}\n"
          "dimensions: 2\nboundaries: {shear_rate: 0.2, y: specular}")
          .parameters;
  EXPECT_EQ(sheared.boundaries.shear_rate, 0.2);
  EXPECT_EQ(sheared.boundaries.lower_reflection[1], Reflection::specular);
  EXPECT_EQ(sheared.dimensions, 2);
}

TEST(BoundaryScene, ReadsFrozenParticlesAndCountsThemWhereASideHasThem) {
  const std::string closed = "domain: {lower: [0, 0, 0], upper: [9, 4, 9], sides: {z: closed}}\n";
  const std::string sides = "boundaries: {z: frozen_particles, frozen_particles: {";
  const engine::Parameters read =
      parse(closed + sides + "attraction: -12, lateral_friction: 3.5}}").parameters;
  EXPECT_EQ(read.boundaries.lower_reflection[2], Reflection::frozen_particles);
  EXPECT_EQ(read.boundaries.frozen_particles.attraction, -12);
  EXPECT_EQ(read.boundaries.frozen_particles.lateral_friction, 3.5);
  const SceneContent with = content_of(parse(closed + sides + "lateral_friction: 3.5}}"));
  EXPECT_EQ(differing_parts(content_of(parse(closed + sides + "lateral_friction: 4}}")), with), "boundaries");
  EXPECT_EQ(
      differing_parts(content_of(parse(closed + sides + "attraction: -12, lateral_friction: 3.5}}")), with),
      "boundaries");
  // A number that no side asks for changes nothing.
  EXPECT_EQ(
      differing_parts(content_of(parse(closed + "boundaries: {frozen_particles: {lateral_friction: 4}}")),
                      content_of(parse(closed))),
      "");
  EXPECT_TRUE(holds(refused(closed + sides + "lateral_friction: -1}}"),
                    "boundaries.frozen_particles.lateral_friction: -1, allowed: 0 to 1000"));
}

TEST(BoundaryScene, RunsWithAWallThatShowsNoContactAngle) {
  Experiment experiment(parse(kChannel), {1, "auto"});
  for (int k = 0; k < 100; ++k) experiment.step();
  const std::string saved = experiment.save();
  Experiment other(parse(kChannel), {1, "auto"});
  other.load(saved);
  experiment.step();
  other.step();
  EXPECT_EQ(experiment.save(), other.save());
}

TEST(BoundaryScene, NamesBoundariesAndDimensionsAmongWhatDiffers) {
  const std::string closed = "domain: {lower: [0, 0, 0], upper: [9, 4, 9]}\n";
  const SceneContent usual = content_of(parse(closed));
  EXPECT_EQ(differing_parts(content_of(parse(closed + "boundaries: {x: specular}")), usual), "boundaries");
  EXPECT_EQ(differing_parts(content_of(parse(closed + "dimensions: 2")), usual), "dimensions");
  EXPECT_EQ(differing_parts(content_of(parse(closed + "wall: {attraction: -20}")), usual), "wall");
  // Nothing but the usual is nothing new: older records still hold.
  EXPECT_EQ(differing_parts(content_of(parse(closed + "boundaries: {x: bounce_back}")), usual), "");
}

TEST(BoundaryScene, WhatDoesNotGoTogetherIsToldWithItsKey) {
  const std::string domain = "domain: {lower: [0, 0, 0], upper: [12, 12, 12]}\n";
  EXPECT_TRUE(
      holds(refused(domain + "boundaries: {x: mirror}"), "boundaries.x: mirror, allowed: bounce_back"));
  EXPECT_TRUE(holds(refused(domain + "boundaries: {shear_rate: 0.1}"),
                    "boundaries.shear_rate: 0.1, allowed: 0 unless domain.sides x and z are periodic"));
  EXPECT_TRUE(holds(refused(domain + "boundaries: {lower_velocity: [30, 0]}"),
                    "boundaries.lower_velocity: (30, 0), allowed: up to 10 r_c / tau"));
  EXPECT_TRUE(
      holds(refused(domain + "boundaries: {lower_z: symmetric}"), "boundaries.lower_z: symmetric on a wall"));
  EXPECT_TRUE(
      holds(refused(domain + "boundaries: {x: symmetric}"), "boundaries.lower_x: symmetric beside a wall"));
  EXPECT_TRUE(holds(refused(domain + "dimensions: 5"), "dimensions: 5, allowed: 2 or 3"));
  const std::string chip = "chip: {gap: 1, grids: [{origin: [2, 2], columns: 1, rows: 1, pitch: 6}]}\n";
  for (const std::string& angles : {chip, std::string("wettability: {rest_angle: 110}\n")})
    EXPECT_TRUE(
        holds(refused(domain + angles + "wall: {attraction: -20}"), "given together with wall.attraction"));
  EXPECT_TRUE(holds(refused(domain + chip + "dimensions: 2"), "electrodes in a scene of two dimensions"));
  EXPECT_TRUE(holds(refused(domain + "wall: {attraction: -20}\n"
                                     "wettability: {program: {positions: [0], contact_angles: [90]}}"),
                    "wall.attraction"));
}

TEST(BoundaryScene, BodiesGoWithSidesThatAreShearedSymmetricOrMoveAndWithTwoDimensions) {
  const std::string bodies =
      "microparticles: [{center: [4, 4, 4], radius: 1}]\n"
      "chains: [{spring: {kind: harmonic, stiffness: 50, length: 0.5}, beads: 6}]\n";
  for (const char* sides :
       {"sides: {x: periodic, y: periodic, z: periodic}}\nboundaries: {shear_rate: 0.1}\n",
        "sides: {x: periodic, y: periodic, z: closed}}\nboundaries: {lower_z: symmetric}\n",
        "sides: {x: periodic, y: periodic, z: plates}}\nboundaries: {upper_velocity: [0.1, 0]}\n",
        "sides: {x: periodic, z: periodic}}\ndimensions: 2\n"}) {
    const std::string scene = "domain: {lower: [0, 0, 0], upper: [9, 9, 9], " + std::string(sides) + bodies +
                              "fills: [{lower: [0, 0, 0], upper: [9, 9, 9]}]\nwatchdog: {evaporation: 1}\n";
    Experiment experiment(parse(scene), {1, "auto"});
    for (int k = 0; k < 60; ++k) experiment.step();
    Experiment other(parse(scene), {1, "auto"});
    other.load(experiment.save());
    experiment.step();
    other.step();
    EXPECT_EQ(experiment.save(), other.save()) << sides;
    EXPECT_EQ(experiment.observe()->chains.size(), 1u);
  }
  const std::string flat = "domain: {lower: [0, 0, 0], upper: [9, 9, 9]}\ndimensions: 2\n";
  EXPECT_TRUE(holds(refused(flat + "microparticles: [{center: [4, 4], radius: 1, contact_angle: 100}]"),
                    "contact angle with dimensions: 2, allowed: attraction"));
  EXPECT_TRUE(holds(refused(flat + "membranes: [{center: [4, 4, 4], radius: 3}]"),
                    "membrane: with dimensions: 2, allowed: a chain"));
}

}  // namespace
}  // namespace dmf::chip
