#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "chip/experiment.h"
#include "chip/scene.h"
#include "engine/droplet.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

// Of config/boards/purpledrop_example.json: pitch 2.5 mm, 19 x 14 mm in all.
Scene parse(const std::string& chip, const std::string& more = "") {
  return parse_scene("chip: {file: purpledrop_example.json" + chip + "}\n" + more, "scene.yaml");
}
std::string refused(const std::string& chip, const std::string& more = "") {
  return refusal([&] { parse(chip, more); });
}

TEST(BoardScene, AFileAndAResolutionAreAWholeScene) {
  const Scene scene = parse(", resolution: 12.5", "droplets: [{electrode: 21, radius: 5}]\n");
  EXPECT_NEAR(scene.units.length_m, 2.5e-3 / 12.5, 1e-15);
  // 1 r_c is 0.2 mm: the board reaches to 47.5 and 35, and half a pitch of 6.25 more.
  const engine::Domain& domain = scene.parameters.domain;
  EXPECT_TRUE(domain.upper.isApprox(engine::Vector3d(54, 42, 25)));
  EXPECT_TRUE(domain.lower.isApprox(engine::Vector3d(-54, -42, 0)));
  EXPECT_TRUE(domain.has_wall());
  EXPECT_DOUBLE_EQ(scene.layout.gap(), 2.5) << "a fifth of the pitch";
  EXPECT_EQ(scene.layout.channels_text(), "10-12, 20-24, 30-32, 40-41, 50-51");
  // Channel 21 is at (-5.75, 3.25) mm from the middle of the board, see test_board_files.cpp.
  EXPECT_TRUE(scene.droplets.at(0).center.isApprox(engine::Vector3d(-28.75, 16.25, 5)));
}

TEST(BoardScene, BetweenPlatesADropletMayFillAnElectrodeOfTheBoard) {
  const Scene scene =
      parse("", "domain: {height: 6, sides: {z: plates}}\ndroplets: [{electrode: 21, fills: 1}]\n");
  const engine::DropletPlacement& droplet = scene.droplets.at(0);
  EXPECT_TRUE(droplet.center.head<2>().isApprox(Vector2d(-23, 13), 1e-9)) << "(-5.75, 3.25) mm of 0.25 mm";
  // A disc as large as a cell of 10 x 10 r_c: within 5 %, as the pad is drawn in by 0.9 of the gap.
  EXPECT_NEAR(std::pow(engine::pancake_radius(droplet, scene.parameters), 2) * M_PI, 100, 5);
}

TEST(BoardScene, TheUnitsAreWatersAtTheLengthThatFollows) {
  const Scene scene = parse(", resolution: 10", "units: {surface_tension: 50 mN/m}\n");
  const double bead_density = scene.parameters.liquid.bulk_density,
               tension = scene.parameters.liquid.surface_tension;
  EXPECT_NEAR(scene.units.mass_kg * bead_density / std::pow(0.25e-3, 3), 1000, 1e-6);
  EXPECT_NEAR(scene.units.surface_tension_N_per_m() * tension, 0.05, 1e-12);
  EXPECT_TRUE(holds(refused("", "units: {length: 10 um}\n"),
                    "scene.yaml:2: units.length: given together with chip.file, allowed: chip.resolution"));
  EXPECT_TRUE(
      holds(refused("", "units: {preset: lan2016}\n"), "units.preset: given together with chip.file"));
}

TEST(BoardScene, ADomainMayBeGivenInPart) {
  const Scene scene = parse("", "domain: {upper: [60, 60, 12], sides: {x: periodic}}\n");
  EXPECT_TRUE(scene.parameters.domain.upper.isApprox(engine::Vector3d(60, 60, 12)));
  EXPECT_TRUE(scene.parameters.domain.lower.isApprox(engine::Vector3d(-43, -33, 0)));
  EXPECT_TRUE(scene.parameters.domain.periodic(0));
  EXPECT_TRUE(holds(refused("", "domain: {upper: [10, 60, 12]}\n"), "channel 40: x "));
  EXPECT_TRUE(parse("", "domain: {height: 5, sides: {z: plates}}\n")
                  .parameters.domain.upper.isApprox(engine::Vector3d(43, 33, 5)));
  EXPECT_TRUE(holds(refused("", "domain: {height: 5, upper: [60, 60, 12]}\n"),
                    "domain.height: given together with upper, allowed: one of both"));
}

TEST(BoardScene, AnotherResolutionIsTheSameBoard) {
  const Scene coarse = parse(", resolution: 8"), fine = parse(", resolution: 16, gap: 3.2");
  ASSERT_EQ(coarse.layout.electrodes().size(), fine.layout.electrodes().size());
  for (std::size_t i = 0; i < coarse.layout.electrodes().size(); ++i) {
    const Electrode& a = coarse.layout.electrodes()[i];
    const Electrode& b = fine.layout.electrodes()[i];
    EXPECT_LT((a.centroid * coarse.units.length_m - b.centroid * fine.units.length_m).norm(), 1e-9);
    EXPECT_EQ(a.neighbours, b.neighbours);
  }
}

TEST(BoardScene, WhatCannotBeIsRefusedWithTheLine) {
  EXPECT_TRUE(holds(refused(", resolution: 3"), "scene.yaml:1: chip.resolution: 3, allowed: [4, 100]"));
  EXPECT_TRUE(holds(refused(", resolution: 0"), "chip.resolution: 0, allowed"));
  EXPECT_TRUE(holds(refused(", resolution: nan"), "chip.resolution: nan, allowed"));
  EXPECT_TRUE(holds(refused(", grids: []"), "chip.grids: given together with file, allowed: one of both"));
  EXPECT_TRUE(holds(refused(", polygons: []"), "chip.polygons: given together with file"));
  EXPECT_TRUE(holds(refused(", file_unit: 1"), "chip.file_unit: 1, allowed: [1e-09, 1] m, with a unit"));
  EXPECT_TRUE(holds(refused(", leave_out: [99]"), "leave_out: channel 99, allowed: channels of the file"));
  EXPECT_TRUE(holds(refused(", gap: 12"), "chip.file: channel 10: too narrow to be drawn in by 5.4 r_c"));
  EXPECT_TRUE(holds(refused(", file_unit: 0.1 m"), "one r_c would be 0.025 m"));
  EXPECT_TRUE(holds(refused("", "domain: {sides: {z: closed}}\n"), "chip: electrodes without a wall"));
  EXPECT_TRUE(holds(refused("", "droplets: [{electrode: 99, radius: 5}]\n"),
                    "droplets[0].electrode: channel 99 does not exist; channels are 10-12, 20-24"));
  EXPECT_TRUE(holds(refused("", "droplets: [{electrode: 21, center: [0, 0], radius: 5}]\n"),
                    "droplets[0].electrode: given together with center"));
}

TEST(BoardScene, AFileThatIsNotThereIsAllThatIsTold) {
  const std::string text = refusal([] {
    parse_scene("chip: {file: nowhere.json}\ndroplets: [{electrode: 1, radius: 5}]\n", "scene.yaml");
  });
  EXPECT_TRUE(
      holds(text, "scene.yaml:1: chip.file: nowhere.json: there is no such file beside the scene or in"));
  EXPECT_TRUE(holds(text, "microdrop_example.svg, purpledrop_example.json"));
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  EXPECT_TRUE(
      holds(refusal([] { parse_scene("chip: {file: ../elsewhere/board.svg}\n", "scenes/scene.yaml"); }),
            "scenes/../elsewhere/board.svg: is no file"));
}

TEST(BoardScene, NoNameOfAFileIsToldOnce) {
  const auto told = [](const std::string& yaml) {
    return refusal(
        [&] { parse_scene("domain: {lower: [0, 0, 0], upper: [9, 9, 9]}\n" + yaml + "\n", "scene.yaml"); });
  };
  EXPECT_EQ(told("chip: 5"), "scene.yaml:2: chip: 5, allowed: a mapping");
  EXPECT_EQ(told("chip: {file: [a]}"), "scene.yaml:2: chip.file: a list of 1, allowed: text");
  EXPECT_EQ(told("chip: {file: ''}"),
            "scene.yaml:2: chip.file: no name, allowed: a board file (.json, .svg)");
}

TEST(BoardScene, WithoutAFileItsKeysMeanNothing) {
  EXPECT_TRUE(holds(
      refusal([] {
        parse_scene(
            "domain: {lower: [0, 0, 0], upper: [9, 9, 9]}\n"
            "chip: {gap: 1, resolution: 10, grids: [{origin: [4, 4], columns: 1, rows: 1, pitch: 4}]}\n",
            "scene.yaml");
      }),
      "chip.resolution: unknown key"));
}

TEST(BoardScene, ABoardBesideTheSceneGoesBeforeOneOfTheConfiguration) {
  const std::string folder = testing::TempDir() + "dmf_board_scene/";
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "purpledrop_example.json")
      << R"({"layout": {"grids": [{"origin": [0, 0], "pitch": 1, "pins": [[1, 2]]}]}})";
  std::ofstream(folder + "scene.yaml") << "chip: {file: purpledrop_example.json}\n";
  EXPECT_EQ(load_scene(folder + "scene.yaml").layout.electrodes().size(), 2u);
}

TEST(BoardScene, ABareBoardFileIsASceneWithoutDroplets) {
  const std::string file = DMF_SOURCE_DIR "/config/boards/microdrop_example.svg";
  const Scene scene = load_board(file, 20, "");
  EXPECT_EQ(scene.name, "microdrop_example");
  EXPECT_EQ(scene.layout.electrodes().size(), 9u);
  EXPECT_NEAR(scene.units.length_m, 1e-4, 1e-12);
  EXPECT_TRUE(holds(refusal([&] { load_board(file, 1, ""); }), "chip.resolution: 1.0, allowed: [4, 100]"));
  EXPECT_TRUE(
      holds(refusal([&] { load_board(file, 20, "1 mm"); }), "has a <scale>, and `file_unit` is given too"));
}

TEST(ShippedBoards, RunAndTheirDropletsStayOnTheirElectrodesAtRest) {
  for (const char* name : {"purpledrop_board", "microdrop_board"}) {
    const Scene scene = load_scene(name);
    ASSERT_TRUE(scene.board) << name;
    Experiment experiment(scene, {1, "auto"});
    for (int step = 0; step < 50; ++step) experiment.step();
    const auto snapshot = experiment.observe();
    ASSERT_EQ(snapshot->droplets.size(), scene.droplets.size()) << name;
    for (std::size_t i = 0; i < scene.droplets.size(); ++i) {
      const Vector2d place = snapshot->droplets[i].centroid.head<2>();
      EXPECT_LT((place - scene.droplets[i].center.head<2>()).norm(), 0.5) << name;
    }
  }
}

}  // namespace
}  // namespace dmf::chip
