#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "chip/checkpoint_file.h"
#include "engine/parameters.h"

namespace dmf::chip {
namespace {

namespace fs = std::filesystem;
using engine::InvalidInput;

class CheckpointFileTest : public ::testing::Test {
 protected:
  ~CheckpointFileTest() override { fs::remove_all(root_); }

  static fs::path make_temporary_folder() {
    std::string name = (fs::temp_directory_path() / "dmf_checkpoint_XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    return name;
  }

  static Checkpoint example() {
    Checkpoint checkpoint;
    checkpoint.scene = "tiny_line";
    checkpoint.seed = 0xffffffffffffffffu;
    checkpoint.step = 123;
    checkpoint.time = 1.23;
    checkpoint.state_hash = 0xfedcba9876543210u;
    checkpoint.scene_hash = 0x8000000000000001u;
    checkpoint.ros_time = 1'234'567'891;
    checkpoint.run = 4;
    checkpoint.paused = true;
    checkpoint.state = std::string("zero \0 newline \n crc64 \xff", 23);
    return checkpoint;
  }

  std::string contents(const fs::path& file) const {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void replace(const fs::path& file, const std::string& data) const {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << data;
  }
  std::string refusal(const std::string& name) const {
    try {
      folder_.read(name);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  }

  const fs::path root_ = make_temporary_folder();
  CheckpointFolder folder_{root_ / "a" / "b"};
};

TEST_F(CheckpointFileTest, ComesBackAsItWasWritten) {
  folder_.write("first", example());
  const Checkpoint back = folder_.read("first");
  EXPECT_EQ(back.scene, example().scene);
  EXPECT_EQ(back.seed, example().seed);
  EXPECT_EQ(back.step, example().step);
  EXPECT_EQ(back.time, example().time);
  EXPECT_EQ(back.state_hash, example().state_hash);
  EXPECT_EQ(back.scene_hash, example().scene_hash);
  EXPECT_EQ(back.ros_time, example().ros_time);
  EXPECT_EQ(back.run, example().run);
  EXPECT_EQ(back.paused, example().paused);
  EXPECT_NE(back.package_version, "");
  EXPECT_EQ(back.state, example().state);
}

TEST_F(CheckpointFileTest, LeavesNothingButTheCheckpointBehind) {
  folder_.write("first", example());
  folder_.write("first", example());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1);
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"first"});
}

TEST_F(CheckpointFileTest, EveryDamagedByteIsNoticed) {
  folder_.write("first", example());
  const fs::path file = folder_.path() / "first";
  const std::string good = contents(file);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x10);
    replace(file, bad);
    EXPECT_NE(refusal("first"), "") << "byte " << i;
  }
  replace(file, good);
  EXPECT_EQ(refusal("first"), "");
}

TEST_F(CheckpointFileTest, EveryTruncationIsNoticed) {
  folder_.write("first", example());
  const fs::path file = folder_.path() / "first";
  const std::string good = contents(file);
  for (std::size_t size = 0; size < good.size(); ++size) {
    replace(file, good.substr(0, size));
    EXPECT_NE(refusal("first"), "") << size << " bytes";
  }
}

TEST_F(CheckpointFileTest, NamesTheVersionThatItCannotRead) {
  folder_.write("first", example());
  const fs::path file = folder_.path() / "first";
  std::string data = contents(file);
  data[data.find('2')] = '1';
  replace(file, data);
  EXPECT_NE(refusal("first").find("version 1, allowed: 2"), std::string::npos) << refusal("first");
}

TEST_F(CheckpointFileTest, RefusesEveryNameThatIsNotBare) {
  for (const std::string name :
       {"", ".", "..", "../x", "/etc/passwd", "a/b", ".hidden", "a b", "a\nb", "ä"}) {
    EXPECT_THROW(folder_.write(name, example()), InvalidInput) << name;
    EXPECT_THROW(folder_.read(name), InvalidInput) << name;
  }
  EXPECT_THROW(folder_.write(std::string(101, 'a'), example()), InvalidInput);
  EXPECT_FALSE(fs::exists(root_ / "a")) << "a refusal must not even create the folder";
}

TEST_F(CheckpointFileTest, FollowsNoLinks) {
  folder_.write("first", example());
  const fs::path outside = root_ / "outside";
  fs::copy_file(folder_.path() / "first", outside);
  fs::create_symlink(outside, folder_.path() / "link");
  EXPECT_NE(refusal("link").find("allowed: first"), std::string::npos) << refusal("link");
  replace(outside, "untouched");
  EXPECT_THROW(folder_.write("link", example()), InvalidInput);
  EXPECT_EQ(contents(outside), "untouched");
}

TEST_F(CheckpointFileTest, DoesNotWaitForAPipe) {
  fs::create_directories(folder_.path());
  ASSERT_EQ(::mkfifo((folder_.path() / "pipe").c_str(), 0600), 0);
  EXPECT_NE(refusal("pipe"), "");
}

TEST_F(CheckpointFileTest, SaysWhichCheckpointsThereAre) {
  EXPECT_NE(refusal("first").find("no checkpoint yet"), std::string::npos) << refusal("first");
  folder_.write("second", example());
  EXPECT_NE(refusal("first").find("allowed: second"), std::string::npos) << refusal("first");
}

TEST_F(CheckpointFileTest, AFullDiskIsReportedAndLeavesTheOldFileAndNothingElse) {
  folder_.write("first", example());
  Checkpoint larger = example();
  larger.state = std::string(1 << 20, 'x');
  // No file may be longer than this: writing fails half way, as on a full disk.
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  struct rlimit small = before;
  small.rlim_cur = 1 << 16;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string problem;
  try {
    folder_.write("first", larger);
  } catch (const std::runtime_error& error) {
    problem = error.what();
  }
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(problem.find("can't write"), std::string::npos) << problem;
  EXPECT_EQ(folder_.read("first").state, example().state);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1);
  folder_.write("first", larger);
  EXPECT_EQ(folder_.read("first").state, larger.state);
}

TEST_F(CheckpointFileTest, ReportsADiskThatRefuses) {
  replace(root_ / "file", "");
  EXPECT_THROW(CheckpointFolder(root_ / "file" / "folder").write("first", example()), std::runtime_error);
}

}  // namespace
}  // namespace dmf::chip
