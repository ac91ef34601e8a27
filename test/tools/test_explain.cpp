#include <gtest/gtest.h>

#include <cmath>

#include "engine/droplet.h"
#include "tools/explain.h"

namespace dmf::tools {
namespace {

const char* const kBoard = DMF_SOURCE_DIR "/config/boards/purpledrop_example.json";

const Likeness& of(const std::vector<Likeness>& numbers, const std::string& name) {
  for (const Likeness& number : numbers)
    if (number.name.rfind(name, 0) == 0) return number;
  throw std::out_of_range(name);
}

::testing::AssertionResult has(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "`" << part << "` is not in:\n" << text;
}

// A droplet of radius 5 r_c = 50 um: with the liquid's 6.06, 7.54 and 8.2 in reduced units, and water's 998.2
// kg/m^3, 0.0728 N/m and 1.002 mPa s. With 1000 kg/m^3 and 0.072 N/m the bead is
// 1e-12 / 6.06 kg, tau 4.1571 us and 1 r_c/tau 2.4055 m/s.
TEST(Likeness, NumbersAreThoseOfTheirDefinitions) {
  const auto numbers = likeness(chip::load_scene("electrode_line"), 5, 0.05);
  EXPECT_NEAR(of(numbers, "Ohnesorge").simulated, 8.2 / std::sqrt(6.06 * 7.54 * 5), 1e-9);
  EXPECT_NEAR(of(numbers, "Ohnesorge").water, 0.01662, 1e-5);
  EXPECT_NEAR(of(numbers, "capillary").simulated, 8.2 * 0.05 / 7.54, 1e-9);
  EXPECT_NEAR(of(numbers, "capillary").water, 1.002e-3 * 0.120276 / 0.0728, 1e-7);
  EXPECT_NEAR(of(numbers, "Reynolds").simulated, 6.06 * 0.05 * 5 / 8.2, 1e-9);
  EXPECT_NEAR(of(numbers, "Reynolds").water, 998.2 * 0.120276 * 50e-6 / 1.002e-3, 1e-3);
  EXPECT_NEAR(of(numbers, "Bond").water, 998.2 * 9.81 * 2.5e-9 / 0.0728, 1e-8);
  EXPECT_EQ(of(numbers, "Bond").simulated, 0) << "the scene has no gravity";
}

TEST(Likeness, CapillaryIsOhnesorgeSquaredTimesReynolds) {
  const auto numbers = likeness(chip::load_board(kBoard, 14, ""), 7, 0.2);
  const auto &oh = of(numbers, "Ohnesorge"), &ca = of(numbers, "capillary"), &re = of(numbers, "Reynolds");
  EXPECT_NEAR(ca.simulated, oh.simulated * oh.simulated * re.simulated, 1e-12);
  EXPECT_NEAR(ca.water, oh.water * oh.water * re.water, 1e-12);
}

TEST(Likeness, GravityOfTheSceneCounts) {
  chip::Scene scene = chip::load_board(kBoard, 10, "");
  scene.body_forces.gravity = {0, 0, -9.81 / scene.units.acceleration_m_per_s2()};
  const auto bond = of(likeness(scene, 5, 0.05), "Bond");
  EXPECT_NEAR(bond.simulated, 1000 * 9.81 * 1.25e-3 * 1.25e-3 / 0.072, 1e-6)
      << "the scene's own density and tension";
  EXPECT_EQ(bond.therefore, "") << "as water's within 2 %";
}

TEST(Likeness, BetweenPlatesGravityActsOnTheLiquidsHeight) {
  const chip::Scene scene = chip::parse_scene(
      "chip: {file: purpledrop_example.json}\ndomain: {height: 6, sides: {z: plates}}\n", "scene.yaml");
  const double half = 0.5 * engine::liquid_height(scene.parameters) * 0.25e-3;
  EXPECT_LT(half, 0.75e-3) << "a little less than half of 6 r_c";
  EXPECT_NEAR(of(likeness(scene, 5, 0.05), "Bond").water, 998.2 * 9.81 * half * half / 0.0728, 1e-12);
  const std::string text = explain(scene);
  const int beads = static_cast<int>(std::lround(100 * engine::liquid_height(scene.parameters) * 6.06));
  EXPECT_TRUE(has(text, "one electrode is filled by " + std::to_string(beads) + " beads"));
}

TEST(Likeness, SaysWhatNotToTrustOnlyWhereItMatters) {
  const auto millimetres = likeness(chip::load_board(kBoard, 10, ""), 5, 0.05);
  for (const char* name : {"Ohnesorge", "capillary", "Bond", "Reynolds", "thermal"})
    EXPECT_NE(of(millimetres, name).therefore, "") << name;
  const auto micrometres = likeness(chip::load_scene("electrode_line"), 5, 0.05);
  EXPECT_EQ(of(micrometres, "Bond").therefore, "") << "3e-4: water would not feel its weight either";
  EXPECT_NE(of(micrometres, "Ohnesorge").therefore, "");
}

TEST(Explain, ABoardFileTellsElectrodesPitchBeadsAndUnits) {
  const std::string text = explain(chip::load_board(kBoard, 10, ""));
  EXPECT_TRUE(has(text, "electrodes   15: channels 10-12, 20-24, 30-32, 40-41, 50-51"));
  EXPECT_TRUE(has(text, "pitch        10 r_c = 2.5 mm, gap 2 r_c = 0.5 mm"));
  // pi/6 10^3 r_c^3 of 6.06 beads; pi/6 2.5^3 mm^3.
  EXPECT_TRUE(has(text, "one electrode is filled by 3173 beads, 8.18 ul"));
  EXPECT_TRUE(has(text, "one r_c      250 um"));
  EXPECT_TRUE(has(text, "a droplet that fills one electrode"));
  EXPECT_TRUE(has(text, "what not to trust:"));
  EXPECT_TRUE(has(explain(chip::load_board(kBoard, 20, "")), "one electrode is filled by 25384 beads"));
}

TEST(Explain, ThePitchOfASceneOfItsOwnIsThatOfItsGrid) {
  EXPECT_NEAR(pitch_of(chip::load_scene("electrode_array")).value(), 10, 1e-9);
  EXPECT_FALSE(pitch_of(chip::load_scene("sessile")));
}

}  // namespace
}  // namespace dmf::tools
