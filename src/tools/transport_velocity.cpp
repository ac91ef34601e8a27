#include "tools/transport_velocity.h"

#include <cmath>

#include "chip/experiment.h"
#include "tools/largest_droplet.h"

namespace dmf::tools {

VelocityResult run_transport_velocity(chip::Scene scene, const VelocityRun& run) {
  scene.schedule.clear();
  chip::Experiment experiment(scene, {1, "auto"}, run.seed);
  const double time_step = scene.parameters.time_step;
  const auto step_for = [&](double time) {
    for (std::int64_t k = std::llround(time / time_step); k > 0; --k) experiment.step();
  };
  step_for(scene.settle_time);
  experiment.apply(chip::SetHv{run.voltage, 1000, true});
  const auto& electrodes = scene.layout.electrodes();
  VelocityResult result{0, 0};
  double started = 0, arrived = 0;
  for (std::size_t next = 1; next < electrodes.size(); ++next) {
    experiment.apply(chip::SetElectrodes{{electrodes[next].channel}});
    const double goal = electrodes[next].centroid.x();
    double waited = 0;
    const auto there = [&] {
      const auto snapshot = experiment.observe();
      const engine::DropletObservation* droplet = largest_droplet(*snapshot);
      // What arrives swings in slowly: near enough to feel the electrode after it.
      return droplet && droplet->centroid.x() > goal - 0.2 * (goal - electrodes[next - 1].centroid.x());
    };
    while (!there() && waited < run.patience) {
      step_for(0.5);
      waited += 0.5;
    }
    if (waited >= run.patience) return result;
    arrived = static_cast<double>(experiment.steps()) * time_step;
    if (next == 1) started = arrived;
    result.electrodes += 1;
  }
  result.velocity = (electrodes.back().centroid.x() - electrodes[1].centroid.x()) / (arrived - started);
  return result;
}

}  // namespace dmf::tools
