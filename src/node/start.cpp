#include "node/start.h"

#include <fmt/format.h>
#include <ros/param.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <limits>

namespace dmf::node {
namespace {

/// As a part of a checkpoint's name, which dots separate.
std::string part_of_name(std::string text) {
  constexpr std::size_t kLongest = 38;
  for (char& c : text) {
    const bool kept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    if (!kept) c = '_';
  }
  return text.substr(0, kLongest);
}

/// Takes over where the checkpoint's run was. False: there is none to go on from.
bool resume(Start& start, const Options& options, chip::CheckpointSeries& series, bool respawned) {
  series.claim();
  const chip::ResumeRule rule{options.resume == "true" ? 0 : static_cast<std::uint64_t>(options.respawn_from),
                              start.experiment->simulation().parameters().seed};
  const auto point = chip::resume(*start.experiment, series, rule,
                                  [](const std::string& why) { tell("checkpoint " + why); });
  if (!point) return false;
  const chip::Checkpoint& saved = point->checkpoint;
  EngineSettings& settings = start.settings;
  settings.first_run = std::max(settings.first_run, saved.run + 1);
  settings.ros_start = std::max(settings.ros_start, saved.ros_time + RunClock::kRunGap);
  if (respawned) settings.paused = saved.paused;
  settings.resumed_from =
      fmt::format("{} of step {}, {}", point->name, saved.step, respawned ? "the node came back" : "resumed");
  return true;
}

}  // namespace

void tell(const std::string& text) { std::fprintf(stderr, "chip: %s\n", text.c_str()); }

bool is_automatic(const std::string& checkpoint) { return checkpoint.rfind(kAutomatic, 0) == 0; }

chip::CheckpointSeries automatic_checkpoints(const Options& options, const std::string& node,
                                             const chip::Scene& scene) {
  const std::string name = node.substr(node.find_first_not_of('/'));
  const std::string prefix =
      fmt::format("{}{}.{}.", kAutomatic, part_of_name(name), part_of_name(scene.name));
  return {options.checkpoint_dir, prefix, "", chip::CheckpointSeries::Numbering::counted,
          static_cast<unsigned>(options.checkpoint_keep)};
}

Start begin(const Options& options, const chip::Scene& scene, chip::CheckpointSeries& series,
            const MasterMemory& memory) {
  Start start;
  start.experiment = std::make_unique<chip::Experiment>(scene, options.execution, options.seed);
  start.settings = options.engine;
  if (const auto run = memory.run_reached()) start.settings.first_run = *run + 1;
  if (const auto clock = memory.clock_reached())
    start.settings.ros_start = std::max(RunClock::kStart, *clock + RunClock::kRunGap);
  if (options.resume == "false") return start;

  const bool respawned = options.respawn_from >= 0;
  if (options.resume == "true" || respawned) {
    if (resume(start, options, series, respawned)) {
      tell("goes on from " + start.settings.resumed_from);
    } else {
      tell(fmt::format(
          "no automatic checkpoint {}* of this scene and seed in {} to go on from: starts from the scene",
          series.prefix(), options.checkpoint_dir.string()));
    }
  }
  if (!respawned) {
    constexpr std::uint64_t kLargest = std::numeric_limits<int>::max();
    ros::param::set("~respawn_from", static_cast<int>(std::min(kLargest, series.next_number())));
  }
  return start;
}

}  // namespace dmf::node
