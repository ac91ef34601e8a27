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
domain: {lower: [-20, -8, 0], upper: [20, 8, 10]}
wettability: {calibration: lan2016, rest_angle: 110}
chip:
  gap: 2
  grids: [{origin: [-12, 0], columns: 3, rows: 1, pitch: 12}]
  electrowetting: {reference_voltage: 63, reference_angle: 60, saturation_angle: 55, max_voltage: 80}
droplets: [{center: [-12, 0], radius: 2}]
schedule: [{at: 1, set_hv: {voltage: 20}}]
)";

Scene changed(const std::string& from = "", const std::string& to = "") {
  std::string text = kScene;
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return parse_scene(text, "scene.yaml");
}

TEST(SceneContent, IsTheSameHoweverTheSceneIsWritten) {
  const SceneContent original = content_of(changed());
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"domain:", "# a comment\ndomain:"},
           {"domain:", "description: other words\nduration: 7\nseed: 4\ndomain:"},
           {"gap: 2", "gap: 2.0"},
           {"{center: [-12, 0], radius: 2}", "{radius: 2, center: [-12.0, 0.0]}"}}) {
    EXPECT_EQ(differing_parts(content_of(changed(from, to)), original), "") << to;
    EXPECT_EQ(hash_of(content_of(changed(from, to))), hash_of(original)) << to;
  }
}

TEST(SceneContent, NamesThePartThatDiffers) {
  const SceneContent original = content_of(changed());
  for (const auto& [from, to, part] : std::vector<std::array<std::string, 3>>{
           {"radius: 2", "radius: 2.001", "droplets"},
           {"pitch: 12", "pitch: 12.5", "chip"},
           {"columns: 3", "columns: 2", "chip"},
           {"at: 1", "at: 1.01", "schedule"},
           {"voltage: 20", "voltage: 21", "schedule"},
           {"calibration: lan2016, ", "", "wettability"},
           {"max_voltage: 80", "max_voltage: 81", "electrowetting"},
           {"domain:", "time_step: 0.005\ndomain:", "engine"},
           {"domain:", "liquid: {repulsion: 26}\ndomain:", "liquid"},
           {"domain:", "microparticle_model: {contact: coulomb}\ndomain:", "microparticle_model"},
           {"domain:", "settle_time: 1\ndomain:", "settle_time"},
           {"domain:", "patterns: {walk: [{at: 0, set_hv: {voltage: 1}}]}\ndomain:", "patterns"},
           {"domain:", "body_forces: {gravity: [0, 0, -1e-5]}\ndomain:", "body_forces"},
           {"upper: [20,", "upper: [21,", "domain"}}) {
    const SceneContent other = content_of(changed(from, to));
    EXPECT_EQ(differing_parts(other, original), part) << to;
    EXPECT_NE(hash_of(other), hash_of(original)) << to;
  }
}

TEST(SavedRun, OfASceneOfTheSameNameWithOtherContentIsRefusedByWhatDiffers) {
  const std::string saved = Experiment(changed(), {1, "auto"}).save();
  Experiment other(changed("radius: 2", "radius: 2.5"), {1, "auto"});
  const std::string before = other.save();
  EXPECT_TRUE(
      holds(refusal([&] { other.load(saved); }), "of a scene scene that differs in droplets, allowed:"));
  EXPECT_TRUE(other.save() == before);
  Experiment same(changed("domain:", "# a comment\ndomain:"), {1, "auto"});
  EXPECT_NO_THROW(same.load(saved));
}

}  // namespace
}  // namespace dmf::chip
