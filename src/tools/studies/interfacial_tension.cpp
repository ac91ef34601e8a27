#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "tools/interface.h"
#include "tools/study.h"

namespace dmf::tools {

namespace {

struct Case {
  std::string label;
  InterfaceRun how;
  std::optional<double> chi;     ///< of Flory and Huggins
  std::optional<double> theory;  ///< tension by Groot and Warren's fit
  std::optional<double> paper;   ///< what was simulated there
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
  const double cell = std::cbrt(4 / density);
  how.size = cell * Eigen::Vector3d(9, 9, 18);
  how.liquid.attraction = repulsion;
  how.liquid.repulsion = 0;
  how.liquid.random_amplitude = 3;
  how.liquid.initial_density = how.liquid.bulk_density = density;
  how.attraction_between = repulsion + excess;
  return how;
}

std::vector<Case> cases(bool quick) {
  std::vector<Case> all;
  // Chen (11): chi / (a_AB - a_AA).
  constexpr double chi_at_3 = 0.286, chi_at_5 = 0.689;
  for (const double excess : {12.0, 20.0, 30.0}) {
    const InterfaceRun how = plain_dpd(3, 25, excess);
    const double chi = chi_at_3 * excess;
    all.push_back({fmt::format("rho=3 a_AB={:g}", how.attraction_between), how, chi, fitted_tension(3, chi),
                   std::nullopt});
  }
  // At four beads Chen takes the mean of what the fit gives at three and at five.
  constexpr double excess = 37.5;
  InterfaceRun chen = plain_dpd(4, 18.75, excess);
  chen.size = {40, 10, 30};
  chen.liquid.dissipation_exponent = 0.5;
  chen.measure = 100;
  all.push_back({"Chen", chen, 0.5 * (chi_at_3 + chi_at_5) * excess,
                 0.5 * (fitted_tension(3, chi_at_3 * excess) + fitted_tension(5, chi_at_5 * excess)), 5.25});
  // Water and oil of the scene oil_around_droplet. No theory is known of the many-body law.
  InterfaceRun many_body;
  many_body.attraction_between = -30;
  many_body.liquid.initial_density = many_body.liquid.bulk_density;
  all.push_back({"many-body A=-30", many_body, std::nullopt, std::nullopt, std::nullopt});
  if (quick)
    for (Case& one : all) {
      one.how.size = {8, 8, 12};
      one.how.relax = 2;
      one.how.measure = 4;
    }
  return all;
}

}  // namespace

void study_interfacial_tension(const StudyOptions& options) {
  const std::vector<Case> all = cases(options.quick);
  std::vector<std::string> labels;
  for (const Case& one : all) labels.push_back(one.label);
  require_known(options, labels);
  ResultTable table(options.output + "/interfacial_tension_runs.csv",
                    {"tension", "temperature", "strangers"});
  const auto key = [&](const Case& one, int seed) {
    return fmt::format("{}{} seed={}", one.label, options_key(options), seed);
  };
  std::vector<Job> jobs;
  for (const Case& one : all) {
    if (!is_wanted(options, one.label)) continue;
    for (int seed = 1; seed <= options.seeds; ++seed)
      jobs.push_back({key(one, seed), [=] {
                        InterfaceRun how = one.how;
                        how.seed = static_cast<std::uint64_t>(seed);
                        how.time_step = options.time_step;
                        how.integrator = options.integrator;
                        const InterfaceResult found = run_interface(how);
                        return std::vector<double>{found.tension, found.temperature, found.strangers};
                      }});
  }
  run_jobs("interfacial_tension", jobs, options, table);

  fmt::print("two liquids, {} seeds; fit: Groot and Warren 1997; strangers: Flory and Huggins\n",
             options.seeds);
  fmt::print("{:<16} {:>6} {:>18} {:>8} {:>8} {:>20} {:>8} {:>12}\n", "", "chi", "tension", "fit", "paper",
             "strangers", "theory", "temperature");
  for (const Case& one : all) {
    if (!is_wanted(options, one.label)) continue;
    std::vector<double> tensions, temperatures, strangers;
    for (int seed = 1; seed <= options.seeds; ++seed) {
      const std::vector<double>& row = table.row(key(one, seed));
      tensions.push_back(row[0]);
      temperatures.push_back(row[1]);
      strangers.push_back(row[2]);
    }
    const MeanAndSpread tension = mean_and_spread(tensions), share = mean_and_spread(strangers);
    const auto text = [](const char* format, const std::optional<double>& number) {
      return number ? fmt::format(fmt::runtime(format), *number) : std::string();
    };
    std::optional<double> expected;
    if (one.chi) expected = flory_huggins_share(*one.chi);
    fmt::print("{:<16} {:>6} {:>9.3f} +- {:<5.2g} {:>8} {:>8} {:>10.5f} +- {:<6.1g} {:>8} {:>12.4f}\n",
               one.label, text("{:.2f}", one.chi), tension.mean, tension.deviation,
               text("{:.2f}", one.theory), text("{:.2f}", one.paper), share.mean, share.deviation,
               text("{:.5f}", expected), mean_and_spread(temperatures).mean);
  }
}

}  // namespace dmf::tools
