#include <fmt/format.h>

#include <functional>

#include "tools/liquid.h"
#include "tools/study.h"
#include "tools/van_der_waals.h"

namespace dmf::tools {
namespace {

/// A liquid, the densities that it is compressed to, and what others have found.
struct Case {
  const char* name;
  engine::LiquidParameters liquid;
  std::vector<double> densities;
  const char* source;
  std::function<double(double density)> literature;
};

engine::LiquidParameters plain_dpd(double repulsion) {
  engine::LiquidParameters liquid;
  liquid.attraction = repulsion;
  liquid.repulsion = 0;
  liquid.random_amplitude = 3;
  return liquid;
}

/// Groot and Warren 1997, eq. 14.
double groot_warren(double density, double repulsion) {
  return density + 0.101 * repulsion * density * density;
}

/// Warren 2003, eq. 4: alpha = 0.101, c = 4.16, d = 18, for densities above 4 or so.
double warren(double density) {
  const engine::LiquidParameters liquid;
  const double alpha = 0.101, range = liquid.repulsion_radius, cubed = density * density * density;
  return density + alpha * liquid.attraction * density * density +
         2 * alpha * liquid.repulsion * range * range * range * range *
             (cubed - 4.16 * density * density + 18);
}

std::vector<Case> cases() {
  return {{"dpd a=18.75",
           plain_dpd(18.75),
           {1, 2, 3, 4, 5, 6, 8},
           "Groot and Warren",
           [](double density) { return groot_warren(density, 18.75); }},
          {"dpd a=25",
           plain_dpd(25),
           {1, 2, 3, 4, 5, 6, 8},
           "Groot and Warren",
           [](double density) { return groot_warren(density, 25); }},
          {"mdpd", engine::LiquidParameters{}, {6.1, 6.5, 7, 7.5, 8, 9, 10}, "Warren", warren}};
}

}  // namespace

void study_equation_of_state(const StudyOptions& options) {
  std::vector<std::string> labels;
  for (const Case& one : cases()) labels.push_back(one.name);
  require_known(options, labels);
  ResultTable table(options.output + "/equation_of_state_runs.csv", {"density", "temperature", "pressure"});
  const auto key = [&](const Case& one, double density, int seed) {
    return fmt::format("{} rho={}{} seed={}", one.name, density, options_key(options), seed);
  };
  std::vector<Job> jobs;
  for (const Case& one : cases()) {
    if (!is_wanted(options, one.name)) continue;
    for (const double density : one.densities)
      for (int seed = 1; seed <= options.seeds; ++seed)
        jobs.push_back({key(one, density, seed), [=] {
                          LiquidRun how;
                          how.seed = static_cast<std::uint64_t>(seed);
                          how.time_step = options.time_step;
                          how.lambda = options.lambda;
                          how.integrator = options.integrator;
                          how.quick = true;
                          how.measure = options.quick ? 2 : 25;
                          how.liquid = one.liquid;
                          how.liquid.initial_density = how.liquid.bulk_density = density;
                          const BulkResult bulk = run_bulk(how);
                          return std::vector<double>{bulk.density, bulk.temperature, bulk.pressure};
                        }});
  }
  run_jobs("equation_of_state", jobs, options, table);

  for (const Case& one : cases()) {
    if (!is_wanted(options, one.name)) continue;
    fmt::print("{}, {} seeds\n{:>8} {:>20} {:>18} {:>18}\n", one.name, options.seeds, "density", "pressure",
               one.source, "van der Waals");
    std::vector<double> densities, pressures;
    std::vector<MeanAndSpread> results;
    for (const double density : one.densities) {
      std::vector<double> values;
      for (int seed = 1; seed <= options.seeds; ++seed)
        values.push_back(table.row(key(one, density, seed))[2]);
      results.push_back(mean_and_spread(values));
      densities.push_back(density);
      pressures.push_back(results.back().mean);
    }
    const VanDerWaals fit = fit_van_der_waals(densities, pressures, one.liquid.temperature);
    for (std::size_t k = 0; k < densities.size(); ++k)
      fmt::print("{:>8.2f} {:>12.3f} +- {:<5.2g} {:>17.3f} {:>18.3f}\n", densities[k], results[k].mean,
                 results[k].deviation, one.literature(densities[k]),
                 fit.pressure(densities[k], one.liquid.temperature));
    fmt::print("van der Waals: a = {:.4g}, b = {:.4g}, residual {:.2g}\n", fit.attraction,
               fit.excluded_volume, fit.residual);
  }
}

}  // namespace dmf::tools
