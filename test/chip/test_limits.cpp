#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "chip/command_rules.h"
#include "chip/experiment.h"
#include "engine/memory.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

const char* const kChip = R"(
domain: {lower: [-20, -10, 0], upper: [20, 10, 20]}
wettability: {calibration: lan2016, rest_angle: 110}
chip:
  gap: 2
  grids: [{origin: [-12, 0], columns: 3, rows: 1, pitch: 12}]
  electrowetting: {reference_angle: 60, saturation_angle: 55}
)";

Scene parse(const std::string& more) { return parse_scene(kChip + more, "scene.yaml"); }

/// So many times a text, between brackets.
std::string list_of(const std::string& text, int count) {
  std::string list = "[" + text;
  for (int k = 1; k < count; ++k) list += ", " + text;
  return list + "]";
}

TEST(Limits, ASceneMayAskForNoMoreThanItsMemory) {
  EXPECT_TRUE(
      holds(refusal([] { parse_scene("domain: {lower: [0, 0, 0], upper: [4000, 4000, 62.5]}", "s"); }),
            "domain: 4000 x 4000 x 62.5 r_c"));
  EXPECT_TRUE(holds(refusal([] { parse("max_memory: 1"); }), "max_memory: 1, allowed: 10 to 1000000 (MB)"));
  const Scene scene = parse("max_memory: 12\ndroplets: [{center: [0, 0], radius: 9}]");
  EXPECT_TRUE(holds(refusal([&] { Experiment(scene, {1, "auto"}); }), "max_memory 12 MB"));
}

TEST(Limits, NumbersBeyondAllMeasureAreRefusedAndNotTried) {
  EXPECT_TRUE(holds(refusal([] { parse("droplets: [{center: [0, 0], radius: 1e9}]"); }),
                    "radius 1e+07 mm (1e+09 r_c): allowed up to"));
  EXPECT_TRUE(holds(refusal([] {
                      parse_scene(
                          "domain: {lower: [-20, -10, 0], upper: [20, 10, 5], sides: {z: plates}}\n"
                          "chip: {gap: 2, grids: [{origin: [0, 0], columns: 1, rows: 1, pitch: 12}]}\n"
                          "droplets: [{electrode: 0, fills: 1e9}]",
                          "s");
                    }),
                    "allowed up to"));
  EXPECT_TRUE(holds(refusal([] {
                      parse_scene(
                          "domain: {lower: [0, 0, 0], upper: [20, 20, 20]}\n"
                          "chip: {gap: 1, grids: [{origin: [0, 0], columns: 1000, rows: 1000, pitch: 2}]}",
                          "s");
                    }),
                    "1000 x 1000 = 1000000 electrodes, allowed: up to 10000"));
  EXPECT_TRUE(holds(refusal([] { parse("schedule: " + list_of("{at: 0, halt: {}}", 10'001)); }),
                    "allowed: a list of 0 to 10000 mappings"));
  EXPECT_TRUE(holds(refusal([] { parse("droplets: " + list_of("{center: [0, 0], radius: 1}", 10'001)); }),
                    "allowed: a list of 0 to 10000 mappings"));
}

TEST(Limits, ALongCommandIsRefusedWithAShortSentence) {
  const Scene scene = parse("");
  const engine::ContactAngleCurve curve = load_curve(scene);
  const std::vector<Command> long_ones{
      SetElectrodes{std::vector<std::uint32_t>(1'000'000, 7)},
      SetDisabledChannels{std::vector<std::uint32_t>(1'000'000, 1)},
      SetElectrodeVoltages{{1}, std::vector<double>(1'000'000, -1)},
      SetWettability{std::vector<double>(1'000'000, 0), std::vector<double>(1'000'000, 500)},
      LoadPattern{std::string(1'000'000, 'x')},
      InjectFault{std::string(1'000'000, 'x')},
      [] {
        AddMicroparticle body;
        body.radius = 1e-5;
        body.points.assign(1'000'000, Eigen::Vector3d::Constant(NAN));
        return body;
      }()};
  for (const Command& command : long_ones) {
    std::string said;
    for (const std::string& violation : violations(command, scene, curve)) said += violation;
    EXPECT_FALSE(said.empty()) << name_of(command);
    EXPECT_LT(said.size(), 2000u) << name_of(command);
  }
}

TEST(Limits, WhatIsEchoedIsNotCutWithinACharacter) {
  const Scene scene = parse("");
  std::string name;
  while (name.size() < 150) name += "\xc3\xa4";  // two bytes each, so that one of both cuts would split one
  for (const std::string shift : {"", "x"}) {
    const std::string said = violations(LoadPattern{shift + name}, scene, load_curve(scene)).at(0);
    // JSON text must be UTF-8: the writer of events and commands refuses anything else.
    EXPECT_EQ(to_json(LoadPattern{said}).find("\xef\xbf\xbd"), std::string::npos) << said;
  }
}

TEST(Limits, DispensingEndsWhereTheMemoryDoes) {
  const Scene scene = parse("max_memory: 11");
  Experiment experiment(scene, {1, "auto"});
  const std::uint64_t most = engine::most_moving_beads(scene.parameters, 0);
  Reply reply;
  int dispensed = 0;
  for (double y = -8; y < 9; y += 5)
    for (double x = -18; x < 19; x += 5) {
      const double length = scene.units.length_m;
      reply = experiment.apply(DispenseDroplet{x * length, y * length, 30 * scene.units.volume_m3()});
      if (!reply.success) break;
      ++dispensed;
    }
  EXPECT_GT(dispensed, 3);
  EXPECT_TRUE(holds(reply.message, "allowed: " + std::to_string(most) + " moving beads"));
  EXPECT_LE(experiment.observe()->moving_beads, most);
  EXPECT_NO_THROW(experiment.step());
}

// The first look is the worst: the lattice on which droplets are placed has just dissolved.
TEST(ShippedScenes, DoNotTripTheWatchdog) {
  for (const auto& entry : std::filesystem::directory_iterator(DMF_SOURCE_DIR "/config/scenes")) {
    const Scene scene = load_scene(entry.path().string());
    Experiment experiment(scene, {1, "auto"});
    EXPECT_NO_THROW(while (experiment.steps() < scene.parameters.observe_interval) experiment.step())
        << scene.name;
  }
}

}  // namespace
}  // namespace dmf::chip
