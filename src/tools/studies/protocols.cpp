#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "chip/configuration.h"
#include "tools/controlled_experiment.h"
#include "tools/saved_run.h"
#include "tools/study.h"

namespace dmf::tools {

namespace {

using controller::Channel;

/// A protocol on a scene, and where its droplets are when it has worked.
struct Trial {
  std::string name;
  std::string protocol;  ///< in config/protocols
  std::string scene;
  std::vector<Channel> droplets;            ///< at the end, one a droplet, rising
  std::vector<chip::InjectFault> faults{};  ///< from the start
  double limit = 120;                       ///< s of the controller's clock
};

std::vector<Trial> trials(bool quick) {
  const std::string array = quick ? "coarse_array" : "electrode_array";
  const chip::InjectFault weak{"weak", 2, 0.55, false};
  const chip::InjectFault dead{"stuck_off", 2, 1, false};
  return {{"move_line", "move_line", array, {5, 23}},
          {"round_hole", "round_hole", array, {5, 16}},
          {"cross", "cross", array, {0, 23}},
          {"deliver", "deliver", array, {4, 20}},
          {"merge", "merge", array, {9}},
          {"mix", "mix", array, {23}},
          {"manual", "manual", array, {8, 23}},
          {"split", "split", "closed_line", {1, 3}},
          {"dispense", "dispense", "closed_array", {7, 10, 18}},
          {"serial_dilution", "serial_dilution", "closed_array", {9, 11, 12, 18}, {}, 400},
          {"weak_electrode", "move_line", array, {5, 23}, {weak}},
          {"dead_electrode", "move_line", array, {5, 23}, {dead}}};
}

/// The electrodes whose centres are nearest to the droplets' centroids, as the simulation knows them: the
/// controller is not asked.
std::vector<Channel> true_channels(const chip::Experiment& experiment) {
  std::vector<Channel> channels;
  for (const auto& droplet : experiment.observe()->droplets) {
    const auto& electrodes = experiment.scene().layout.electrodes();
    const auto distance = [&](const chip::Electrode& electrode) {
      return (electrode.centroid - droplet.centroid.head<2>()).norm();
    };
    channels.push_back(
        std::min_element(electrodes.begin(), electrodes.end(), [&](const auto& a, const auto& b) {
          return distance(a) < distance(b);
        })->channel);
  }
  std::sort(channels.begin(), channels.end());
  return channels;
}

const std::vector<std::string> kColumns{"worked", "claimed", "steps_done", "clock_s", "droplets"};

std::vector<double> run_trial(const Trial& trial, std::uint64_t seed, const std::string& key) {
  const chip::Scene scene = chip::load_scene(trial.scene);
  ControlledExperiment controlled(scene, {1, "auto"}, seed);
  for (const chip::InjectFault& fault : trial.faults) {
    const chip::Reply reply = controlled.experiment().apply(fault);
    if (!reply.success) throw std::runtime_error(reply.message);
  }
  const std::string file = chip::find_config("protocols", trial.protocol);
  controller::ProtocolRun run(
      controller::load_protocol(file, controlled.coordinator().layout(), scene.electrowetting.max_voltage),
      controlled.coordinator());
  controlled.finish(run, trial.limit);
  const double clock = controlled.time();
  const std::vector<Channel> found = true_channels(controlled.experiment());
  const bool claimed = run.status().state == controller::State::succeeded;
  const bool worked = claimed && found == trial.droplets;
  if (!worked)
    fmt::print(stderr, "{}: {}; droplets on {}, wanted {}\n", key, run.status().text, fmt::join(found, ", "),
               fmt::join(trial.droplets, ", "));
  return {static_cast<double>(worked), static_cast<double>(claimed), static_cast<double>(run.step()), clock,
          static_cast<double>(found.size())};
}

}  // namespace

void study_protocols(const StudyOptions& options) {
  const std::vector<Trial> all = trials(options.quick);
  std::vector<std::string> names;
  for (const Trial& trial : all) names.push_back(trial.name);
  require_known(options, names);
  ResultTable table(options.output + "/protocols_runs.csv", kColumns);
  const auto key = [&](const Trial& trial, int seed) {
    return fmt::format("{}{} seed={}", trial.name, options.quick ? " quick" : "", seed);
  };
  std::vector<Job> jobs;
  for (const Trial& trial : all) {
    if (!is_wanted(options, trial.name)) continue;
    for (int seed = 1; seed <= options.seeds; ++seed) {
      jobs.push_back({key(trial, seed), [=] {
                        return row_or_nan(key(trial, seed), kColumns.size(), [&] {
                          return run_trial(trial, static_cast<std::uint64_t>(seed), key(trial, seed));
                        });
                      }});
    }
  }
  run_jobs("protocols", jobs, options, table);

  std::string summary = "protocol,runs,worked,claimed,clock_s,clock_s_deviation\n";
  fmt::print("{:<16} {:>5} {:>7} {:>8} {:>16}\n", "protocol", "runs", "worked", "claimed", "clock, s");
  for (const Trial& trial : all) {
    if (!is_wanted(options, trial.name)) continue;
    double worked = 0, claimed = 0;
    std::vector<double> clocks;
    for (int seed = 1; seed <= options.seeds; ++seed) {
      const std::vector<double>& row = table.row(key(trial, seed));
      worked += row[0] > 0 ? 1 : 0;
      claimed += row[1] > 0 ? 1 : 0;
      if (row[0] > 0) clocks.push_back(row[3]);
    }
    const MeanAndSpread clock = mean_and_spread(clocks);
    fmt::print("{:<16} {:>5} {:>6.0f}% {:>7.0f}% {:>9.1f} +- {:.1f}\n", trial.name, options.seeds,
               100 * worked / options.seeds, 100 * claimed / options.seeds, clock.mean, clock.deviation);
    summary += fmt::format("{},{},{:g},{:g},{:.4g},{:.4g}\n", trial.name, options.seeds, worked, claimed,
                           clock.mean, clock.deviation);
  }
  replace_file(options.output + "/protocols.csv", summary);
}

}  // namespace dmf::tools
