#include "tools/study.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>

#include "engine/simulation.h"
#include "tools/cases.h"
#include "tools/saved_run.h"

namespace dmf::tools {
namespace {

TEST(Study, KeyNamesOnlyWhatIsNotTheDefault) {
  StudyOptions options;
  EXPECT_EQ(options_key(options), "");
  options.contact = engine::ContactModel::coulomb;
  options.calibration = "lan2016";
  options.time_step = 0.005;
  EXPECT_EQ(options_key(options), " dt=0.005 calibration=lan2016 coulomb");
  EXPECT_EQ(file_name("friction f=0.4/0.2" + options_key(options) + " seed=1"),
            "friction_f0.4_0.2_dt0.005_calibrationlan2016_coulomb_seed1");
}

TEST(Study, SceneTakesOverTheCommandLine) {
  StudyOptions options;
  options.contact = engine::ContactModel::coulomb;
  options.calibration = "lan2016";
  options.time_step = 0.005;
  const chip::Scene scene = scene_for(options, "pickup");
  EXPECT_EQ(scene.parameters.microparticles.contact, engine::ContactModel::coulomb);
  EXPECT_TRUE(scene.calibration_file.empty()) << "Lan's own law";
  EXPECT_EQ(scene.parameters.time_step, 0.005);
  EXPECT_EQ(scene.parameters.list_skin, 0.45) << "the scene's own";
}

TEST(Study, OnlyPicksValuesAndRefusesOthers) {
  StudyOptions options;
  EXPECT_TRUE(is_wanted(options, "5"));
  options.only = {"6", "7"};
  EXPECT_FALSE(is_wanted(options, "5"));
  EXPECT_TRUE(is_wanted(options, "7"));
  EXPECT_TRUE(is_wanted(options, "R=7")) << "by its value";
  EXPECT_FALSE(is_wanted(options, "R=17"));
  EXPECT_NO_THROW(require_known(options, {"5", "6", "R=7"}));
  EXPECT_THROW(require_known(options, {"5", "6"}), std::runtime_error);
}

/// A folder of its own that starts empty.
StudyOptions in_empty_folder(const std::string& name) {
  StudyOptions options;
  options.output = testing::TempDir() + "dmf_study_" + name;
  std::filesystem::remove_all(options.output);
  return options;
}

TEST(Cases, EveryRunIsDoneOnceWhateverStoppedTheStudy) {
  StudyOptions options = in_empty_folder("once");
  options.jobs = 2;
  std::atomic<int> runs{0};
  const auto tens = [&](int ten) {
    return Case{"R=" + std::to_string(ten), [&runs, ten](std::uint64_t seed) {
                  ++runs;
                  if (ten == 6 && seed == 3 && runs < 7) throw std::runtime_error("killed");
                  return std::vector<double>{10.0 * ten + static_cast<double>(seed), 0};
                }};
  };
  const auto study = [&] { return run_cases("tens", {"value", "zero"}, {tens(5), tens(6)}, options); };
  EXPECT_THROW(study(), std::runtime_error) << "what a run throws is told";
  const int before = runs;
  EXPECT_LE(before, 6);
  const Results results = study();
  EXPECT_EQ(results.of("R=5", "value"), (std::vector<double>{51, 52, 53}));
  EXPECT_EQ(results.of("R=6", "value"), (std::vector<double>{61, 62, 63}));
  EXPECT_EQ(runs - before, 7 - before) << "the killed one again, all others once";
  study();
  EXPECT_EQ(runs, 7);
  EXPECT_EQ(results.mean("R=6", "value").mean, 62);
  EXPECT_EQ(results.finding("R=6", "value", "", 0).engine, std::vector<std::string>{engine_commit()});
  EXPECT_GE(results.finding("R=6", "value", "", 0).computing, 0);
}

TEST(Cases, RecordedRunsNothingAndLeavesNothing) {
  StudyOptions options = in_empty_folder("recorded");
  options.recorded = true;
  const auto results = run_cases("none", {"value"},
                                 {{"R=5",
                                   [](std::uint64_t) -> std::vector<double> {
                                     ADD_FAILURE() << "was run";
                                     return {1};
                                   }}},
                                 options);
  EXPECT_TRUE(results.of("R=5", "value").empty());
  EXPECT_FALSE(std::filesystem::exists(options.output));
}

TEST(Cases, AnUnstableRunLeavesARowOfNothing) {
  const StudyOptions options = in_empty_folder("unstable");
  const Results results = run_cases(
      "unstable", {"a", "b"},
      {{"", [](std::uint64_t) -> std::vector<double> { throw engine::Instability("bead 7 moves too far"); }}},
      options);
  EXPECT_EQ(results.finding("", "b", "", 0).ours(), "never");
  EXPECT_EQ(results.of("", "b").size(), 3u);
}

TEST(ResultTable, ReadsFilesWithoutTimesAndCutLines) {
  const std::string file = in_empty_folder("table").output + "/old_runs.csv";
  replace_file(file, "run,a,b\nR=5 seed=1,1,2\nR=5 seed=10,3,4\nR=5 seed=2,5,6\nR=6 seed=1,7");
  ResultTable table(file, {"a", "b"});
  EXPECT_EQ(table.seeds_of("R=5"), (std::vector<int>{1, 2, 10})) << "as numbers";
  EXPECT_FALSE(table.has("R=6 seed=1")) << "its line was cut";
  EXPECT_TRUE(std::isnan(table.row("R=5 seed=1").computing));
  ResultRow row({7, 8});
  row.computing = 12.5;
  row.engine = "abc1234";
  table.add("R=6 seed=1", row);
  const ResultTable again(file, {"a", "b"});
  EXPECT_EQ(again.row("R=5 seed=10").values, (std::vector<double>{3, 4}));
  EXPECT_EQ(again.row("R=6 seed=1").computing, 12.5);
  EXPECT_EQ(again.row("R=6 seed=1").engine, "abc1234");
  EXPECT_THROW(ResultTable(file, {"a"}), std::runtime_error) << "other columns";
}

TEST(Study, EveryTransportStudyHasAScene) {
  const std::vector<Study> studies = transport_studies();
  EXPECT_EQ(studies.size(), 11u);
  for (const Study& study : studies) {
    chip::Scene scene = scene_for({}, study.name);
    ASSERT_FALSE(scene.microparticles.empty()) << study.name;
    shorten_the_approach(scene);
    const engine::DropletPlacement& droplet = scene.droplets.at(0);
    EXPECT_LT(droplet.center.x() + droplet.radius, scene.microparticles[0].center.x()) << study.name;
  }
}

}  // namespace
}  // namespace dmf::tools
