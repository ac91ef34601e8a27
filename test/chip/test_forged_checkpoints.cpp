#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

#include "chip/checkpoint_file.h"
#include "chip/experiment.h"

// A thousand mutations of a real checkpoint. Damaged ones are refused; forged ones, whose checksum is right,
// are refused or loaded, and then the run goes on or stops with a reason. None crashes or takes memory
// without bounds.

namespace dmf::chip {
namespace {

namespace fs = std::filesystem;

const char* const kScene = R"(
domain: {lower: [-14, -8, 0], upper: [14, 8, 9], sides: {x: periodic, y: closed, z: wall}}
observe_interval: 5
wettability: {calibration: lan2016, rest_angle: 110}
chip:
  gap: 1
  grids: [{origin: [-6, 0], columns: 3, rows: 1, pitch: 6}]
  electrowetting: {reference_voltage: 63, reference_angle: 60, saturation_angle: 55, max_voltage: 80, charging_time: 1}
droplets: [{center: [-6, 0], radius: 2}]
microparticles:
  - {center: [2, 0], radius: 1, beads: 312}
  - {center: [6, 0], radius: 1, smooth: true}
)";

/// CRC-64 of ECMA-182 bit by bit, as the file format's description has it.
std::string with_checksum(std::string text) {
  std::uint64_t crc = ~std::uint64_t{0};
  for (const char c : text) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xC96C5795D7870F42u : 0);
  }
  return text + fmt::format("crc64 {:016x}\n", ~crc);
}

class ForgedCheckpoints : public ::testing::Test {
 protected:
  ForgedCheckpoints() {
    std::string name = (fs::temp_directory_path() / "dmf_forged_XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    root_ = name;
    Experiment chip(scene_, {1, "auto"});
    chip.apply(SetHv{60, 1000, true});
    chip.apply(SetElectrodes{{1}});
    for (int step = 0; step < 23; ++step) chip.step();
    chip.apply(SetElectrodeVoltages{{0, 2}, {10, 20}});
    chip.apply(SetBodyForces{{0, 0, -100}, {}});
    CheckpointFolder(root_).write("good", checkpoint_of(chip));
    std::ifstream file(root_ / "good", std::ios::binary);
    good_ = {std::istreambuf_iterator<char>(file), {}};
    header_ = good_.find('\n') + 1;
    run_ = good_.find('\n', header_) + 1;
    engine_ = good_.find('\n', run_) + 1;
    end_ = good_.size() - std::strlen("crc64 0123456789abcdef\n");
  }
  ~ForgedCheckpoints() override { fs::remove_all(root_); }

  enum class Outcome { refused, stopped, went_on };

  /// Everything that a program does with a checkpoint. What it throws but InvalidInput and Instability fails
  /// the test, and so does what a sanitizer finds.
  Outcome use(const std::string& bytes) {
    std::ofstream(root_ / "forged", std::ios::binary | std::ios::trunc) << bytes;
    Experiment& chip = chip_;
    try {
      chip.load(CheckpointFolder(root_).read("forged").state);
    } catch (const engine::InvalidInput&) {
      return Outcome::refused;
    }
    try {
      const auto look = [&chip] {
        engine::ObserveRequest request;
        request.beads = request.hash = request.wetted = request.virial = true;
        const auto snapshot = chip.observe(request);
        for (const auto& droplet : snapshot->droplets) {
          chip.channels_under(droplet);
          chip.explain_droplet(droplet.id);
        }
        chip.electrodes();
        chip.sense();
        chip.save();
      };
      look();
      for (int step = 0; step < 7; ++step) chip.step();
      look();
    } catch (const engine::Instability&) {
      return Outcome::stopped;
    }
    return Outcome::went_on;
  }

  std::size_t anywhere(std::size_t from, std::size_t to) {
    return std::uniform_int_distribution<std::size_t>(from, to - 1)(random_);
  }
  char any_byte() { return static_cast<char>(anywhere(0, 256)); }

  /// Numbers that counts, ids and places should not be.
  template <class T>
  std::string evil() {
    const T numbers[] = {static_cast<T>(0),
                         static_cast<T>(1),
                         std::numeric_limits<T>::max(),
                         std::numeric_limits<T>::lowest(),
                         static_cast<T>(std::numeric_limits<T>::max() / 2),
                         static_cast<T>(1u << 31),
                         static_cast<T>(1u << 20)};
    T value = numbers[anywhere(0, std::size(numbers))];
    if (std::is_floating_point_v<T> && anywhere(0, 2) == 0)
      value = anywhere(0, 2) ? std::numeric_limits<T>::quiet_NaN() : std::numeric_limits<T>::infinity();
    return {reinterpret_cast<const char*>(&value), sizeof value};
  }
  std::string any_evil() {
    switch (anywhere(0, 4)) {
      case 0:
        return evil<std::uint32_t>();
      case 1:
        return evil<std::uint64_t>();
      case 2:
        return evil<float>();
      default:
        return evil<double>();
    }
  }

  std::uint64_t count_at(std::size_t at) const {
    std::uint64_t count;
    std::memcpy(&count, good_.data() + at, sizeof count);
    return count;
  }

  /// A byte of the engine's state: anywhere, where it begins, a count, a bead's id, the droplets, where it
  /// ends.
  std::size_t place_in_engine(int which) {
    const std::size_t first = engine_ + 20;  // format, step, next bead
    const std::uint64_t beads = count_at(first);
    const std::size_t ids = first + 5 * (8 + 16 * beads), species = ids + 8 + 4 * beads,
                      wall = species + 8 + count_at(species);
    const std::size_t droplets = wall + 8 + 4 * count_at(wall), of_beads = droplets + 20;
    EXPECT_EQ(count_at(ids), beads);
    EXPECT_EQ(count_at(of_beads), beads);
    switch (which % 6) {
      case 0:
        return engine_ + anywhere(0, 28);
      case 1: {
        const std::size_t counts[] = {first,    first + 8 + 16 * beads,  ids, wall,
                                      of_beads, of_beads + 8 + 4 * beads};
        return counts[anywhere(0, std::size(counts))] + anywhere(0, 8);
      }
      case 2:
        return ids + 8 + 4 * anywhere(0, beads);
      case 3:
        return droplets + 4 * anywhere(0, (28 + 4 * beads + 60) / 4);
      case 4:
        return end_ - 1 - anywhere(0, 64 + 3 * (8 + 16 * 313) + 2000);
      default:
        return engine_ + anywhere(0, end_ - engine_);
    }
  }

  const Scene scene_ = parse_scene(kScene, "scene.yaml");
  Experiment chip_{scene_, {1, "auto"}};
  fs::path root_;
  std::string good_;
  std::size_t header_, run_, engine_, end_;  ///< where the parts of the file begin, and the checksum
  std::mt19937_64 random_{20161};
};

TEST_F(ForgedCheckpoints, TheGoodOneGoesOn) {
  EXPECT_EQ(use(good_), Outcome::went_on);
  EXPECT_EQ(use(with_checksum(good_.substr(0, end_))), Outcome::went_on) << "this test's checksum";
}

TEST_F(ForgedCheckpoints, DamageIsAlwaysRefused) {
  for (int mutation = 0; mutation < 300; ++mutation) {
    std::string bad = good_;
    switch (mutation % 3) {
      case 0:
        bad[anywhere(0, bad.size())] ^= static_cast<char>(1 << anywhere(0, 8));
        break;
      case 1:
        bad.resize(anywhere(0, bad.size()));
        break;
      default:
        bad.erase(anywhere(0, bad.size()), anywhere(1, 100));
    }
    EXPECT_EQ(use(bad), Outcome::refused) << "mutation " << mutation;
  }
}

TEST_F(ForgedCheckpoints, AHeaderOrRunThatWasEditedIsRefusedOrGoesOn) {
  int refused = 0, used = 0;
  for (int mutation = 0; mutation < 250; ++mutation) {
    std::string forged = good_.substr(0, end_);
    const bool of_header = mutation % 2 == 0;
    const std::size_t from = of_header ? header_ : run_, to = of_header ? run_ : engine_;
    std::size_t at = anywhere(from, to);
    switch (mutation / 2 % 5) {
      case 0:
        forged[at] = any_byte();
        break;
      case 1:
        forged.erase(at, anywhere(1, to - at + 1));
        break;
      case 2:
        forged.insert(at, std::string(anywhere(1, 2000), "[{\"0"[anywhere(0, 4)]));
        break;
      case 3:  // another digit in some number
        at = std::min(forged.find_first_of("0123456789", at), to - 1);
        forged[at] = "0123456789-.e\""[anywhere(0, 14)];
        break;
      default:  // another number
        at = std::min(forged.find_first_of("0123456789", at), to - 1);
        forged.replace(at, 1, anywhere(0, 2) ? "99999999999999999999" : "-1e400");
    }
    (use(with_checksum(forged)) == Outcome::refused ? refused : used)++;
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(used, 10) << "edits of a name of a pattern or of a voltage leave a run";
}

TEST_F(ForgedCheckpoints, AnEngineStateThatWasForgedIsRefusedOrGoesOnOrStops) {
  int refused = 0, used = 0;
  struct rusage before {
  }, after{};
  ::getrusage(RUSAGE_SELF, &before);
  for (int mutation = 0; mutation < 450; ++mutation) {
    std::string forged = good_.substr(0, end_);
    std::size_t at = place_in_engine(mutation);
    switch (mutation / 6 % 5) {
      case 0:
        forged[at] ^= static_cast<char>(1 << anywhere(0, 8));
        break;
      case 1:
      case 2: {
        const std::string number = any_evil();
        forged.replace(at, std::min(number.size(), forged.size() - at), number);
        break;
      }
      case 3:  // arrays of other lengths
        if (anywhere(0, 2))
          forged.erase(at, 4 * anywhere(1, 40));
        else
          forged.insert(at, forged.substr(at, 4 * anywhere(1, 40)));
        break;
      default:
        for (std::size_t k = at; k < std::min(at + 16, forged.size()); ++k) forged[k] = any_byte();
    }
    // The header says how long the state is.
    const std::string length = "\"state_bytes\":";
    const std::size_t number = forged.find(length, header_) + length.size();
    const std::size_t digits = forged.find_first_not_of("0123456789", number) - number;
    forged.replace(number, digits, std::to_string(forged.size() - run_));
    ASSERT_EQ(std::to_string(forged.size() - run_).size(), digits);
    (use(with_checksum(forged)) == Outcome::refused ? refused : used)++;
  }
  ::getrusage(RUSAGE_SELF, &after);
  EXPECT_GT(refused, 100);
  EXPECT_GT(used, 20) << "a velocity, a force or an average may be anything";
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 100 * 1024) << "kB more than loading the good one took";
}

}  // namespace
}  // namespace dmf::chip
