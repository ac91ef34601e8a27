#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "refusal.h"
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

std::string contents(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(HeadlessRun, ResumedTablesAreThoseOfAnUninterruptedRun) {
  RunOptions whole = tiny(300);
  whole.output = fresh_folder("whole");
  headless_run(whole);
  // It got to step 230, and saved step 200 last; the last line was cut off. 230 is no look of a longer run.
  RunOptions killed = tiny(230);
  killed.output = fresh_folder("killed");
  killed.checkpoint_every = 100;
  headless_run(killed);
  const std::string table = killed.output + "/droplets.csv";
  ASSERT_NE(contents(table).find("\n230,"), std::string::npos);
  std::filesystem::resize_file(table, std::filesystem::file_size(table) - 5);
  RunOptions resumed = tiny(300, 2);
  resumed.output = resumed.resume = killed.output;
  headless_run(resumed);
  EXPECT_EQ(contents(table), contents(whole.output + "/droplets.csv"));
}

TEST(HeadlessRun, WritesALineALookAndChainAndMembrane) {
  RunOptions options = tiny(100);
  options.output = fresh_folder("bonded");
  std::filesystem::create_directories(options.output);
  options.scene = options.output + "/bonded.yaml";
  std::ofstream(options.scene)
      << "domain: {lower: [0, 0, 0], upper: [12, 12, 12], sides: {x: periodic, y: periodic, z: periodic}}\n"
         "droplets: [{center: [6, 6, 6], radius: 3}]\n"
         "chains: [{spring: {kind: harmonic, stiffness: 50, length: 0.5}, count: 2, beads: 4}]\n"
         "membranes: [{center: [6, 6, 6], radius: 2, subdivisions: 1}]\n";
  headless_run(options);
  for (const auto& [name, a_look] : {std::pair{"chains.csv", 2}, {"membranes.csv", 1}}) {
    const std::string table = contents(options.output + "/" + name);
    const auto lines = std::count(table.begin(), table.end(), '\n');
    const std::string head = table.substr(0, table.find('\n'));
    EXPECT_EQ((lines - 1) % a_look, 0) << name;
    EXPECT_GE(lines, 1 + 2 * a_look) << name;
    const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
    EXPECT_EQ(commas(table.substr(table.rfind('\n', table.size() - 2))), commas(head)) << name;
    EXPECT_NE(table.find("\n100,"), std::string::npos) << name;
  }
}

TEST(HeadlessRun, ACheckpointBetweenTwoLooksLeavesNoLineOfItsOwn) {
  RunOptions whole = tiny(150);
  whole.output = fresh_folder("looks");
  headless_run(whole);
  RunOptions first = tiny(70);
  first.output = fresh_folder("between");
  first.checkpoint_every = 70;
  headless_run(first);
  RunOptions second = tiny(150);
  second.output = second.resume = first.output;
  headless_run(second);
  EXPECT_EQ(contents(first.output + "/droplets.csv"), contents(whole.output + "/droplets.csv"));
}

TEST(HeadlessRun, KeepsTheLastCheckpointsAndNeverOverwritesARunThatCanBeResumed) {
  RunOptions options = tiny(100);
  options.output = fresh_folder("keep");
  options.checkpoint_every = 20;
  options.checkpoint_keep = 2;
  headless_run(options);
  EXPECT_FALSE(std::filesystem::exists(options.output + "/step_000000000060.checkpoint"));
  EXPECT_TRUE(std::filesystem::exists(options.output + "/step_000000000080.checkpoint"));
  EXPECT_TRUE(std::filesystem::exists(options.output + "/step_000000000100.checkpoint"));
  const std::string before = contents(options.output + "/droplets.csv");
  const std::string why = refusal([&] { headless_run(options); });
  EXPECT_TRUE(holds(why, "up to step 100, allowed: --resume " + options.output));
  EXPECT_EQ(contents(options.output + "/droplets.csv"), before);
}

TEST(HeadlessRun, ResumesNoRunOfAnotherSeed) {
  RunOptions options = tiny(100);
  options.resume = checkpoints_of(50, "seed");
  options.seed = 99;
  EXPECT_TRUE(holds(refusal([&] { headless_run(options); }), "--resume"));
  options.seed = 7;  // the scene's
  EXPECT_EQ(headless_run(options).hash, headless_run(tiny(100)).hash);
}

TEST(HeadlessRun, ADiskThatRefusesCheckpointsEndsNeitherTheRunNorItsTables) {
  RunOptions options = tiny(100);
  options.output = fresh_folder("full");
  options.checkpoint_every = 20;
  // No file may be longer than this: a checkpoint fails half way, as on a full disk.
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  struct rlimit small = before;
  small.rlim_cur = 1 << 15;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  testing::internal::CaptureStderr();
  const std::uint64_t hash = headless_run(options).hash;
  const std::string told = testing::internal::GetCapturedStderr();
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(hash, headless_run(tiny(100)).hash);
  EXPECT_TRUE(holds(told, "step 20: no checkpoint, the run goes on: can't write"));
  EXPECT_EQ(told.find("no checkpoint"), told.rfind("no checkpoint")) << "told once: " << told;
  EXPECT_NE(contents(options.output + "/droplets.csv").find("\n100,"), std::string::npos);
  for (const auto& file : std::filesystem::directory_iterator(options.output))
    EXPECT_EQ(file.path().filename().string().find("step_0"), std::string::npos) << file.path();
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
  ASSERT_GT(result.beads, 0u);
  const double bead_steps = 20.0 * static_cast<double>(result.beads);  // fewer than between two looks
  EXPECT_NEAR(json["ns_per_bead_step"].get<double>() * bead_steps / (result.wall_s * 1e9), 1, 1e-9);
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
