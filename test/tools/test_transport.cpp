#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "engine/parameters.h"
#include "tools/transport.h"

namespace dmf::tools {
namespace {

chip::Scene droplet_alone() { return chip::load_scene(DMF_SOURCE_DIR "/test/scenes/tiny_line.yaml"); }

chip::Scene with_microparticle() {
  chip::Scene scene = droplet_alone();
  engine::MicroparticlePlacement body;
  body.center = {-3.9, 0};
  scene.microparticles.push_back(body);
  return scene;
}

std::string fresh_folder(const std::string& name) {
  const std::string folder = testing::TempDir() + "dmf_" + name;
  std::filesystem::remove_all(folder);
  return folder;
}

/// 3 tau, a look every half tau, each of them saved.
TransportRun short_run(const std::string& folder) {
  TransportRun run;
  run.limit = 3;
  run.record_every = 0.5;
  run.folder = folder;
  run.key = "tiny R=3 seed=5";
  run.save_every = 0;
  return run;
}

struct Killed {};

/// Ends as a kill would, at the given time.
void killed_at(double time, const chip::Scene& scene, TransportRun run) {
  run.after_record = [time](const TransportRecord& record) {
    if (record.time > time - 0.01) throw Killed{};
  };
  EXPECT_THROW(run_transport(scene, 5, run), Killed);
}

void expect_same(const std::vector<TransportRecord>& a, const std::vector<TransportRecord>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    for (const auto value :
         {&TransportRecord::time, &TransportRecord::x, &TransportRecord::z, &TransportRecord::height,
          &TransportRecord::contact_fraction, &TransportRecord::normal_force, &TransportRecord::droplet_x,
          &TransportRecord::droplet_z, &TransportRecord::droplets})
      EXPECT_EQ(a[k].*value, b[k].*value) << "at " << a[k].time;
  }
}

TEST(Transport, KilledTwiceEndsWithTheBitsAndRecordsOfAnUninterruptedRun) {
  const Transport whole = run_transport(with_microparticle(), 5, short_run(fresh_folder("whole")));
  ASSERT_EQ(whole.records.size(), 6u);
  const std::string folder = fresh_folder("killed");
  const TransportRun run = short_run(folder);
  killed_at(1.0, with_microparticle(), run);
  EXPECT_TRUE(std::filesystem::exists(folder + "/tiny_R3_seed5.state"));
  EXPECT_FALSE(std::filesystem::exists(folder + "/tiny_R3_seed5.csv"));
  killed_at(2.0, with_microparticle(), run);
  EXPECT_EQ(read_records(folder + "/tiny_R3_seed5.part.csv").size(), 3u) << "the fourth look was not saved";

  const Transport resumed = run_transport(with_microparticle(), 5, run);
  EXPECT_EQ(resumed.state_hash, whole.state_hash);
  expect_same(resumed.records, whole.records);
  EXPECT_EQ(whole.earlier_computing, 0);
  EXPECT_GT(resumed.earlier_computing, 0) << "what was computed before the kills counts";
  EXPECT_FALSE(std::filesystem::exists(folder + "/tiny_R3_seed5.state"));
  EXPECT_FALSE(std::filesystem::exists(folder + "/tiny_R3_seed5.part.csv"));
}

TEST(Transport, StartsAgainWhenItsStateIsDamaged) {
  const std::string folder = fresh_folder("damaged_state");
  killed_at(1.5, with_microparticle(), short_run(folder));
  std::filesystem::resize_file(folder + "/tiny_R3_seed5.state", 1000);
  const Transport whole = run_transport(with_microparticle(), 5, short_run(fresh_folder("undamaged")));
  EXPECT_EQ(run_transport(with_microparticle(), 5, short_run(folder)).state_hash, whole.state_hash);
}

TEST(Transport, ReadsAFinishedRunAndRunsNothing) {
  const TransportRun run = short_run(fresh_folder("finished"));
  const Transport first = run_transport(with_microparticle(), 5, run),
                  second = run_transport(with_microparticle(), 5, run);
  EXPECT_TRUE(first.state_hash);
  EXPECT_FALSE(second.state_hash);
  EXPECT_TRUE(std::isnan(second.earlier_computing)) << "nobody knows any more";
  expect_same(first.records, second.records);
}

TEST(Transport, RecordsAMicroparticleAtRestOnTheWall) {
  const auto records = run_transport(with_microparticle(), 5, short_run(fresh_folder("rest"))).records;
  ASSERT_EQ(records.size(), 6u);
  for (const TransportRecord& record : records) {
    EXPECT_EQ(record.microparticle, 1);
    EXPECT_NEAR(record.x, -3.9, 0.1);
    EXPECT_NEAR(record.height, 1, 0.01);
    EXPECT_GT(record.contact_fraction, 0);
    EXPECT_GT(record.normal_force, 0);
    EXPECT_EQ(record.carrier, 0);
  }
}

TEST(Transport, EndsWhenTheDropletHasPassedBy) {
  chip::Scene scene = with_microparticle();
  scene.microparticles[0].center = {-12.5, -6};  // behind the droplet, out of its reach
  TransportRun run = short_run(fresh_folder("missed"));
  run.missed = 2;
  EXPECT_EQ(run_transport(scene, 5, run).records.size(), 1u);
}

TEST(Transport, EndsWhereItsGoalIs) {
  TransportRun run = short_run(fresh_folder("goal"));
  run.goal = -20;  // the droplet stands at -9
  EXPECT_EQ(run_transport(droplet_alone(), 5, run).records.size(), 1u);
}

TEST(Transport, CountsTimeFromTheEndOfSettling) {
  chip::Scene scene = droplet_alone();
  scene.settle_time = 1;
  TransportRun run = short_run(fresh_folder("settle"));
  run.limit = 0.5;
  const auto records = run_transport(scene, 5, run).records;
  EXPECT_DOUBLE_EQ(records.front().time, -0.5);
  EXPECT_DOUBLE_EQ(records.back().time, 0.5);
}

TEST(Transport, RefusesAFileThatIsNoRecord) {
  const std::string folder = fresh_folder("other");
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/other.csv") << "run,something\n";
  EXPECT_THROW(read_records(folder + "/other.csv"), std::runtime_error);
}

}  // namespace
}  // namespace dmf::tools
