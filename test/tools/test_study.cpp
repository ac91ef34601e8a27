#include "tools/study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "engine/simulation.h"
#include "refusal.h"
#include "tools/cases.h"
#include "tools/saved_run.h"
#include "tools/study_progress.h"

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

/// What an action throws says; empty when it throws nothing.
template <typename Action>
std::string failure_of(const Action& action) {
  try {
    action();
  } catch (const std::runtime_error& failure) {
    return failure.what();
  }
  return "";
}

/// Says in a file which runs were begun: they are done in processes of their own.
class Begun {
 public:
  explicit Begun(const StudyOptions& options) : file_(options.output + "/begun") {
    std::filesystem::create_directories(options.output);
  }
  void add(const std::string& what) const { std::ofstream(file_, std::ios::app) << what + "\n"; }
  int count() const {
    std::ifstream in(file_);
    return static_cast<int>(std::count(std::istreambuf_iterator<char>(in), {}, '\n'));
  }

 private:
  std::string file_;
};

TEST(Cases, EveryRunIsDoneOnceWhateverStoppedTheStudy) {
  StudyOptions options = in_empty_folder("once");
  const Begun begun(options);
  bool fails = true;
  const auto tens = [&](int ten) {
    return Case{"R=" + std::to_string(ten), [&, ten](std::uint64_t seed) {
                  begun.add(std::to_string(ten) + " " + std::to_string(seed));
                  if (ten == 6 && seed == 2 && fails) throw std::runtime_error("not like this");
                  return std::vector<double>{10.0 * ten + static_cast<double>(seed), 0};
                }};
  };
  const auto study = [&] { return run_cases("tens", {"value", "zero"}, {tens(5), tens(6)}, options); };
  EXPECT_TRUE(holds(failure_of(study), "R=6 seed=2: not like this")) << "what a run throws is told";
  EXPECT_EQ(begun.count(), 4) << "none is begun after that";
  fails = false;
  options.jobs = 2;
  const Results results = study();
  EXPECT_EQ(results.of("R=5", "value"), (std::vector<double>{51, 52, 53}));
  EXPECT_EQ(results.of("R=6", "value"), (std::vector<double>{61, 62, 63}));
  EXPECT_EQ(begun.count(), 7) << "the failed one again, all others once";
  study();
  EXPECT_EQ(begun.count(), 7);
  EXPECT_EQ(results.mean("R=6", "value").mean, 62);
  EXPECT_EQ(results.finding("R=6", "value", "", 0).engine, std::vector<std::string>{engine_commit()});
  EXPECT_GE(results.finding("R=6", "value", "", 0).computing, 0);
}

TEST(Cases, ARunThatCrashesLosesNoOther) {
  StudyOptions options = in_empty_folder("crash");
  options.jobs = options.seeds = 2;
  const auto study = [&](bool crash) {
    return run_cases("crash", {"value"},
                     {{"",
                       [crash](std::uint64_t seed) {
                         if (crash && seed == 1) raise(SIGKILL);
                         return std::vector<double>{static_cast<double>(seed)};
                       }}},
                     options);
  };
  EXPECT_TRUE(holds(failure_of([&] { study(true); }), "scene seed=1: ended by signal 9"));
  options.recorded = true;
  EXPECT_EQ(study(false).of("", "value"), (std::vector<double>{2})) << "the one beside it";
  options.recorded = false;
  EXPECT_EQ(study(false).of("", "value"), (std::vector<double>{1, 2}));
}

TEST(StudyProgress, TimeLeftFollowsFromWhatWasDoneThisTime) {
  // Three of 12 were there when the study was taken up again, and half of a fourth.
  EXPECT_EQ(progress_text("pickup", 12, {6, 2.5}, 1500),
            "pickup [############............] 6.0 of 12 runs, 25 min, about 60 min left");
  EXPECT_EQ(progress_text("pickup", 12, {0.5, 0}, 45),
            "pickup [#.......................] 0.5 of 12 runs, 45 s")
      << "nothing is known yet";
  EXPECT_EQ(progress_text("pickup", 2, {2, 2}, 12000),
            "pickup [########################] 2.0 of 2 runs, 3 h 20 min, about 0 s left");
}

TEST(Cases, RecordedRunsNothingAndLeavesNothing) {
  StudyOptions options = in_empty_folder("recorded");
  options.recorded = true;
  const auto results = run_cases(
      "none", {"value"},
      {{"R=5", [](std::uint64_t) -> std::vector<double> { throw std::runtime_error("was run"); }}}, options);
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
