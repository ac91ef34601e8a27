#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "chip/checkpoint_series.h"
#include "chip/checkpoint_writer.h"
#include "refusal.h"

namespace dmf::chip {
namespace {

namespace fs = std::filesystem;
using Numbering = CheckpointSeries::Numbering;
using Names = std::vector<std::string>;

const char* const kScene = R"(
domain: {lower: [-14, -8, 0], upper: [14, 8, 8]}
wettability: {calibration: lan2016, rest_angle: 110}
chip: {gap: 1, grids: [{origin: [-6, 0], columns: 3, rows: 1, pitch: 6}]}
droplets: [{center: [-6, 0], radius: 2}]
)";

Experiment start(const std::string& more = "", std::optional<std::uint64_t> seed = {}) {
  return Experiment(parse_scene(kScene + more, "scene.yaml"), {1, "auto"}, seed);
}

class CheckpointSeriesTest : public ::testing::Test {
 protected:
  ~CheckpointSeriesTest() override { fs::remove_all(root_); }

  static fs::path make_temporary_folder() {
    std::string name = (fs::temp_directory_path() / "dmf_series_XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    return name;
  }
  CheckpointSeries series(const std::string& prefix = "auto.chip.scene.", unsigned keep = 2,
                          Numbering numbering = Numbering::counted) const {
    return {root_, prefix, "", numbering, keep};
  }
  static Checkpoint at_step(std::uint64_t step) {
    Checkpoint checkpoint;
    checkpoint.scene = "scene";
    checkpoint.step = step;
    checkpoint.state = "state";
    return checkpoint;
  }
  static void damage(const fs::path& file) { fs::resize_file(file, fs::file_size(file) / 2); }
  Names names() const { return CheckpointFolder(root_).names(); }

  const fs::path root_ = make_temporary_folder();
  Names passed_over_;
  const std::function<void(const std::string&)> note_ = [this](const std::string& why) {
    passed_over_.push_back(why);
  };
};

TEST_F(CheckpointSeriesTest, KeepsTheLastOnesAndWhatIsNotItsOwn) {
  const CheckpointFolder folder(root_);
  const Names foreign{"mine", "auto.chip.scene.7", "auto.chip.scene.000000000001x",
                      "auto.chip.other.000000000001", "auto.chip.scene.x.000000000001"};
  for (const std::string& name : foreign) folder.write(name, at_step(1));
  CheckpointSeries own = series();
  for (const std::uint64_t step : {500, 600, 3, 40}) own.write(at_step(step));
  Names left = foreign;
  left.insert(left.end(), {"auto.chip.scene.000000000003", "auto.chip.scene.000000000004"});
  std::sort(left.begin(), left.end());
  EXPECT_EQ(names(), left);
  EXPECT_EQ(folder.read("auto.chip.scene.000000000004").step, 40u)
      << "the order is that of writing, not of steps";
}

TEST_F(CheckpointSeriesTest, OneThatWasWrittenIsNotTakenAwayForNewerDamagedOnes) {
  CheckpointSeries own = series("step_", 2, Numbering::by_step);
  for (const std::uint64_t step : {200, 300}) own.write(at_step(step));
  own.write(at_step(100));
  EXPECT_EQ(own.numbers(), (std::vector<std::uint64_t>{100, 200, 300}));
}

TEST_F(CheckpointSeriesTest, AnotherProcessIsKeptOutUntilItsOwnerEnds) {
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t owner = ::fork();
  if (owner == 0) {
    CheckpointSeries own = series();
    own.claim();
    std::ofstream(root_ / ".auto.chip.scene.000000000009.1.1.unfinished") << "half";
    std::ofstream(root_ / ".mine.1.1.unfinished") << "half";
    [[maybe_unused]] const auto told = ::write(ready[1], "x", 1);
    ::pause();
    ::_exit(0);
  }
  char byte;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  CheckpointSeries other = series();
  EXPECT_TRUE(
      holds(refusal([&] { other.claim(); }), "another process writes auto.chip.scene.* there, allowed:"));
  EXPECT_NO_THROW(series("auto.chip2.scene.").claim()) << "another series is another matter";
  ::kill(owner, SIGKILL);
  ::waitpid(owner, nullptr, 0);
  EXPECT_NO_THROW(other.claim());
  EXPECT_FALSE(fs::exists(root_ / ".auto.chip.scene.000000000009.1.1.unfinished"));
  EXPECT_TRUE(fs::exists(root_ / ".mine.1.1.unfinished")) << "somebody may be writing that";
}

TEST_F(CheckpointSeriesTest, ARunGoesOnFromTheNewestGoodOneOfItsSceneAndSeed) {
  Experiment chip = start();
  CheckpointSeries own = series("auto.chip.scene.", 9);
  for (int i = 0; i < 4; ++i) {
    chip.step();
    own.write(checkpoint_of(chip));
  }
  own.write(checkpoint_of(start("", 8)));
  own.write(checkpoint_of(start("angle_window: 3\n")));
  damage(root_ / own.name_of(4));
  damage(root_ / own.name_of(2));

  Experiment again = start();
  const auto point = resume(again, own, {0, 1}, note_);
  ASSERT_TRUE(point);
  EXPECT_EQ(point->name, own.name_of(3));
  EXPECT_EQ(again.steps(), 3u);
  ASSERT_EQ(passed_over_.size(), 3u);
  EXPECT_TRUE(holds(passed_over_[0],
                    own.name_of(6) + ": passed over: saved run: of a scene scene that differs in engine"));
  EXPECT_TRUE(holds(passed_over_[1], own.name_of(5)));
  EXPECT_TRUE(holds(passed_over_[1], "of seed 8, allowed: 1"));
  EXPECT_TRUE(holds(passed_over_[2], own.name_of(4)));
  EXPECT_TRUE(holds(passed_over_[2], "damaged or cut off"));
  again.step();
  EXPECT_TRUE(again.save() == chip.save());
}

TEST_F(CheckpointSeriesTest, NoneThatCanBeUsedLeavesTheRunAtItsStart) {
  Experiment chip = start();
  chip.step();
  CheckpointSeries own = series();
  own.write(checkpoint_of(chip));
  Experiment again = start();
  const std::string before = again.save();
  EXPECT_FALSE(resume(again, own, {2, {}}, note_)) << "number 1 is before the first that is wanted";
  EXPECT_TRUE(passed_over_.empty());
  damage(root_ / own.name_of(1));
  EXPECT_FALSE(resume(again, own, {}, note_));
  EXPECT_EQ(passed_over_.size(), 1u);
  EXPECT_TRUE(again.save() == before);
  EXPECT_FALSE(resume(again, series("auto.nobody."), {}, note_));
}

TEST_F(CheckpointSeriesTest, TheWriterTakesNoCheckpointWhileItWritesOne) {
  CheckpointWriter writer(series());
  Checkpoint large = at_step(1);
  large.state = std::string(20 << 20, 'x');  // longer than the two calls below
  ASSERT_TRUE(writer.put(large));
  EXPECT_TRUE(writer.busy());
  EXPECT_FALSE(writer.put(at_step(2)));
  writer.wait();
  EXPECT_FALSE(writer.busy());
  EXPECT_TRUE(writer.put(at_step(3)));
  writer.wait();
  const auto reports = writer.take_reports();
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_EQ(reports[0].step, 1u);
  EXPECT_EQ(reports[1].step, 3u);
}

TEST_F(CheckpointSeriesTest, TheWriterTellsWhatBecameOfEachAndGoesOnAfterAFailure) {
  const fs::path folder = root_ / "folder";
  CheckpointWriter writer({folder, "auto.", "", Numbering::counted, 3});
  std::ofstream(folder) << "a file where the folder should be";
  ASSERT_TRUE(writer.put(at_step(1)));
  writer.wait();
  fs::remove(folder);
  ASSERT_TRUE(writer.put(at_step(2)));
  writer.wait();
  const auto reports = writer.take_reports();
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_EQ(reports[0].name, "");
  EXPECT_TRUE(holds(reports[0].problem, "folder"));
  EXPECT_EQ(reports[1].name, "auto.000000000001");
  EXPECT_EQ(reports[1].problem, "");
  EXPECT_EQ(CheckpointFolder(folder).read(reports[1].name).step, 2u);
}

}  // namespace
}  // namespace dmf::chip
