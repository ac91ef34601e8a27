#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>

#include "chip/checkpoint_file.h"
#include "chip/experiment.h"
#include "engine/noise.h"

// One run, however it came to its end: with one thread or two, in one piece or through a checkpoint file at
// any step and on with another number of threads, commanded or played again from its history.

namespace dmf::chip {
namespace {

const char* const kScene = R"(
domain: {lower: [-20, -8, 0], upper: [20, 8, 10]}
observe_interval: 10
wettability: {calibration: lan2016, rest_angle: 110}
chip:
  gap: 2
  grids: [{origin: [-12, 0], columns: 3, rows: 1, pitch: 12}]
  rail: {current_limit: 1 A}
  electrowetting: {reference_voltage: 63, reference_angle: 60, saturation_angle: 55, max_voltage: 80, charging_time: 0.4}
droplets: [{center: [-12, 0], radius: 2}]
microparticles: [{center: [-6, 0], radius: 1}]
schedule: [{at: 0.33, set_electrode_voltages: {channels: [2], voltages: [30]}}]
patterns:
  walk:
    - {at: 0, set_electrodes: {channels: [1]}}
    - {at: 0.4, set_electrodes: {channels: [2]}}
)";
constexpr std::uint64_t kEnd = 160;

std::unique_ptr<Experiment> start(int threads) {
  return std::make_unique<Experiment>(parse_scene(kScene, "scene.yaml"), engine::Execution{threads, "auto"});
}

/// What a controller says, and before which step.
const std::multimap<std::uint64_t, Command>& commands() {
  static const std::multimap<std::uint64_t, Command> given = [] {
    AddMicroparticle particle;
    particle.x = 1.2e-4;
    particle.radius = 1e-5;
    particle.magnetic = true;
    return std::multimap<std::uint64_t, Command>{
        {0, SetHv{60, 1000, true}},
        {5, SetElectrodes{{1}}},
        {23, DispenseDroplet{1.2e-4, 5e-5, 2e-14}},
        {41, particle},
        {55, SetBodyForces{{100, 0, 0}, {1e-9, 0, 0}}},
        {71, LoadPattern{"walk"}},
        {90, InjectFault{fault::kWeak, 2, 0.5}},
        {97, SetWettability{{-1e-4, 1e-4}, {110, 80}}},
        {118, Remove{0, 1}},
        {130, SetDisabledChannels{{0}}},
        {140, SetElectrodes{{0, 2}}},
    };
  }();
  return given;
}

/// Applies what is due, then steps; to the end, or to `until`.
template <class Commands>
void drive(Experiment& chip, const Commands& given, std::uint64_t until = kEnd) {
  while (true) {
    for (const auto& [step, command] : given)
      if (step == chip.steps()) {
        const Reply reply = chip.apply(command);
        ASSERT_TRUE(reply.success) << name_of(command) << ": " << reply.message;
      }
    if (chip.steps() >= until) return;
    chip.step();
  }
}

/// The rest of the commands after a restart before `step`'s commands are due again.
std::multimap<std::uint64_t, Command> after(std::uint64_t step) {
  return {commands().upper_bound(step), commands().end()};
}

class Folder {
 public:
  Folder() {
    name_ = (std::filesystem::temp_directory_path() / "dmf_restarts_XXXXXX").string();
    if (!::mkdtemp(name_.data())) throw std::runtime_error("no temporary folder");
  }
  ~Folder() { std::filesystem::remove_all(name_); }
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

TEST(Restarts, ThreadsCheckpointsAndHistoryGiveOneRun) {
  const auto uninterrupted = start(1);
  drive(*uninterrupted, commands());
  const std::string expected = uninterrupted->save();
  const std::uint64_t hash = checkpoint_of(*uninterrupted).state_hash;
  ASSERT_EQ(uninterrupted->history().size(), commands().size());

  const Folder place;
  const CheckpointFolder folder(place.name());
  for (const int threads : {1, 2}) {
    for (int restart = 0; restart < 5; ++restart) {
      auto chip = start(threads);
      // None first, then at random: a fresh process with the other number of threads goes on from a file.
      if (restart == 0) {
        drive(*chip, commands());
      } else {
        const std::uint64_t step = engine::mix64(100 * threads + restart) % kEnd;
        drive(*chip, commands(), step);
        folder.write("saved", checkpoint_of(*chip));
        const Checkpoint saved = folder.read("saved");
        chip = start(3 - threads);
        chip->load(saved.state);
        ASSERT_EQ(chip->steps(), step);
        EXPECT_EQ(checkpoint_of(*chip).state_hash, saved.state_hash);
        drive(*chip, after(step));
      }
      EXPECT_EQ(checkpoint_of(*chip).state_hash, hash) << threads << " threads, restart " << restart;
      EXPECT_TRUE(chip->save() == expected) << threads << " threads, restart " << restart;

      std::multimap<std::uint64_t, Command> history;
      for (const auto& [step, command] : chip->history())
        history.emplace(step, command_from_json(to_json(command)));
      const auto again = start(threads);
      drive(*again, history);
      EXPECT_EQ(checkpoint_of(*again).state_hash, hash)
          << threads << " threads, from history, restart " << restart;
      EXPECT_TRUE(again->save() == expected) << threads << " threads, from history, restart " << restart;
    }
  }
}

}  // namespace
}  // namespace dmf::chip
