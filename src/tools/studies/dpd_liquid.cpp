#include <fmt/format.h>

#include <cmath>

#include "tools/cases.h"
#include "tools/liquid.h"

namespace dmf::tools {

namespace {

/// Friction that fades with the exponent s and ends at r_D, under plain DPD with the repulsion a.
struct Friction {
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
      return 4 * M_PI * std::pow(radius, power + 3) * std::beta(power + 3, liquid.dissipation_exponent + 1);
    };
    diffusivity = 3 * liquid.temperature / (friction * density * moment(0));
    viscosity = density * diffusivity / 2 + friction * density * density * moment(2) / 30;
  }
};

}  // namespace

Findings study_dpd_liquid(const StudyOptions& options) {
  std::vector<Friction> all;
  for (const double repulsion : {0.0, 18.75})
    for (const auto& [exponent, radius] : {std::pair{2.0, 1.0}, {1.0, 1.0}, {0.5, 1.0}, {0.5, 1.88}})
      all.push_back({exponent, radius, repulsion});
  std::vector<Case> cases;
  for (const Friction& one : all)
    cases.push_back({one.label(), [=](std::uint64_t seed) {
                       LiquidRun how;
                       how.seed = seed;
                       how.time_step = options.time_step_or(how.time_step);
                       how.quick = options.quick;
                       how.measure = options.quick ? 0 : 150;
                       how.liquid = one.liquid();
                       const BulkResult bulk = run_bulk(how);
                       return std::vector<double>{bulk.temperature, bulk.viscosity, bulk.diffusivity};
                     }});
  const Results results =
      run_cases("dpd_liquid", {"temperature", "viscosity", "diffusivity"}, cases, options);
  Findings findings;
  for (const Friction& one : all) {
    const std::string label = one.label();
    const Theory theory(one.liquid());
    const double density = one.liquid().bulk_density;
    const char* const source = "kinetic theory without repulsion";
    findings.push_back(results.finding(label, "viscosity", "viscosity (m/(r_c tau))", 2)
                           .against_theory(reference(theory.viscosity, 2, source))
                           .within(0.1));
    findings.push_back(results.finding(label, "diffusivity", "diffusivity (r_c^2/tau)", 3)
                           .against_theory(reference(theory.diffusivity, 3, source))
                           .within(0.1));
    const std::vector<double> viscosity = results.of(label, "viscosity"),
                              diffusivity = results.of(label, "diffusivity");
    std::vector<double> schmidt;
    for (std::size_t k = 0; k < viscosity.size(); ++k)
      schmidt.push_back(viscosity[k] / (density * diffusivity[k]));
    findings.push_back(
        results.derived(label, "schmidt", "Schmidt number", 2, schmidt)
            .against_theory(reference(theory.viscosity / (density * theory.diffusivity), 2, source))
            .within(0.1));
    findings.push_back(results.finding(label, "temperature", "temperature (k_BT)", 4));
  }
  return findings;
}

}  // namespace dmf::tools
