#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <map>

#include "chip/experiment.h"
#include "tools/study.h"

namespace dmf::tools {
namespace {

/// tau after the gradient is on at which the droplet's centroid first passes each x; NaN when it never did.
struct Crossing {
  std::map<double, double> passed{{-30, NAN}, {-20, NAN}, {0, NAN}, {30, NAN}, {40, NAN}};
  double ns_per_bead_step = 0;
};

Crossing cross(const chip::Scene& scene, const StudyOptions& options, int seed) {
  chip::Scene adapted = scene;
  adapted.parameters.time_step = options.time_step;
  if (options.lambda > 0) adapted.parameters.integrator_lambda = options.lambda;
  chip::Experiment experiment(adapted, {1, "auto"}, static_cast<std::uint64_t>(seed));
  const double limit = options.quick ? 100 : scene.default_duration;
  Crossing crossing;
  const auto start = std::chrono::steady_clock::now();
  double bead_steps = 0;
  while (experiment.simulation().time() - scene.settle_time < limit) {
    const std::uint32_t interval = adapted.parameters.observe_interval;
    for (std::uint32_t k = 0; k < interval; ++k) experiment.step();
    const auto snapshot = experiment.observe();
    bead_steps += static_cast<double>(interval) * static_cast<double>(snapshot->moving_beads);
    if (snapshot->droplets.empty()) continue;
    const engine::DropletObservation* largest = &snapshot->droplets.front();
    for (const auto& droplet : snapshot->droplets)
      if (droplet.beads > largest->beads) largest = &droplet;
    for (auto& [x, time] : crossing.passed)
      if (std::isnan(time) && largest->centroid.x() >= x) time = snapshot->time - scene.settle_time;
    if (!std::isnan(crossing.passed.at(40))) break;
  }
  crossing.ns_per_bead_step =
      std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() / bead_steps;
  return crossing;
}

}  // namespace

void study_crossing(const StudyOptions& options) {
  const chip::Scene scene = chip::load_scene(options.scene);
  ResultTable table(options.output + "/crossing_runs.csv",
                    {"to_-30", "to_-20", "to_0", "to_30", "to_40", "ns_per_bead_step"});
  const auto key = [&](int seed) {
    return fmt::format("{} dt={} seed={}", scene.name, options.time_step, seed);
  };
  std::vector<Job> jobs;
  for (int seed = 1; seed <= options.seeds; ++seed)
    jobs.push_back({key(seed), [=, &options, &scene] {
                      const Crossing crossing = cross(scene, options, seed);
                      std::vector<double> row;
                      for (const auto& entry : crossing.passed) row.push_back(entry.second);
                      row.push_back(crossing.ns_per_bead_step);
                      return row;
                    }});
  run_jobs("crossing " + scene.name, jobs, options, table);
  const char* const names[] = {"x = -30", "x = -20", "x = 0", "x = 30", "x = 40", "ns per bead-step"};
  fmt::print("{}: tau from the gradient on until the droplet passes\n", scene.name);
  std::vector<double> middle;
  for (std::size_t column = 0; column < 6; ++column) {
    std::vector<double> values;
    for (const Job& job : jobs) values.push_back(table.row(job.key)[column]);
    const MeanAndSpread result = mean_and_spread(values);
    fmt::print("{:<20} {:10.1f} +- {:.1f}\n", names[column], result.mean, result.deviation);
  }
  for (const Job& job : jobs) middle.push_back(table.row(job.key)[3] - table.row(job.key)[1]);
  const MeanAndSpread result = mean_and_spread(middle);
  fmt::print("{:<20} {:10.1f} +- {:.1f}\n", "from -20 to 30", result.mean, result.deviation);
  fmt::print("Lan: gradient_R5 reaches x = 40 after 2,973, droplet_gradient (R = 10) in about 1,800\n");
}

}  // namespace dmf::tools
