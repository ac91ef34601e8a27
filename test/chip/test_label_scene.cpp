// Scenes with walls of any shape: from shapes, a raw file and pictures.
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "chip/experiment.h"
#include "chip/scene_hash.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

using engine::LabelGrid;

const char* const kBox = "domain: {lower: [0, 0, 0], upper: [8, 6, 4], sides: {x: periodic, z: closed}}\n";

Scene scene(const std::string& text) { return parse_scene(kBox + text, "label.yaml"); }
std::string refused(const std::string& text) {
  return refusal([&] { scene(text); });
}

/// A folder of its own, with a scene of that text and files beside it.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("label_scene_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
  }
  /// A grey picture, row by row from the top.
  void write_png(const std::string& name, unsigned columns, unsigned rows,
                 const std::vector<std::uint8_t>& pixels) const {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = columns;
    image.height = rows;
    image.format = PNG_FORMAT_GRAY;
    ASSERT_TRUE(png_image_write_to_file(&image, (path_ / name).c_str(), 0, pixels.data(), 0, nullptr));
  }
  Scene scene(const std::string& text) const {
    write("scene.yaml", kBox + text);
    return load_scene((path_ / "scene.yaml").string());
  }
  std::string refused(const std::string& text) const {
    return refusal([&] { scene(text); });
  }

 private:
  std::filesystem::path path_;
};

const LabelGrid& grid_of(const Scene& scene) { return *scene.parameters.label_grid.grid; }
std::uint8_t label_at(const Scene& scene, int x, int y, int z) {
  return grid_of(scene).labels[grid_of(scene).index(x, y, z)];
}

TEST(LabelScene, ShapesLabelTheVoxelsWhoseMiddleTheyHold) {
  const Scene pillars = scene(
      "label_grid:\n"
      "  voxel_size: [1, 1, 1]\n"
      "  shapes:\n"
      "    - {box: {lower: [-1, 0, 0], upper: [1, 6, 2]}, repeat: {step: [4, 0, 0], count: 2}}\n"
      "    - {ball: {center: [6.5, 2.5, 1.5], radius: 0.5}}\n"
      "    - {cylinder: {axis: y, center: [0.5, 0, 0.5], radius: 0.1}, label: fluid}\n");
  EXPECT_EQ(grid_of(pillars).voxels, (std::array<int, 3>{8, 6, 4}));
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 8; ++x) {
        // The first box reaches over the periodic side; a hole along y is cut out of it.
        const bool box = (x == 7 || x == 0 || x == 3 || x == 4) && z < 2;
        const bool ball = x == 6 && y == 2 && z == 1, hole = x == 0 && z == 0;
        EXPECT_EQ(label_at(pillars, x, y, z), (box || ball) && !hole) << x << " " << y << " " << z;
      }
  EXPECT_EQ(pillars.parameters.label_grid.contact_angle, pillars.electrowetting.rest_angle);
}

TEST(LabelScene, APrismHoldsWhatItsOutlineHoldsAlongItsAxis) {
  // A wedge along y that rises from nothing at x = 2 to 4 at x = 6, and falls off steeply to x = 7.
  const Scene wedge = scene(
      "label_grid:\n"
      "  voxel_size: [0.5, 1, 0.5]\n"
      "  shapes: [{prism: {axis: y, outline: [[2, 0], [7, 0], [6, 4]]}}]\n");
  for (int z = 0; z < 8; ++z)
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 16; ++x) {
        const double at_x = 0.5 * (x + 0.5), at_z = 0.5 * (z + 0.5);
        const double top = at_x < 6 ? at_x - 2 : 4 * (7 - at_x);
        if (std::abs(at_z - top) < 1e-9) continue;  // on the slope itself
        EXPECT_EQ(label_at(wedge, x, y, z), at_z < top) << x << " " << y << " " << z;
      }
  // Over the periodic side in x; its outline is in x and y.
  const Scene over = scene(
      "label_grid:\n"
      "  voxel_size: [1, 1, 1]\n"
      "  shapes: [{prism: {axis: z, outline: [[7, 1], [9, 1], [9, 3], [7, 3]]}}]\n");
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_EQ(label_at(over, x, y, 2), (x == 7 || x == 0) && (y == 1 || y == 2)) << x << " " << y;
  EXPECT_TRUE(holds(
      refused("label_grid: {shapes: [{prism: {axis: y, outline: [[0, 0], [4, 3], [4, 0], [0, 3]]}}]}\n"),
      "label_grid.shapes[0].prism.outline"));
}

TEST(LabelScene, WhatIsBoundLiesOutsideOfTheSolid) {
  const std::string floor =
      "label_grid: {voxel_size: [0.5, 0.5, 0.5], shapes: [{box: {lower: [0, 0, 0], upper: [8, 6, 1.5]}}]}\n";
  const std::string spring = "spring: {kind: harmonic, stiffness: 50, length: 0.5}";
  EXPECT_TRUE(holds(refused(floor + "chains: [{" + spring + ", points: [[4, 3, 1.8], [4, 3, 1.3]]}]\n"),
                    "chains[0]: points[1]: (4, 3, 1.3), in the solid of the label grid"));
  EXPECT_TRUE(holds(refused(floor + "membranes: [{center: [4, 3, 2], radius: 1, subdivisions: 1}]\n"),
                    "in the solid of the label grid, allowed: outside of it"));
  // Random walks go around it.
  Experiment experiment(scene(floor + "chains: [{" + spring + ", count: 40, beads: 8}]\n"), {1, "auto"});
  const auto snapshot = experiment.observe({true});
  ASSERT_EQ(snapshot->positions.size(), 320u);
  for (const auto& at : snapshot->positions) EXPECT_GE(at.z(), 1.5f);
}

TEST(LabelScene, EverySpeciesNeedsALawWithTheSolid) {
  const std::string two =
      "species: {oil: {attraction: -40}}\npairs: {liquid: {oil: {attraction: -30}}WALL}\n"
      "label_grid: {shapes: [{box: {lower: [0, 0, 0], upper: [8, 6, 1.5]}}]}\n";
  const auto with = [&](const std::string& wall) {
    std::string text = two;
    return text.replace(text.find("WALL"), 4, wall);
  };
  EXPECT_TRUE(holds(refused(with("")), "pairs: no law for oil and wall"));
  EXPECT_NO_THROW(scene(with(", oil: {wall: {attraction: -17}}")));
}

TEST(LabelScene, WithoutASizeVoxelsAreHalfALatticeConstantStretchedToFit) {
  const Scene slit =
      scene("label_grid: {shapes: [{box: {lower: [0, 0, 0], upper: [8, 6, 1]}}], density: 4}\n");
  EXPECT_NEAR(slit.parameters.label_grid.lattice_constant, 1, 1e-12);
  EXPECT_EQ(grid_of(slit).voxels, (std::array<int, 3>{16, 12, 8}));
}

TEST(LabelScene, ARawFileIsReadXFastest) {
  const Folder folder;
  std::string bytes(4 * 3 * 2, '\0');
  bytes[1 + 4 * (2 + 3 * 1)] = 1;
  folder.write("rock.raw", bytes);
  const Scene rock =
      folder.scene("label_grid: {raw: {file: rock.raw, voxels: [4, 3, 2]}, attraction: -12}\n");
  EXPECT_EQ(grid_of(rock).voxel_size, Eigen::Vector3d(2, 2, 2));  // over all of the domain
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 4; ++x) EXPECT_EQ(label_at(rock, x, y, z), x == 1 && y == 2 && z == 1);
  EXPECT_EQ(rock.parameters.label_grid.attraction, -12);
}

TEST(LabelScene, PicturesAreStackedAlongAnAxisTopUp) {
  const Folder folder;
  // 4 columns, 2 rows: the upper left corner is solid in one, the lower right one in the other.
  folder.write_png("a.png", 4, 2, {255, 0, 0, 0, 0, 0, 0, 0});
  folder.write_png("b.png", 4, 2, {0, 0, 0, 0, 0, 100, 0, 200});
  const Scene stack = folder.scene(
      "label_grid: {png: {files: [a.png, b.png], along: y, layers: 3}, voxel_size: [2, 1, 2]}\n");
  ASSERT_EQ(grid_of(stack).voxels, (std::array<int, 3>{4, 6, 2}));
  for (int y = 0; y < 6; ++y)
    for (int z = 0; z < 2; ++z)
      for (int x = 0; x < 4; ++x)
        EXPECT_EQ(label_at(stack, x, y, z), y < 3 ? x == 0 && z == 1 : x == 3 && z == 0);
  const Scene low = folder.scene(
      "label_grid: {png: {files: [b.png], along: z, threshold: 100}, origin: [0, 1, 1], voxel_size: [2, 2, "
      "2]}\n");
  EXPECT_EQ(label_at(low, 1, 0, 0), LabelGrid::solid);
  EXPECT_EQ(grid_of(low).origin.z(), 1);
}

TEST(LabelScene, IsBuiltAgainFromItsRecordWithoutItsFiles) {
  Scene first, second;
  {
    const Folder folder;
    folder.write_png("a.png", 4, 2, {255, 0, 0, 0, 0, 0, 0, 0});
    first = folder.scene("label_grid: {png: {files: [a.png], layers: 2}}\n");
  }
  second = rebuild_scene(first.files.all());
  EXPECT_EQ(grid_of(second).labels, grid_of(first).labels);
  EXPECT_EQ(hash_of(content_of(second)), hash_of(content_of(first)));
}

TEST(LabelScene, TheHashKnowsEveryLabel) {
  const auto hash = [](const std::string& text) { return content_of(scene(text)); };
  const std::string one =
      "label_grid: {voxel_size: [1, 1, 1], shapes: [{box: {lower: [0, 0, 0], upper: [1, 1, 1]}}]";
  const SceneContent before = hash(one + "}\n");
  EXPECT_EQ(differing_parts(before, hash(one + ", contact_angle: 140}\n")), "label_grid");
  EXPECT_EQ(
      differing_parts(before, hash("label_grid: {voxel_size: [1, 1, 1], shapes: [{box: {lower: [1, 0, 0], "
                                   "upper: [2, 1, 1]}}]}\n")),
      "label_grid");
  EXPECT_EQ(differing_parts(before, hash("")), "label_grid");
}

TEST(LabelScene, ADropletRunsOnPillars) {
  const Scene pillars = scene(
      "label_grid:\n"
      "  contact_angle: 120\n"
      "  shapes: [{box: {lower: [0, 0, 0], upper: [2, 6, 1]}, repeat: {step: [4, 0, 0], count: 2}}]\n"
      "droplets: [{center: [4, 3, 2.6], radius: 1.4}]\n"
      "observe_interval: 10\n");
  Experiment experiment(pillars, {1, "auto"});
  for (int k = 0; k < 300; ++k) experiment.step();
  EXPECT_GT(experiment.simulation().observe()->wall_beads, 200u);
}

TEST(LabelScene, WhatIsWrongIsNamedWithWhatIsAllowed) {
  const std::string box = "{box: {lower: [0, 0, 0], upper: [8, 6, 1]}}";
  EXPECT_TRUE(holds(refused("label_grid: {}\n"), "label.yaml:2: label_grid: neither raw nor png nor shapes"));
  EXPECT_TRUE(holds(refused("label_grid: {shapes: [{box: {lower: [0, 0, 0], upper: [8, 6, 4]}}]}\n"),
                    "label_grid: no fluid voxel, allowed: one or more"));
  EXPECT_TRUE(holds(refused("label_grid: {voxel_size: [1, 1, 0.1], shapes: [" + box + "]}\n"),
                    "label_grid.voxel_size[2]: 0.1, allowed: [0.2, 10] r_c"));
  EXPECT_TRUE(holds(refused("label_grid: {shapes: [" + box + "], contact_angle: 179}\n"),
                    "label_grid.contact_angle: 179 degrees, allowed"));
  EXPECT_TRUE(holds(refused("label_grid: {shapes: [" + box + "], contact_angle: 120, attraction: -9}\n"),
                    "label_grid.attraction: given together with contact_angle"));
  EXPECT_TRUE(holds(refused("label_grid: {shapes: [" + box + "], attraction: 9}\n"),
                    "label_grid.attraction: 9, allowed: -200 up to below 0"));
  EXPECT_TRUE(
      holds(refused("label_grid: {shapes: [" + box + "], origin: [0, 0, 0]}\n"), "label_grid.origin"));
  EXPECT_TRUE(holds(refused("label_grid: {shapes: [{ball: {center: [4, 30, 3], radius: 1}}]}\n"),
                    "shapes[0]: moved by (0, 0, 0) it holds the middle of no voxel"));
  EXPECT_TRUE(holds(refused("label_grid: {shapes: [{}]}\n"), "shapes[0]: 0 shapes, allowed: one of box"));
  EXPECT_TRUE(holds(refused("label_grid: {shapes: [{box: {lower: [1, 0, 0], upper: [0, 6, 1]}}]}\n"),
                    "shapes[0].box: lower is not below upper"));
  EXPECT_TRUE(
      holds(refused("label_grid: {shapes: [" + box + "]}\ndroplets: [{center: [4, 3, 2], radius: 1.5}]\n"),
            "is in the solid of the label grid"));
  EXPECT_TRUE(holds(refused("label_grid: {shape: [" + box + "]}\n"), "did you mean `shapes`"));

  const Folder folder;
  folder.write("short.raw", std::string(23, '\0'));
  folder.write("two.raw", std::string(24, '\2'));
  folder.write("no.png", "this is no picture");
  folder.write_png("a.png", 4, 2, std::vector<std::uint8_t>(8, 0));
  folder.write_png("b.png", 4, 3, std::vector<std::uint8_t>(12, 0));
  EXPECT_TRUE(
      holds(folder.refused("label_grid: {raw: {file: none.raw, voxels: [4, 3, 2]}}\n"), "is no file"));
  EXPECT_TRUE(holds(folder.refused("label_grid: {raw: {file: short.raw, voxels: [4, 3, 2]}}\n"),
                    "label_grid.raw.file: the file has 23 bytes, allowed: 4 x 3 x 2 = 24"));
  EXPECT_TRUE(holds(folder.refused("label_grid: {raw: {file: two.raw, voxels: [4, 3, 2]}}\n"),
                    "label_grid.labels: 2 for voxel 0, allowed: 0 (fluid) or 1 (solid)"));
  EXPECT_TRUE(holds(folder.refused("label_grid: {png: {files: [no.png]}}\n"), "allowed: a PNG picture"));
  EXPECT_TRUE(holds(folder.refused("label_grid: {png: {files: [a.png, b.png]}}\n"),
                    "b.png: 4 x 3 pixels, allowed: 4 x 2"));
  EXPECT_TRUE(holds(folder.refused("label_grid: {png: {files: [a.png]}, voxel_size: [2, 3, 5]}\n"),
                    "label_grid: 0 to 5 along z, allowed: in the domain, 0 to 4"));
  EXPECT_TRUE(holds(folder.refused("label_grid: {png: {files: [a.png]}, voxel_size: [1, 3, 4]}\n"),
                    "label_grid: 0 to 4 along x, allowed: all of the period, 0 to 8"));
}

}  // namespace
}  // namespace dmf::chip
