#include <fmt/format.h>

#include <fstream>

#include "tools/duct.h"
#include "tools/study.h"

namespace dmf::tools {
namespace {

const std::vector<double> repulsions{9.68, 18};  // of fluid and wall: the ends of Chen's range

DuctRun duct_run(const StudyOptions& options, double repulsion, int seed) {
  DuctRun run;
  run.seed = static_cast<std::uint64_t>(seed);
  run.time_step = options.time_step;
  run.wall_repulsion = repulsion;
  if (options.quick) {
    run.length = 6;
    run.settle = 40;
    run.measure = 10;
  }
  return run;
}

void write_profile(const StudyOptions& options, const DuctRun& run, const DuctResult& result) {
  std::ofstream csv(
      fmt::format("{}/square_channel_a{:g}_seed{}.csv", options.output, run.wall_repulsion, run.seed));
  csv << "y,z,velocity,theory,density\n";
  const double strength = 4 * run.acceleration / result.viscosity;
  for (int z = 0; z < result.cells; ++z)
    for (int y = 0; y < result.cells; ++y) {
      const std::size_t cell = static_cast<std::size_t>(z) * result.cells + y;
      const double at_y = result.middle(y, run.half_width), at_z = result.middle(z, run.half_width);
      csv << fmt::format("{},{},{:.6g},{:.6g},{:.6g}\n", at_y, at_z, result.velocity[cell],
                         strength * duct_velocity(at_y, at_z, result.fitted_width, result.fitted_width),
                         result.density[cell]);
    }
}

}  // namespace

void study_square_channel(const StudyOptions& options) {
  std::vector<std::string> labels;
  for (const double repulsion : repulsions) labels.push_back(fmt::format("{:g}", repulsion));
  require_known(options, labels);
  ResultTable table(
      options.output + "/square_channel_runs.csv",
      {"mass_flow", "viscosity", "fitted_half_width", "deviation", "temperature", "wall_density"});
  const auto key = [&](double repulsion, int seed) {
    return fmt::format("a_AW={:g}{} seed={}", repulsion, options_key(options), seed);
  };
  std::vector<Job> jobs;
  for (const double repulsion : repulsions) {
    if (!is_wanted(options, fmt::format("{:g}", repulsion))) continue;
    for (int seed = 1; seed <= options.seeds; ++seed)
      jobs.push_back({key(repulsion, seed), [=, &options] {
                        const DuctRun run = duct_run(options, repulsion, seed);
                        const DuctResult result = run_duct(run);
                        write_profile(options, run, result);
                        return std::vector<double>{result.mass_flow, result.viscosity,   result.fitted_width,
                                                   result.deviation, result.temperature, result.densest};
                      }});
  }
  run_jobs("square_channel", jobs, options, table);

  fmt::print("channel 20 x 20 r_c, rho 4, a 18.75, s 1/2, gamma 4.5, g 0.1; Chen: mass flow 3416, no slip\n");
  fmt::print("{:>6} {:>18} {:>18} {:>18} {:>12} {:>12} {:>12}\n", "a_AW", "mass flow", "viscosity",
             "half width", "off fit", "temperature", "wall density");
  for (const double repulsion : repulsions) {
    if (!is_wanted(options, fmt::format("{:g}", repulsion))) continue;
    std::vector<std::vector<double>> columns(6);
    for (int seed = 1; seed <= options.seeds; ++seed) {
      const std::vector<double>& row = table.row(key(repulsion, seed));
      for (std::size_t k = 0; k < row.size(); ++k) columns[k].push_back(row[k]);
    }
    const MeanAndSpread flow = mean_and_spread(columns[0]), viscosity = mean_and_spread(columns[1]),
                        width = mean_and_spread(columns[2]);
    fmt::print(
        "{:>6.2f} {:>9.1f} +- {:<5.1f} {:>9.3f} +- {:<5.3f} {:>9.3f} +- {:<5.3f} {:>11.2f}% {:>12.4f} "
        "{:>12.3f}\n",
        repulsion, flow.mean, flow.deviation, viscosity.mean, viscosity.deviation, width.mean,
        width.deviation, 100 * mean_and_spread(columns[3]).mean, mean_and_spread(columns[4]).mean,
        mean_and_spread(columns[5]).mean);
  }
}

}  // namespace dmf::tools
