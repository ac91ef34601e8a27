// Chains and membranes in scene files.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "chip/experiment.h"
#include "chip/scene_hash.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

namespace fs = std::filesystem;

const std::string kDomain =
    "domain: {lower: [0, 0, 0], upper: [16, 16, 12], sides: {x: periodic, y: periodic, z: wall}}\n"
    "wettability: {calibration: lan2016, rest_angle: 90}\n"
    "droplets: [{center: [8, 8], radius: 4}]\n";

Scene scene_of(const std::string& rest) { return parse_scene(kDomain + rest, "scene.yaml"); }
std::string told(const std::string& rest) {
  return refusal([&] { scene_of(rest); });
}

TEST(BondedScenes, PlaceChainsAndMembranesInTheLiquid) {
  const Scene scene = scene_of(
      "chains:\n"
      "  - spring: {kind: wlc, max_length: 1, persistence_length: 0.1}\n"
      "    count: 3\n"
      "    beads: 5\n"
      "    box: {lower: [6, 6, 2], upper: [10, 10, 6]}\n"
      "  - {spring: {kind: harmonic, stiffness: 50, length: 0.5}, points: [[7, 8, 6], [7.5, 8, 6]]}\n"
      "membranes: [{center: [8, 8, 3.5], radius: 1.5, axis: [1, 0, 0], shape: red_cell, subdivisions: 1}]\n");
  ASSERT_EQ(scene.chains.size(), 2u);
  EXPECT_EQ(scene.chains[0].bond_length, 0.5);
  Experiment experiment(scene, {1, "auto"});
  const std::size_t beads = experiment.observe()->moving_beads;
  EXPECT_EQ(beads, Experiment(scene_of(""), {1, "auto"}).observe()->moving_beads);
  for (int k = 0; k < 10; ++k) experiment.step();
  const auto snapshot = experiment.observe();
  ASSERT_EQ(snapshot->chains.size(), 4u);
  EXPECT_EQ(snapshot->chains[2].beads.size(), 5u);
  EXPECT_EQ(snapshot->chains[3].beads.size(), 2u);
  ASSERT_EQ(snapshot->membranes.size(), 1u);
  // Turned onto its edge.
  const engine::Vector3d size = snapshot->membranes[0].upper - snapshot->membranes[0].lower;
  EXPECT_LT(size.x(), 0.6 * size.y());
  // A saved run goes on.
  const std::string saved = experiment.save();
  experiment.load(saved);
  EXPECT_TRUE(experiment.save() == saved);
}

TEST(BondedScenes, TellWhatIsWrongWithLineAndKey) {
  EXPECT_TRUE(holds(
      told("chains: [{spring: {kind: fene, stiffness: 20, max_length: 1}, beads: 5, bond_length: 1.2}]"),
      "scene.yaml:4: chains[0]: bond_length: 1.2, chain beads farther apart than the spring's maximum, "
      "allowed: less than 1"));
  EXPECT_TRUE(
      holds(told("chains: [{spring: {kind: rubber}, beads: 5}]"), "chains[0].spring.kind: rubber, allowed:"));
  EXPECT_TRUE(holds(told("chains: [{spring: {kind: wlc, max_length: 1}, beads: 5}]"),
                    "chains[0].spring.persistence_length: missing"));
  EXPECT_TRUE(
      holds(told("chains: [{spring: {kind: wlc, max_length: 1, persistence_length: 0.1, stiffness: 3}, "
                 "beads: 5}]"),
            "chains[0].spring.stiffness: unknown key"));
  EXPECT_TRUE(holds(told("chains: [{spring: {kind: harmonic, stiffness: 5000, length: 0.5}, beads: 5}]"),
                    "too fast for time_step 0.01, allowed: a time_step of up to 0.0035"));
  EXPECT_TRUE(
      holds(told("membranes: [{center: [8, 8, 3], radius: 2, shape: cube}]"), "shape: cube, allowed:"));
  EXPECT_TRUE(holds(told("membranes: [{center: [8, 8, 1], radius: 2}]"), "membranes[0]: mesh: vertex"));
  const std::string fine = "{center: [8, 8, 5], radius: 4, subdivisions: 6}";
  // After something else that is wrong, so that none of them is looked at closely.
  EXPECT_TRUE(holds(told("duration: -1\nmembranes: [" + fine + ", " + fine + ", " + fine + ", " + fine + "]"),
                    "122886 vertices with the membranes before, allowed: up to 100000 in all"));
  EXPECT_TRUE(holds(told("membranes: [{mesh: no_such.obj}]"), "membranes[0].mesh: no_such.obj"));
}

TEST(BondedScenes, CountInTheContentOfAScene) {
  const std::string chain = "chains: [{spring: {kind: harmonic, stiffness: 50, length: 0.5}, beads: 5}]\n";
  const std::string membrane = "membranes: [{center: [8, 8, 4], radius: 2}]\n";
  const SceneContent plain = content_of(scene_of("")), chained = content_of(scene_of(chain));
  EXPECT_EQ(differing_parts(chained, plain), "chains");
  std::string other = chain;
  other.replace(other.find("beads: 5"), 8, "beads: 6");
  EXPECT_EQ(differing_parts(content_of(scene_of(other)), chained), "chains");
  other = chain;
  other.replace(other.find("length: 0.5"), 11, "length: 0.6");
  EXPECT_EQ(differing_parts(content_of(scene_of(other)), chained), "chains");
  EXPECT_EQ(differing_parts(content_of(scene_of(membrane)), plain), "membranes");
  EXPECT_EQ(
      differing_parts(content_of(scene_of("membranes: [{center: [8, 8, 4], radius: 2, unbent: flat}]\n")),
                      content_of(scene_of(membrane))),
      "membranes");
}

const std::string kTwoLiquids =
    "species: {head: {attraction: -40}, tail: {attraction: -40}}\n"
    "pairs:\n"
    "  liquid: {head: {attraction: -45}, tail: {attraction: -25}}\n"
    "  head: {tail: {attraction: -25}, wall: {attraction: -17}}\n"
    "  tail: {wall: {attraction: -17}}\n";

TEST(BondedScenes, SayOfWhichSpeciesTheirBeadsAre) {
  const std::string spring = "spring: {kind: harmonic, stiffness: 50, length: 0.5}, ";
  const auto of = [&](const std::string& species, const std::string& beads = "beads: 2") {
    return kTwoLiquids + "chains: [{" + spring + species + beads +
           ", count: 6, "
           "box: {lower: [6, 6, 2], upper: [10, 10, 6]}}]\n";
  };
  EXPECT_EQ(scene_of(of("species: [head, tail], ")).chains.at(0).species, (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(scene_of(of("species: tail, ", "beads: 5")).chains.at(0).species,
            (std::vector<std::uint32_t>{2}));
  EXPECT_TRUE(scene_of(of("")).chains.at(0).species.empty());
  const Scene membrane =
      scene_of(kTwoLiquids + "membranes: [{center: [8, 8, 4], radius: 2, species: tail}]\n");
  EXPECT_EQ(membrane.membranes.at(0).species, 2u);

  EXPECT_TRUE(holds(told(of("species: [head, tale], ")),
                    "chains[0].species: species tale, allowed: liquid, head, tail"));
  EXPECT_TRUE(holds(told(of("species: [head, tail], ", "beads: 5")),
                    "chains[0]: species: 2 of them, allowed: 1, or 5, one a bead"));
  EXPECT_TRUE(holds(told(of("species: {head: 1}, ")), "chains[0].species"));
  EXPECT_TRUE(holds(told(kTwoLiquids + "membranes: [{center: [8, 8, 4], radius: 2, species: [tail]}]\n"),
                    "membranes[0].species"));

  // It counts in the content of a scene, and only where it is said.
  EXPECT_EQ(differing_parts(content_of(scene_of(of("species: [head, tail], "))),
                            content_of(scene_of(of("species: [tail, head], ")))),
            "chains");
  EXPECT_EQ(
      differing_parts(content_of(membrane),
                      content_of(scene_of(kTwoLiquids + "membranes: [{center: [8, 8, 4], radius: 2}]\n"))),
      "membranes");

  // And a run of such a scene goes on after it was saved.
  Experiment experiment(scene_of(of("species: [head, tail], ")), {1, "auto"});
  for (int k = 0; k < 10; ++k) experiment.step();
  const std::string saved = experiment.save();
  experiment.load(saved);
  EXPECT_TRUE(experiment.save() == saved);
}

TEST(BondedScenes, KeepTheTextsOfTheirMeshes) {
  const fs::path folder = fs::temp_directory_path() / ("dmf_bonded_scenes_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const std::string octahedron =
      "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
      "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
  std::ofstream(folder / "octahedron.obj") << octahedron;
  std::ofstream(folder / "open.obj") << octahedron.substr(0, octahedron.rfind('f'));
  const auto write = [&](const std::string& mesh) {
    std::ofstream(folder / "own.yaml")
        << kDomain << "membranes:\n  - {mesh: " << mesh << ", center: [8, 8, 4], scale: 1.2}\n"
        << "  - {mesh: octahedron.obj, center: [8, 8, 9]}\n";
  };
  write("octahedron.obj");
  const Scene scene = load_scene((folder / "own.yaml").string());
  write("open.obj");
  const std::string open = refusal([&] { load_scene((folder / "own.yaml").string()); });
  fs::remove_all(folder);
  EXPECT_TRUE(holds(open, "membranes[0]: mesh: is not closed: the edge of vertices"));
  EXPECT_EQ(scene.files.all().size(), 3u);  // one mesh for both, and a calibration
  const Scene again = rebuild_scene(scene.files.all());
  EXPECT_EQ(differing_parts(content_of(again), content_of(scene)), "");
  ASSERT_EQ(again.membranes.size(), 2u);
  EXPECT_NEAR(engine::volume(*again.membranes[0].mesh), 4.0 / 3 * 1.2 * 1.2 * 1.2, 1e-9);
}

}  // namespace
}  // namespace dmf::chip
