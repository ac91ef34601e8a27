#include "tools/protocol_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "chip/configuration.h"
#include "tools/controlled_experiment.h"

namespace dmf::tools {

namespace {

using controller::Channel;

Channel nearest_channel(const chip::Scene& scene, const Eigen::Vector2d& place) {
  const auto& electrodes = scene.layout.electrodes();
  const auto distance = [&](const chip::Electrode& electrode) { return (electrode.centroid - place).norm(); };
  return std::min_element(electrodes.begin(), electrodes.end(),
                          [&](const auto& a, const auto& b) { return distance(a) < distance(b); })
      ->channel;
}

void look_where_all_is(const chip::Experiment& experiment, TrialResult& result) {
  const auto snapshot = experiment.observe();
  for (const auto& droplet : snapshot->droplets) {
    const Channel channel = nearest_channel(experiment.scene(), droplet.centroid.head<2>());
    result.droplets.push_back(channel);
    for (const auto& microparticle : snapshot->microparticles)
      if (microparticle.droplet == droplet.id) result.microparticles.push_back(channel);
  }
  std::sort(result.droplets.begin(), result.droplets.end());
  std::sort(result.microparticles.begin(), result.microparticles.end());
}

}  // namespace

std::vector<ProtocolTrial> protocol_trials(bool coarse) {
  const std::string open = coarse ? "coarse_array" : "electrode_array";
  const std::string closed = coarse ? "coarse_closed_array" : "closed_array";
  const std::string line = coarse ? "coarse_closed_line" : "closed_line";
  const chip::InjectFault weak{"weak", 2, 0.55, false};
  const chip::InjectFault dead{"stuck_off", 2, 1, false};
  std::vector<ProtocolTrial> trials{{"move_line", "move_line", open, {5, 23}},
                                    {"round_hole", "round_hole", open, {5, 16}},
                                    {"cross", "cross", open, {0, 23}},
                                    {"deliver", "deliver", open, {4, 20}},
                                    {"merge", "merge", open, {9}},
                                    {"mix", "mix", open, {23}},
                                    {"manual", "manual", open, {8, 23}},
                                    {"split", "split", line, {1, 3}},
                                    {"dispense", "dispense", closed, {8, 10, 21}},
                                    {"serial_dilution", "serial_dilution", closed, {9, 11, 13, 21}},
                                    {"wash_microparticle", "wash_microparticle", "wash", {1, 6}},
                                    {"weak_electrode", "move_line", open, {5, 23}, {weak}},
                                    {"dead_electrode", "move_line", open, {5, 23}, {dead}}};
  for (ProtocolTrial& trial : trials) {
    if (trial.name == "serial_dilution") trial.limit = 400;
    if (trial.name == "wash_microparticle") trial.microparticles = 1;
  }
  return trials;
}

TrialResult run_trial(const ProtocolTrial& trial, std::uint64_t seed) {
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
  TrialResult result;
  result.claimed = run.status().state == controller::State::succeeded;
  result.steps_done = run.step();
  result.clock = controlled.time();
  result.text = run.status().text;
  look_where_all_is(controlled.experiment(), result);
  const std::vector<Channel> microparticles(trial.microparticles ? scene.microparticles.size() : 0,
                                            trial.microparticles.value_or(0));
  result.worked =
      result.claimed && result.droplets == trial.droplets && result.microparticles == microparticles;
  return result;
}

std::string describe(const ProtocolTrial& trial, const TrialResult& result) {
  std::string text = fmt::format("{}; droplets on {}, wanted {}", result.text,
                                 fmt::join(result.droplets, ", "), fmt::join(trial.droplets, ", "));
  if (trial.microparticles) {
    text += fmt::format("; microparticles in those on {}, wanted {}", fmt::join(result.microparticles, ", "),
                        *trial.microparticles);
  }
  return text;
}

}  // namespace dmf::tools
