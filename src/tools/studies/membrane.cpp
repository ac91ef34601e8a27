#include <fmt/format.h>

#include <vector>

#include "tools/membrane_run.h"
#include "tools/study.h"

namespace dmf::tools {
namespace {

struct Case {
  std::string name, about;
  MembraneRun run;
};

std::vector<Case> all_cases(const StudyOptions& options) {
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, const std::string& about) -> MembraneRun& {
    cases.push_back({name, about, {}});
    MembraneRun& run = cases.back().run;
    run.time_step = options.time_step;
    run.integrator = options.integrator;
    if (options.quick) run.settle = run.measure = 2;
    return run;
  };
  // What gets through, over the length of edges.
  for (const int subdivisions : {1, 2, 3}) {
    MembraneRun& run = add(fmt::format("sphere{}", subdivisions), "sphere of radius 3 in a liquid");
    run.subdivisions = subdivisions;
    if (subdivisions == 1) run.margin = 3.3;  // its edges are long for a periodic box
  }
  {
    MembraneRun& run = add("red_cell", "red cell of radius 5 in a liquid");
    run.red_cell = true;
    run.radius = 5;
    run.subdivisions = 3;
  }
  // A sphere whose volume goes down to that of a red cell. The liquid goes through, so that it can.
  for (const bool flat : {true, false}) {
    MembraneRun& run =
        add(flat ? "deflated_flat" : "deflated",
            flat ? "sphere deflated to 0.64, unbent when flat" : "sphere deflated to 0.64, unbent as sphere");
    run.repulsion = 0;
    run.stiffness.volume_ratio = 0.64;
    run.subdivisions = 2;
    run.stiffness.volume_stiffness = 100;
    run.stiffness.area_stiffness = 200;
    run.stiffness.local_area_stiffness = 50;
    run.stiffness.shear_modulus = 5;
    run.stiffness.bending_rigidity = 15;
    run.stiffness.flat = flat;
    if (!options.quick) run.settle = 100;
  }
  return cases;
}

}  // namespace

void study_membrane(const StudyOptions& options) {
  const std::vector<Case> cases = all_cases(options);
  std::vector<std::string> names;
  for (const Case& one : cases) names.push_back(one.name);
  require_known(options, names);
  ResultTable table(options.output + "/membrane_runs.csv",
                    {"mean_edge", "area", "volume", "area_error", "volume_error", "reduced_volume",
                     "gyration_short", "gyration_middle", "gyration_long", "centre_thickness",
                     "inside_before", "inside_after", "crossed", "temperature"});
  const auto key = [&](const Case& one, int seed) {
    return fmt::format("{}{} seed={}", one.name, options_key(options), seed);
  };
  std::vector<Job> jobs;
  for (const Case& one : cases) {
    if (!is_wanted(options, one.name)) continue;
    for (int seed = 1; seed <= options.seeds; ++seed)
      jobs.push_back({key(one, seed), [=] {
                        MembraneRun run = one.run;
                        run.seed = static_cast<std::uint64_t>(seed);
                        const MembraneResult r = run_membrane(run);
                        return std::vector<double>{r.mean_edge,
                                                   r.area,
                                                   r.volume,
                                                   r.largest_area_error,
                                                   r.largest_volume_error,
                                                   r.reduced_volume,
                                                   r.gyration.x(),
                                                   r.gyration.y(),
                                                   r.gyration.z(),
                                                   r.centre_thickness,
                                                   r.inside_before,
                                                   r.inside_after,
                                                   r.crossed,
                                                   r.temperature};
                      }});
  }
  run_jobs("membrane", jobs, options, table);

  for (const Case& one : cases) {
    if (!is_wanted(options, one.name)) continue;
    std::vector<double> columns[14];
    for (int seed = 1; seed <= options.seeds; ++seed)
      for (int k = 0; k < 14; ++k) columns[k].push_back(table.row(key(one, seed))[k]);
    const auto mean = [&](int column) { return mean_and_spread(columns[column]).mean; };
    fmt::print("{} ({})\n", one.name, one.about);
    fmt::print(
        "  edges {:.3f} r_c; area {:.4f} of that when placed, off by {:.2g} at most; volume {:.4f}, off by "
        "{:.2g}; reduced volume {:.3f}; temperature {:.3f}\n",
        mean(0), mean(1), mean(3), mean(2), mean(4), mean(5), mean(13));
    fmt::print(
        "  radii of gyration {:.2f} {:.2f} {:.2f}; thickness at the centre of the largest {:.2f} +- {:.2f}\n",
        mean(6), mean(7), mean(8), mean(9), mean_and_spread(columns[9]).deviation);
    if (one.run.repulsion > 0)
      fmt::print(
          "  liquid inside: {:.0f} beads, {:.0f} after {:g} tau; changed sides, both ways: {:.1f} % of them "
          "(all: 200 %)\n",
          mean(10), mean(11), one.run.measure, 100 * mean(12));
  }
}

}  // namespace dmf::tools
