#include <fmt/format.h>

#include <functional>

#include "tools/cases.h"
#include "tools/liquid.h"
#include "tools/van_der_waals.h"

namespace dmf::tools {
namespace {

/// A liquid, the densities that it is compressed to, and what others have found.
struct Material {
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

std::vector<Material> materials() {
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

Findings study_equation_of_state(const StudyOptions& options) {
  const std::vector<Material> all = materials();
  std::vector<Case> cases;
  const auto label = [](const Material& one, double density) {
    return fmt::format("{} rho={}", one.name, density);
  };
  for (const Material& one : all)
    for (const double density : one.densities)
      cases.push_back({label(one, density), [=](std::uint64_t seed) {
                         LiquidRun how;
                         how.seed = seed;
                         how.time_step = options.time_step_or(how.time_step);
                         how.lambda = options.lambda;
                         how.integrator = options.integrator.value_or(how.integrator);
                         how.quick = true;
                         how.measure = options.quick ? 2 : 25;
                         how.liquid = one.liquid;
                         how.liquid.initial_density = how.liquid.bulk_density = density;
                         const BulkResult bulk = run_bulk(how);
                         return std::vector<double>{bulk.density, bulk.temperature, bulk.pressure};
                       }});
  const Results results =
      run_cases("equation_of_state", {"density", "temperature", "pressure"}, cases, options);
  Findings findings;
  for (const Material& one : all) {
    std::vector<double> densities, pressures;
    for (const double density : one.densities) {
      Finding pressure = results.finding(label(one, density), "pressure", "pressure (k_BT/r_c^3)", 2)
                             .against_theory(reference(one.literature(density), 2, one.source));
      if (pressure.happened() > 0) {
        densities.push_back(density);
        pressures.push_back(pressure.mean().mean);
      }
      findings.push_back(std::move(pressure));
    }
    if (densities.size() < 3) continue;
    const VanDerWaals fit = fit_van_der_waals(densities, pressures, one.liquid.temperature);
    findings.push_back(
        results.derived(one.name, "van_der_waals_a", "van der Waals: attraction a", 2, {fit.attraction}));
    findings.push_back(results.derived(one.name, "van_der_waals_b", "van der Waals: excluded volume b", 4,
                                       {fit.excluded_volume}));
    findings.push_back(results.derived(one.name, "van_der_waals_residual", "van der Waals: residual, rms", 2,
                                       {fit.residual}));
  }
  return findings;
}

}  // namespace dmf::tools
