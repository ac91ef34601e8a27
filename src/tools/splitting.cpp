#include "tools/splitting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chip/experiment.h"
#include "yaml/units.h"

namespace dmf::tools {
namespace {

/// Three electrodes in a row, with a pitch of bare plate around them.
chip::Scene scene_of(const SplittingRun& run) {
  const double half_x = 2.5 * run.pitch, half_y = 1.5 * run.pitch;
  return chip::parse_scene(
      fmt::format("domain: {{lower: [{0}, {1}, 0], upper: [{2}, {3}, {4}], sides: {{z: plates}}}}\n"
                  "time_step: {5}\n"
                  "wettability: {{rest_angle: {6} deg}}\n"
                  "chip:\n"
                  "  gap: {7}\n"
                  "  grids: [{{origin: [{8}, 0], columns: 3, rows: 1, pitch: {9}}}]\n"
                  "  electrowetting: {{reference_voltage: 60 V, reference_angle: {10} deg, saturation_angle: "
                  "{10} deg}}\n"
                  "droplets: [{{center: [0, 0], fills: 2}}]\n",
                  -half_x, -half_y, half_x, half_y, run.gap, run.time_step, run.rest_angle, 0.15 * run.pitch,
                  -run.pitch, run.pitch, run.on_angle),
      "splitting");
}

}  // namespace

SplittingResult run_splitting(const SplittingRun& run) {
  chip::Experiment experiment(scene_of(run), {1, "auto"}, run.seed);
  SplittingResult result;
  result.liquid_height = engine::liquid_height(experiment.scene().parameters);
  const auto steps_of = [&run](double time) {
    return static_cast<std::uint64_t>(std::llround(time / run.time_step));
  };
  const auto step_for = [&](double time) {
    for (std::uint64_t k = 0; k < steps_of(time); ++k) experiment.step();
  };
  experiment.apply(chip::SetHv{60, 1000, true});
  experiment.apply(chip::SetElectrodes{{0, 1, 2}});
  step_for(12 * run.pitch);
  experiment.apply(chip::SetElectrodes{{0, 2}});
  const double patience = 40 * run.pitch;
  for (double waited = 0; waited < patience; waited += 1) {
    step_for(1);
    std::vector<double> volumes;
    for (const auto& droplet : experiment.observe()->droplets) volumes.push_back(droplet.volume);
    std::sort(volumes.rbegin(), volumes.rend());
    // A satellite of some beads is no daughter.
    if (volumes.size() < 2 || volumes[1] < 0.1 * volumes[0]) continue;
    result.time = waited + 1;
    result.smaller_share = volumes[1] / (volumes[0] + volumes[1]);
    break;
  }
  return result;
}

double largest_splitting_height(double rest_angle, double on_angle) {
  const double end = 1 / std::sqrt(M_PI), neck = (1 - end * end) / (2 * end);
  const double contrast = std::cos(on_angle * degree) - std::cos(rest_angle * degree);
  return contrast / (1 / neck + 1 / end);
}

}  // namespace dmf::tools
