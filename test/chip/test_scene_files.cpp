#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "chip/experiment.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

namespace fs = std::filesystem;

std::uint64_t hash_after(const Scene& scene, int steps) {
  Experiment experiment(scene, {1, "auto"});
  experiment.apply(SetHv{20, 1000, true});
  experiment.apply(SetElectrodes{{scene.layout.electrodes()[1].channel}});
  for (int i = 0; i < steps; ++i) experiment.step();
  engine::ObserveRequest request;
  request.hash = true;
  return experiment.observe(request)->state_hash.value();
}

/// A folder with a scene that refers to a board and two calibrations of its own.
class SceneFilesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "parts");
    fs::copy_file(DMF_SOURCE_DIR "/config/boards/purpledrop_example.json", folder_ / "parts" / "board.json");
    for (const std::string name : {"water_like", "microparticle"})
      fs::copy_file(std::string(DMF_SOURCE_DIR "/config/calibration/") + name + ".yaml",
                    folder_ / "parts" / (name + ".yaml"));
    const std::string parts = (folder_ / "parts").string();
    std::ofstream(folder_ / "own.yaml")
        << "chip: {file: parts/board.json, resolution: 6}\n"
        << "wettability: {calibration: " << parts << "/water_like.yaml, rest_angle: 120}\n"
        << "microparticle_model: {calibration: " << parts << "/microparticle.yaml}\n"
        << "droplets: [{center: [0, 0], radius: 3}]\n"
        << "microparticles: [{center: [8, 0], radius: 1, contact_angle: 95}]\n";
  }
  void TearDown() override { fs::remove_all(folder_); }

  const fs::path folder_ = fs::temp_directory_path() / ("dmf_scene_files_" + std::to_string(::getpid()));
};

TEST_F(SceneFilesTest, AreAllThatAScenesRunDependsOn) {
  const Scene scene = load_scene((folder_ / "own.yaml").string());
  ASSERT_EQ(scene.files.all().size(), 4u);
  const std::uint64_t hash = hash_after(scene, 20);
  fs::remove_all(folder_);
  ::setenv("DMF_SIM_CONFIG", "/nonexistent", 1);
  const Scene again = rebuild_scene(scene.files.all());
  EXPECT_EQ(again.name, "own");
  EXPECT_EQ(hash_after(again, 20), hash);
  Experiment experiment(again, {1, "auto"});
  AddMicroparticle command;
  command.x = -8 * again.units.length_m;
  command.radius = 1 * again.units.length_m;
  command.contact_angle_deg = 80;
  EXPECT_TRUE(experiment.apply(command).success) << experiment.apply(command).message;
  ::unsetenv("DMF_SIM_CONFIG");
}

TEST_F(SceneFilesTest, AreTakenAsTheyWereNotAsTheyAreNow) {
  const Scene scene = load_scene((folder_ / "own.yaml").string());
  const std::uint64_t hash = hash_after(scene, 5);
  std::ofstream(folder_ / "parts" / "water_like.yaml") << "garbage";
  EXPECT_EQ(hash_after(scene, 5), hash);
  EXPECT_EQ(hash_after(rebuild_scene(scene.files.all()), 5), hash);
}

TEST_F(SceneFilesTest, OneThatIsMissingIsNamed) {
  const Scene scene = load_scene((folder_ / "own.yaml").string());
  for (const SceneFile& left_out : scene.files.all()) {
    std::vector<SceneFile> rest;
    for (const SceneFile& file : scene.files.all())
      if (file.role != left_out.role) rest.push_back(file);
    EXPECT_NE(refusal([&] { rebuild_scene(rest); }).find(left_out.role), std::string::npos) << left_out.role;
  }
}

TEST(SceneFiles, OfEveryShippedSceneBuildItAgain) {
  for (const auto& entry : fs::directory_iterator(DMF_SOURCE_DIR "/config/scenes")) {
    const Scene scene = load_scene(entry.path().string());
    const Scene again = rebuild_scene(scene.files.all());
    EXPECT_EQ(again.name, scene.name);
    EXPECT_EQ(again.layout.electrodes().size(), scene.layout.electrodes().size()) << scene.name;
    EXPECT_EQ(again.units.length_m, scene.units.length_m) << scene.name;
    EXPECT_EQ(again.droplets.size(), scene.droplets.size()) << scene.name;
    EXPECT_EQ(load_curve(again).points().size(), load_curve(scene).points().size()) << scene.name;
  }
}

}  // namespace
}  // namespace dmf::chip
