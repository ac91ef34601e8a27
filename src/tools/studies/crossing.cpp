#include "tools/crossing.h"

#include <fmt/format.h>

#include "tools/study.h"

namespace dmf::tools {

void study_crossing(const StudyOptions& options) {
  chip::Scene scene = chip::load_scene(options.scene);
  scene.parameters.time_step = options.time_step;
  scene.parameters.integrator = options.integrator;
  if (options.list_skin > 0) scene.parameters.list_skin = options.list_skin;
  if (options.lambda > 0) scene.parameters.integrator_lambda = options.lambda;
  ResultTable table(options.output + "/crossing_runs.csv",
                    {"to_-30", "to_-20", "to_0", "to_30", "to_40", "ns_per_bead_step"});
  const auto key = [&](int seed) {
    return fmt::format("{} dt={}{} seed={}", scene.name, options.time_step,
                       integrator_key(options.integrator), seed);
  };
  std::vector<Job> jobs;
  for (int seed = 1; seed <= options.seeds; ++seed)
    jobs.push_back({key(seed), [=, &options, &scene] {
                      const Crossing crossing = run_crossing(scene, static_cast<std::uint64_t>(seed),
                                                             options.quick ? 100 : scene.default_duration);
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
