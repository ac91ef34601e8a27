#include "tools/crossing.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "chip/experiment.h"
#include "tools/largest_droplet.h"
#include "tools/processes.h"

namespace dmf::tools {

Crossing run_crossing(const chip::Scene& scene, std::uint64_t seed, double limit) {
  chip::Experiment experiment(scene, {1, "auto"}, seed);
  Crossing crossing{{{-30, NAN}, {-20, NAN}, {0, NAN}, {30, NAN}, {40, NAN}}, 0};
  const auto start = std::chrono::steady_clock::now();
  const std::uint32_t interval = scene.parameters.observe_interval;
  double bead_steps = 0, start_x = NAN;
  while (experiment.simulation().time() - scene.settle_time < limit && std::isnan(crossing.passed.at(40))) {
    for (std::uint32_t k = 0; k < interval; ++k) experiment.step();
    const auto snapshot = experiment.observe();
    bead_steps += static_cast<double>(interval) * static_cast<double>(snapshot->moving_beads);
    const engine::DropletObservation* largest = largest_droplet(*snapshot);
    if (!largest) continue;
    if (std::isnan(start_x)) start_x = largest->centroid.x();
    tell_share_done(std::clamp((largest->centroid.x() - start_x) / (40 - start_x), 0.0, 1.0));
    for (auto& [x, time] : crossing.passed)
      if (std::isnan(time) && largest->centroid.x() >= x) time = snapshot->time - scene.settle_time;
  }
  crossing.ns_per_bead_step =
      std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() / bead_steps;
  return crossing;
}

}  // namespace dmf::tools
