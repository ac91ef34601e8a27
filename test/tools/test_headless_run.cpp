#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tools/explain.h"
#include "tools/headless_run.h"

namespace dmf::tools {
namespace {

RunOptions tiny(std::uint64_t steps, int threads = 1) {
  RunOptions options;
  options.scene = DMF_SOURCE_DIR "/test/scenes/tiny_line.yaml";
  options.steps = steps;
  options.threads = threads;
  options.quiet = true;
  return options;
}

std::string fresh_folder(const std::string& name) {
  const std::string folder = testing::TempDir() + "dmf_" + name;
  std::filesystem::remove_all(folder);
  return folder;
}

/// A folder with checkpoints of a run of so many steps, one every 50.
std::string checkpoints_of(std::uint64_t steps, const std::string& name) {
  RunOptions options = tiny(steps);
  options.output = fresh_folder(name);
  options.checkpoint_every = 50;
  headless_run(options);
  return options.output;
}

TEST(HeadlessRun, ResumedEndsWithTheHashOfAnUninterruptedRun) {
  RunOptions second = tiny(300, 2);
  second.resume = checkpoints_of(130, "resume");
  EXPECT_EQ(headless_run(second).hash, headless_run(tiny(300)).hash);
}

TEST(HeadlessRun, ResumePassesOverADamagedCheckpoint) {
  const std::string folder = checkpoints_of(100, "damaged");
  std::filesystem::resize_file(folder + "/step_000000000100.checkpoint", 1000);
  RunOptions second = tiny(200);
  second.resume = folder;
  EXPECT_EQ(headless_run(second).hash, headless_run(tiny(200)).hash);
  std::filesystem::resize_file(folder + "/step_000000000050.checkpoint", 1000);
  EXPECT_THROW(headless_run(second), engine::InvalidInput);
}

TEST(HeadlessRun, LogsMicroparticlesWhereThereAreAny) {
  RunOptions with = tiny(100), without = tiny(100);
  with.scene = "delivery_line";
  with.output = fresh_folder("with");
  without.output = fresh_folder("without");
  headless_run(with);
  headless_run(without);
  EXPECT_FALSE(std::filesystem::exists(without.output + "/microparticles.csv"));
  std::ifstream log(with.output + "/microparticles.csv");
  std::string head, first, second, more;
  ASSERT_TRUE(std::getline(log, head) && std::getline(log, first) && std::getline(log, second));
  EXPECT_EQ(std::count(head.begin(), head.end(), ','), std::count(first.begin(), first.end(), ','));
  EXPECT_EQ(first.rfind("50,0.5,", 0), 0u) << first;
  EXPECT_EQ(second.substr(second.rfind(',')), ",dry");
  EXPECT_FALSE(std::getline(log, more)) << "one line a look";
}

TEST(HeadlessRun, JsonHasTheKeysThatScriptsRelyOn) {
  const RunResult result = headless_run(tiny(20));
  const nlohmann::json json = nlohmann::json::parse(to_json(result));
  for (const char* key : {"scene", "beads", "steps", "wall_s", "ns_per_bead_step", "temperature", "hash"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["steps"], 20);
  EXPECT_EQ(json["beads"], result.beads);
  EXPECT_GT(result.beads, 0u);
}

TEST(HeadlessRun, WritesALineADropletAndLook) {
  RunOptions options = tiny(60);
  options.output = fresh_folder("log");
  headless_run(options);
  std::ifstream file(options.output + "/droplets.csv");
  std::string line;
  std::size_t lines = 0;
  while (std::getline(file, line)) ++lines;
  EXPECT_GT(lines, 1u);
}

TEST(Explain, NamesUnitsBeadsAndNumbersBesideWaters) {
  const std::string text = explain(chip::load_scene("gradient_R5"));
  for (const char* part :
       {"moving beads", "one r_c", "one tau", "Ohnesorge", "capillary", "Reynolds", "Bond"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

}  // namespace
}  // namespace dmf::tools
