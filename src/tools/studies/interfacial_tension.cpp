#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "tools/cases.h"
#include "tools/interface.h"

namespace dmf::tools {
namespace {

/// Two liquids, and what is known of them.
struct Material {
  std::string label;
  InterfaceRun how;
  std::optional<double> chi;     ///< of Flory and Huggins
  std::optional<double> theory;  ///< tension by Groot and Warren's fit
  Reference paper;
};

/// Groot and Warren (1997) for monomers, as Chen (17) has it.
double fitted_tension(double density, double chi) {
  return 0.75 * density * std::pow(chi, 0.26) * std::pow(1 - 2.36 / chi, 1.5);
}

/// Share of strangers in coexisting phases of monomers: the smaller root of ln((1 - f) / f) = chi (1 - 2 f).
double flory_huggins_share(double chi) {
  double share = 1e-6;
  for (int k = 0; k < 10000; ++k) share = 1 / (1 + std::exp(chi * (1 - 2 * share)));
  return share;
}

/// In a box of about 10 x 10 x 20 whole lattice cells: the density is what it says.
InterfaceRun plain_dpd(double density, double repulsion, double excess) {
  InterfaceRun how;
  how.time_step = 0.02;
  const double cell = std::cbrt(4 / density);
  how.size = cell * Eigen::Vector3d(9, 9, 18);
  how.liquid.attraction = repulsion;
  how.liquid.repulsion = 0;
  how.liquid.random_amplitude = 3;
  how.liquid.initial_density = how.liquid.bulk_density = density;
  how.attraction_between = repulsion + excess;
  return how;
}

std::vector<Material> materials(bool quick) {
  std::vector<Material> all;
  // Chen (11): chi / (a_AB - a_AA).
  constexpr double chi_at_3 = 0.286, chi_at_5 = 0.689;
  for (const double excess : {12.0, 20.0, 30.0}) {
    const InterfaceRun how = plain_dpd(3, 25, excess);
    const double chi = chi_at_3 * excess;
    all.push_back(
        {fmt::format("rho=3 a_AB={:g}", how.attraction_between), how, chi, fitted_tension(3, chi), {}});
  }
  // At four beads Chen takes the mean of what the fit gives at three and at five.
  constexpr double excess = 37.5;
  InterfaceRun chen = plain_dpd(4, 18.75, excess);
  chen.size = {40, 10, 30};
  chen.liquid.dissipation_exponent = 0.5;
  chen.measure = 100;
  all.push_back({"Chen",
                 chen,
                 0.5 * (chi_at_3 + chi_at_5) * excess,
                 0.5 * (fitted_tension(3, chi_at_3 * excess) + fitted_tension(5, chi_at_5 * excess)),
                 {"5.25", "Chen"}});
  // Water and oil of the scene oil_around_droplet. No theory is known of the many-body law.
  InterfaceRun many_body;
  many_body.attraction_between = -30;
  many_body.liquid.initial_density = many_body.liquid.bulk_density;
  all.push_back({"many-body A=-30", many_body, std::nullopt, std::nullopt, {}});
  if (quick)
    for (Material& one : all) {
      one.how.size = {8, 8, 12};
      one.how.relax = 2;
      one.how.measure = 4;
    }
  return all;
}

}  // namespace

Findings study_interfacial_tension(const StudyOptions& options) {
  const std::vector<Material> all = materials(options.quick);
  std::vector<Case> cases;
  for (const Material& one : all)
    cases.push_back({one.label, [=](std::uint64_t seed) {
                       InterfaceRun how = one.how;
                       how.seed = seed;
                       how.time_step = options.time_step_or(how.time_step);
                       how.integrator = options.integrator.value_or(how.integrator);
                       const InterfaceResult found = run_interface(how);
                       return std::vector<double>{found.tension, found.temperature, found.strangers};
                     }});
  const Results results =
      run_cases("interfacial_tension", {"tension", "temperature", "strangers"}, cases, options);
  Findings findings;
  for (const Material& one : all) {
    const char* const groot = "Groot and Warren's fit";
    findings.push_back(results.finding(one.label, "tension", "interfacial tension (k_BT/r_c^2)", 3)
                           .against_paper(one.paper)
                           .against_theory(one.theory ? reference(*one.theory, 2, groot) : Reference{}));
    Finding strangers = results.finding(one.label, "strangers", "share of the other liquid's beads", 5);
    if (one.chi)
      strangers.against_theory(reference(flory_huggins_share(*one.chi), 5, "Flory and Huggins")).within(0.1);
    findings.push_back(strangers);
    findings.push_back(results.finding(one.label, "temperature", "temperature (k_BT)", 4));
  }
  return findings;
}

}  // namespace dmf::tools
