// Scenes of several liquids.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "chip/experiment.h"
#include "chip/scene_hash.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

const char* const kScene = R"(
domain: {lower: [-9, -9, 0], upper: [9, 9, 5], sides: {x: periodic, y: periodic, z: plates}}
species:
  oil: {attraction: -38, random_amplitude: 5, initial_density: 5.5}
pairs:
  liquid: {oil: {attraction: -12}}
  wall: {oil: {attraction: -25, repulsion: 20}}
droplets: [{center: [0, 0], radius: 3.5}]
fills: [{species: oil}, {lower: [-9, -9, 0], upper: [9, 9, 1]}]
)";

std::string changed(const std::string& from, const std::string& to) {
  std::string text = kScene;
  return text.replace(text.find(from), from.size(), to);
}

Scene parsed(const std::string& text) { return parse_scene(text, "oil.yaml"); }

TEST(MixtureScene, GivesEveryPairItsLawAndTheRestOfLiquid) {
  const Scene scene = parsed(kScene);
  const engine::MixtureParameters& mixture = scene.parameters.mixture;
  ASSERT_EQ(mixture.liquids.size(), 1u);
  const engine::FurtherLiquid& oil = mixture.liquids[0];
  EXPECT_EQ(oil.name, "oil");
  EXPECT_EQ(oil.own.attraction, -38);
  EXPECT_EQ(oil.own.repulsion, 25);
  EXPECT_EQ(oil.own.random_amplitude, 5);
  EXPECT_EQ(oil.initial_density, 5.5);
  EXPECT_EQ(oil.bulk_density, 6.06);
  ASSERT_EQ(mixture.pairs.size(), 2u);
  EXPECT_EQ(mixture.pairs[0].first, "liquid");
  EXPECT_EQ(mixture.pairs[0].second, "oil");
  EXPECT_EQ(mixture.pairs[0].coefficients.attraction, -12);
  EXPECT_EQ(mixture.pairs[0].coefficients.random_amplitude, 6);
  EXPECT_EQ(mixture.pairs[1].coefficients.repulsion, 20);
  ASSERT_EQ(scene.fills.size(), 2u);
  EXPECT_EQ(scene.fills[0].species, 1u);
  EXPECT_EQ(scene.fills[0].upper, scene.parameters.domain.upper);
  EXPECT_EQ(scene.fills[1].species, 0u);
  EXPECT_EQ(scene.fills[1].upper.z(), 1);
  EXPECT_EQ(scene.droplets[0].species, 0u);
}

TEST(MixtureScene, HasDropletsOfEitherLiquid) {
  const Scene scene = parsed(changed("droplets: [{center: [0, 0], radius: 3.5}]",
                                     "droplets: [{center: [-4, 0], radius: 2.2}, "
                                     "{center: [4, 0], radius: 2.2, species: oil}]"));
  ASSERT_EQ(scene.droplets.size(), 2u);
  EXPECT_EQ(scene.droplets[0].species, 0u);
  EXPECT_EQ(scene.droplets[1].species, 1u);
}

TEST(MixtureScene, ADropletIsDispensedOfTheLiquidThatIsNamed) {
  const Scene scene =
      parsed(changed("droplets: [{center: [0, 0], radius: 3.5}]\nfills: [{species: oil}, {lower: [-9, -9, "
                     "0], upper: [9, 9, 1]}]\n",
                     ""));
  Experiment experiment(scene, {1, "auto"});
  const double length = scene.units.length_m, volume = 60 * scene.units.volume_m3();
  EXPECT_TRUE(experiment.apply(DispenseDroplet{-5 * length, 0, volume}).success);
  EXPECT_TRUE(experiment.apply(DispenseDroplet{5 * length, 0, volume, 0, "oil"}).success);
  const std::string refused = experiment.apply(DispenseDroplet{0, 6 * length, volume, 0, "water"}).message;
  EXPECT_TRUE(holds(refused, "species water, allowed: liquid, oil"));
  for (int k = 0; k < 50; ++k) experiment.step();
  const auto snapshot = experiment.observe();
  ASSERT_EQ(snapshot->droplets.size(), 2u);
  for (const engine::DropletObservation& droplet : snapshot->droplets)
    EXPECT_EQ(droplet.species, droplet.centroid.x() > 0 ? 1u : 0u);
}

TEST(MixtureScene, RunsWithItsMediumAroundTheDropletAndComesBackFromASave) {
  const Scene scene = parsed(changed(", {lower: [-9, -9, 0], upper: [9, 9, 1]}", ""));
  Experiment experiment(scene, {1, "auto"});
  for (int k = 0; k < 60; ++k) experiment.step();
  const auto snapshot = experiment.observe({true});
  ASSERT_EQ(snapshot->droplets.size(), 2u);
  EXPECT_EQ(snapshot->droplets[0].species, 0u);
  EXPECT_EQ(snapshot->droplets[1].species, 1u);
  // The box is full: 5 r_c of height less what both walls keep off, at about six beads.
  EXPECT_NEAR(static_cast<double>(snapshot->moving_beads), 18 * 18 * 5 * 5.5, 0.05 * 18 * 18 * 5 * 5.5);
  const std::string saved = experiment.save();
  for (int k = 0; k < 30; ++k) experiment.step();
  Experiment other(scene, {2, "auto"});
  other.load(saved);
  for (int k = 0; k < 30; ++k) other.step();
  EXPECT_EQ(*other.observe({false, true})->state_hash, *experiment.observe({false, true})->state_hash);
}

TEST(MixtureScene, PlainDpdOnAWallNeedsAConstantAttractionAndHasNoWettability) {
  const std::string plain = R"(
liquid: {attraction: 18.75, repulsion: 0, random_amplitude: 3, initial_density: 4, bulk_density: 4}
domain: {lower: [0, 0, 0], upper: [8, 8, 6]}
pairs: {liquid: {wall: {attraction: 9.68}}}
fills: [{}]
)";
  Experiment experiment(parsed(plain), {1, "auto"});
  for (int k = 0; k < 50; ++k) experiment.step();
  SetWettability command;
  command.positions = {0};
  command.contact_angles_deg = {90};
  EXPECT_TRUE(holds(experiment.apply(command).message, "pairs.liquid.wall"));
  EXPECT_TRUE(holds(refusal([&] { parsed(plain + "wettability: {rest_angle: 90}"); }),
                    "wettability: given together with wall.attraction or pairs.liquid.wall"));
}

TEST(MixtureScene, ThatIsNotSoundIsRefusedByKeyAndLine) {
  const std::vector<std::array<std::string, 3>> cases{
      {"  oil: {attraction: -38,", "  oil: {atraction: -38,", "atraction: unknown key"},
      {"  oil: {attraction: -38,", "  oil: {attraction: -38, repulsion: 0,",
       "oil.yaml:4: species.oil.attraction: -38, allowed: 0 to 200 with repulsion 0"},
      {"  wall: {oil: {attraction: -25, repulsion: 20}}\n", "", "pairs: no law for oil and wall"},
      {"  liquid: {oil: {attraction: -12}}\n", "", "pairs: no law for liquid and oil"},
      {"  liquid: {oil: {attraction: -12}}\n",
       "  liquid: {oil: {attraction: -12}}\n  oil: {liquid: {attraction: -14}}\n",
       "oil.yaml:7: pairs.oil.liquid: given twice, and an asymmetric table"},
      {"  liquid: {oil: {attraction: -12}}\n", "  liquid: {oil: {attraction: -12}, tar: {attraction: -1}}\n",
       "pairs.liquid.tar: unknown species tar, allowed: liquid, oil, wall, microparticle"},
      {"  liquid: {oil: {attraction: -12}}\n",
       "  liquid: {oil: {attraction: -12}, microparticle: {attraction: -1}}\n",
       "oil.yaml:6: pairs.liquid.microparticle: allowed: a species that is listed"},
      {"{species: oil}", "{species: tar}", "species tar, allowed: liquid, oil"},
      {"radius: 3.5}", "radius: 3.5, species: tar}", "species tar, allowed: liquid, oil"},
      {"upper: [9, 9, 1]}", "upper: [9, 9, 7]}", "(9, 9, 7) r_c, allowed: inside the domain"},
      {"upper: [9, 9, 1]}", "upper: [9, -9, 1]}", "lower is not below upper"},
      {"domain:", "spline: {attraction: 1}\ndomain:", "spline: together with a many-body repulsion"}};
  for (const auto& [from, to, said] : cases)
    EXPECT_TRUE(holds(refusal([&, from = from, to = to] { parsed(changed(from, to)); }), said)) << to;
}

TEST(MixtureScene, DiffersByPartsOfItsOwnAndLeavesOtherScenesTheirHash) {
  const SceneContent original = content_of(parsed(kScene));
  for (const auto& [from, to, part] :
       std::vector<std::array<std::string, 3>>{{"attraction: -38", "attraction: -37", "species"},
                                               {"attraction: -12", "attraction: -13", "species"},
                                               {"upper: [9, 9, 1]", "upper: [9, 9, 1.5]", "fills"},
                                               {"radius: 3.5}", "radius: 3.5, species: oil}", "droplets"}})
    EXPECT_EQ(differing_parts(content_of(parsed(changed(from, to))), original), part) << to;
  for (const auto& [part, hash] : content_of(parsed("domain: {lower: [0, 0, 0], upper: [8, 8, 8]}")))
    EXPECT_TRUE(part != "species" && part != "fills" && part != "spline") << part;
}

}  // namespace
}  // namespace dmf::chip
