#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "tools/cases.h"
#include "tools/liquid.h"
#include "tools/van_der_waals.h"

namespace dmf::tools {
namespace {

/// A liquid, the densities that it is compressed to, and what others have found.
struct Material {
  std::string name;
  engine::LiquidParameters liquid;
  std::vector<double> densities;
  std::string source;
  std::function<double(double density)> literature;  ///< may be none
  engine::SplineParameters spline{};
  std::optional<VanDerWaals> published{};  ///< who draws such a curve beside it

  LiquidRun run(double density) const {
    LiquidRun how;
    how.quick = true;  // settles 5 tau
    how.liquid = liquid;
    how.liquid.initial_density = how.liquid.bulk_density = density;
    how.spline = spline;
    // Liu's box, 10 r_c wide, would need 13,000 beads at its densest: one of 7.
    if (spline.used) how.bulk_cells = std::max(4, static_cast<int>(std::lround(7 * std::cbrt(density / 4))));
    return how;
  }
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

/// Liu 3.3.2 and 4.1: U = a (2 W(r, 0.8) - B W(r, 1)), gamma 4.5 at any temperature.
Material liu(double strength, double attraction, double temperature) {
  Material material{fmt::format("spline a={:g} B={:g} k_BT={:g}", strength, attraction, temperature),
                    plain_dpd(strength),
                    {1, 1.5, 2, 3, 4, 5, 6, 7, 8, 10, 12},
                    "",
                    {}};
  material.liquid.temperature = temperature;
  material.liquid.random_amplitude = std::sqrt(2 * 4.5 * temperature);
  material.spline = {true, 2, 0.8, attraction, 1};
  return material;
}

/// Liu's figure 13: b = 0.016, a = 1.9 b beside his liquid of B = 0.95.
constexpr VanDerWaals liu_fit{1.9 * 0.016, 0.016, 0};

/// His strength of 18.75, at which he has drops, with the attractions of his figures 13 and 17. He does not
/// say the strength of figure 13; 2 is what has the second virial coefficients of his van der Waals curve
/// there (1.8 at k_BT = 0.54, 2.3 at 1).
std::vector<Material> materials_of_liu() {
  std::vector<Material> all{liu(18.75, 1, 1), liu(18.75, 0.95, 1), liu(18.75, 0.95, 0.54)};
  for (const double temperature : {1.0, 0.54}) {
    Material weak = liu(2, 0.95, temperature);
    weak.source = "Liu's van der Waals curve";
    weak.published = liu_fit;
    weak.literature = [=](double density) { return liu_fit.pressure(density, temperature); };
    all.push_back(weak);
  }
  return all;
}

std::vector<Material> materials() {
  std::vector<Material> all{
      {"dpd a=18.75",
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
  for (Material& one : materials_of_liu()) all.push_back(std::move(one));
  return all;
}

/// The most that a pressure is below one at a lower density: the depth of a van der Waals loop.
double deepest_fall(const std::vector<double>& pressures) {
  double highest = pressures.front(), fall = 0;
  for (const double pressure : pressures) {
    highest = std::max(highest, pressure);
    fall = std::max(fall, highest - pressure);
  }
  return fall;
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
                         LiquidRun how = one.run(density);
                         how.seed = seed;
                         how.time_step = options.time_step_or(how.time_step);
                         how.lambda = options.lambda;
                         how.integrator = options.integrator.value_or(how.integrator);
                         how.measure = options.quick ? 2 : 25;
                         const BulkResult bulk = run_bulk(how);
                         return std::vector<double>{bulk.density, bulk.temperature, bulk.pressure};
                       }});
  const Results results =
      run_cases("equation_of_state", {"density", "temperature", "pressure"}, cases, options);
  Findings findings;
  for (const Material& one : all) {
    std::vector<double> densities, pressures;
    for (const double density : one.densities) {
      Finding pressure = results.finding(label(one, density), "pressure", "pressure (k_BT/r_c^3)", 2);
      if (one.published)
        pressure.against_paper(reference(one.literature(density), 2, one.source));
      else if (one.literature)
        pressure.against_theory(reference(one.literature(density), 2, one.source));
      if (pressure.happened() > 0) {
        densities.push_back(density);
        pressures.push_back(pressure.mean().mean);
      }
      findings.push_back(std::move(pressure));
    }
    if (densities.size() < 3) continue;
    const VanDerWaals fit = fit_van_der_waals(densities, pressures, one.liquid.temperature);
    Finding attraction =
        results.derived(one.name, "van_der_waals_a", "van der Waals: attraction a", 4, {fit.attraction});
    Finding volume = results.derived(one.name, "van_der_waals_b", "van der Waals: excluded volume b", 4,
                                     {fit.excluded_volume});
    if (one.published) {
      attraction.against_paper(reference(one.published->attraction, 4, "Liu"));
      volume.against_paper(reference(one.published->excluded_volume, 4, "Liu"));
    }
    findings.push_back(attraction);
    findings.push_back(volume);
    findings.push_back(results.derived(one.name, "van_der_waals_residual", "van der Waals: residual, rms", 2,
                                       {fit.residual}));
    Finding loop = results.derived(one.name, "loop", "pressure falls with density by (k_BT/r_c^3)", 2,
                                   {deepest_fall(pressures)});
    if (one.spline.used && !one.published)
      loop.against_paper({"0.5 to 100", "Liu: there are drops in vapour"});
    findings.push_back(loop);
  }
  return findings;
}

}  // namespace dmf::tools
