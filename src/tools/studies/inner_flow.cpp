#include <fmt/format.h>

#include <cmath>

#include "tools/quasi_stationary.h"
#include "tools/saved_run.h"
#include "tools/study.h"

namespace dmf::tools {

void study_inner_flow(const StudyOptions& options) {
  // Lan looks where the microparticle is at x = -10 (figures 3.7 and 3.8), and at a droplet alone (2.17).
  constexpr double place = -10;
  const std::vector<std::string> cases{"particle", "alone"};
  require_known(options, cases);
  ResultTable table(options.output + "/inner_flow_runs.csv", {"velocity", "drive_z", "droplet_ahead"});
  const auto key = [&](const std::string& name, int seed) {
    return fmt::format("{}{} seed={}", name, options_key(options), seed);
  };
  std::vector<Job> jobs;
  for (int seed = 1; seed <= options.seeds; ++seed)
    for (const std::string& name : cases) {
      if (!is_wanted(options, name)) continue;
      chip::Scene scene = scene_for(options, "pickup");
      if (name == "alone") scene.microparticles.clear();
      shorten_the_approach(scene);
      QuasiStationaryRun run;
      run.place = place;
      run.measure = 10000;
      run.flow = true;
      run.folder = options.output + "/runs";
      run.key = "inner_flow " + key(name, seed);
      if (options.quick) {
        run.pickup = 100;
        run.ahead = -1;  // as soon as it is wet
        run.slide = 2;
        run.settle = 2;
        run.measure = 5;
      }
      const std::string cells = run.folder + "/" + file_name(run.key) + "_cells.csv";
      jobs.push_back({key(name, seed), [scene, seed, run, cells] {
                        return row_or_nan(run.key, 3, [&] {
                          const QuasiStationary r =
                              run_quasi_stationary(scene, static_cast<std::uint64_t>(seed), run);
                          replace_file(cells, r.flow.as_csv());
                          return std::vector<double>{r.velocity, r.drive_z, r.droplet_ahead};
                        });
                      }});
    }
  run_jobs("inner_flow", jobs, options, table);

  fmt::print("flow of the liquid around x = {} of the gradient, mean velocity over the wall\n", place);
  for (const std::string& name : cases) {
    if (!is_wanted(options, name)) continue;
    std::vector<double> velocities, lifts;
    for (int seed = 1; seed <= options.seeds; ++seed) {
      const std::vector<double>& row = table.row(key(name, seed));
      if (std::isfinite(row[0])) velocities.push_back(row[0]), lifts.push_back(row[1]);
    }
    const MeanAndSpread velocity = mean_and_spread(velocities), lift = mean_and_spread(lifts);
    fmt::print(
        "{:<9} velocity {:.5f} +- {:.5f} r_c/tau, lift of the liquid {:.1f} +- {:.1f} k_BT/r_c ({} of {})\n",
        name, velocity.mean, velocity.deviation, lift.mean, lift.deviation, velocities.size(), options.seeds);
  }
  fmt::print("cells: {}/runs/inner_flow_*_cells.csv; scripts/plot_study.py inner_flow draws them\n",
             options.output);
}

}  // namespace dmf::tools
