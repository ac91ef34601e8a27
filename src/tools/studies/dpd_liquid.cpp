#include <fmt/format.h>

#include <cmath>

#include "tools/liquid.h"
#include "tools/study.h"

namespace dmf::tools {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Friction that fades with the exponent s and ends at r_D, under plain DPD with the repulsion a.
struct Case {
  double exponent, radius, repulsion;

  std::string label() const { return fmt::format("s={} r_D={} a={}", exponent, radius, repulsion); }

  /// The liquid of Liu's figures 4 and 5: gamma 4.5, four beads per r_c^3.
  engine::LiquidParameters liquid() const {
    engine::LiquidParameters liquid;
    liquid.attraction = repulsion;
    liquid.repulsion = 0;
    liquid.random_amplitude = 3;
    liquid.initial_density = liquid.bulk_density = 4;
    liquid.dissipation_exponent = exponent;
    liquid.dissipation_radius = radius;
    return liquid;
  }
};

/// What kinetic theory gives where beads stand at random and nothing but friction and noise acts (Groot and
/// Warren 1997; Liu table 1 has it for s = 2, 1 and 1/2):
///   D = 3 k_BT / (gamma rho [w_D]),   eta = rho D / 2 + gamma rho^2 [r^2 w_D] / 30,   Sc = eta / (rho D)
/// with [f] the integral over space, here Beta functions.
struct Theory {
  double viscosity, diffusivity;

  explicit Theory(const engine::LiquidParameters& liquid) {
    const double friction = liquid.random_amplitude * liquid.random_amplitude / (2 * liquid.temperature);
    const double density = liquid.bulk_density, radius = liquid.dissipation_radius;
    const auto moment = [&](int power) {
      return 4 * pi * std::pow(radius, power + 3) * std::beta(power + 3, liquid.dissipation_exponent + 1);
    };
    diffusivity = 3 * liquid.temperature / (friction * density * moment(0));
    viscosity = density * diffusivity / 2 + friction * density * density * moment(2) / 30;
  }
};

}  // namespace

void study_dpd_liquid(const StudyOptions& options) {
  std::vector<Case> cases;
  std::vector<std::string> labels;
  for (const double repulsion : {0.0, 18.75})
    for (const auto& [exponent, radius] : {std::pair{2.0, 1.0}, {1.0, 1.0}, {0.5, 1.0}, {0.5, 1.88}}) {
      cases.push_back({exponent, radius, repulsion});
      labels.push_back(cases.back().label());
    }
  require_known(options, labels);
  ResultTable table(options.output + "/dpd_liquid_runs.csv", {"temperature", "viscosity", "diffusivity"});
  const auto key = [&](const Case& one, int seed) {
    return fmt::format("{}{} seed={}", one.label(), options_key(options), seed);
  };
  std::vector<Job> jobs;
  for (const Case& one : cases) {
    if (!is_wanted(options, one.label())) continue;
    for (int seed = 1; seed <= options.seeds; ++seed)
      jobs.push_back({key(one, seed), [=] {
                        LiquidRun how;
                        how.seed = static_cast<std::uint64_t>(seed);
                        how.time_step = options.time_step;
                        how.quick = options.quick;
                        how.measure = options.quick ? 0 : 150;
                        how.liquid = one.liquid();
                        const BulkResult bulk = run_bulk(how);
                        return std::vector<double>{bulk.temperature, bulk.viscosity, bulk.diffusivity};
                      }});
  }
  run_jobs("dpd_liquid", jobs, options, table);

  fmt::print("gamma 4.5, 4 beads per r_c^3, {} seeds; theory knows no repulsion\n", options.seeds);
  fmt::print("{:<24} {:>16} {:>8} {:>18} {:>8} {:>8} {:>8} {:>12}\n", "", "viscosity", "theory",
             "diffusivity", "theory", "Schmidt", "theory", "temperature");
  for (const Case& one : cases) {
    if (!is_wanted(options, one.label())) continue;
    std::vector<double> temperatures, viscosities, diffusivities;
    for (int seed = 1; seed <= options.seeds; ++seed) {
      const std::vector<double>& row = table.row(key(one, seed));
      temperatures.push_back(row[0]);
      viscosities.push_back(row[1]);
      diffusivities.push_back(row[2]);
    }
    const Theory theory(one.liquid());
    const double density = one.liquid().bulk_density;
    const MeanAndSpread viscosity = mean_and_spread(viscosities),
                        diffusivity = mean_and_spread(diffusivities);
    fmt::print(
        "{:<24} {:>8.3f} +- {:<4.2g} {:>8.3f} {:>9.4f} +- {:<6.1g} {:>7.4f} {:>8.2f} {:>8.2f} {:>12.4f}\n",
        one.label(), viscosity.mean, viscosity.deviation, theory.viscosity, diffusivity.mean,
        diffusivity.deviation, theory.diffusivity, viscosity.mean / density / diffusivity.mean,
        theory.viscosity / density / theory.diffusivity, mean_and_spread(temperatures).mean);
  }
}

}  // namespace dmf::tools
