#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "tools/cases.h"
#include "tools/chain_run.h"

namespace dmf::tools {
namespace {

constexpr double gamma_of_study = 4.5;  // of a random amplitude of 3 at k_BT = 1

struct Chains {
  std::string kind;  ///< ideal, solvent, pulled, channel
  double value;      ///< beads; beads; force; gravity

  std::string label() const { return fmt::format("{}={:g}", kind, value); }
};

engine::Spring harmonic_spring() {
  engine::Spring spring;
  spring.stiffness = 60;
  spring.length = 0.6;
  return spring;
}

/// Ten statistical segments a bond, as DNA is modelled (Liu 4.3).
engine::Spring wlc_spring() {
  engine::Spring spring;
  spring.kind = engine::SpringKind::wlc;
  spring.max_length = 1.5;
  spring.persistence_length = 0.075;
  return spring;
}

std::vector<Chains> all_chains() {
  std::vector<Chains> all;
  for (const double beads : {5, 10, 20, 30}) all.push_back({"ideal", beads});
  for (const double beads : {5, 8, 13, 20}) all.push_back({"solvent", beads});
  for (const double force : {1, 3, 10, 20, 40}) all.push_back({"pulled", force});
  for (const double gravity : {0.0, 0.02, 0.05}) all.push_back({"channel", gravity});
  return all;
}

ChainRun run_of(const Chains& one, const StudyOptions& options, std::uint64_t seed) {
  ChainRun run;
  run.seed = seed;
  run.time_step = options.time_step_or(run.time_step);
  run.integrator = options.integrator.value_or(run.integrator);
  run.spring = one.kind == "ideal" || one.kind == "solvent" ? harmonic_spring() : wlc_spring();
  if (one.kind == "ideal") {
    run.beads = static_cast<std::uint32_t>(one.value);
    run.chains = 900 / run.beads;
    const double rouse = rouse_time(run.beads, 0.4, gamma_of_study, run.density, 1);
    run.settle = 2 + 3 * rouse;
    run.interval = std::max(0.05, 0.05 * rouse);
    run.measure = options.quick ? 10 * rouse : 20 + 30 * rouse;
  } else if (one.kind == "solvent") {
    run.beads = static_cast<std::uint32_t>(one.value);
    run.repulsion = 25;
    // Wide enough that a chain does not see its own images; a tenth of the beads.
    run.size.setConstant(std::max(6.0, std::ceil(1.8 * 0.75 * std::pow(one.value, 0.6))));
    run.chains = std::max(1u, static_cast<std::uint32_t>(0.1 * 3 * run.size.prod() / one.value));
    run.settle = options.quick ? 5 : 100;
    run.measure = options.quick ? 10 : 500;
  } else if (one.kind == "pulled") {
    run.beads = 11;
    run.chains = 80;
    run.stretching_force = one.value;
    run.settle = options.quick ? 10 : 50;
    run.measure = options.quick ? 20 : 150;
  } else {
    run.beads = 15;
    run.chains = 8;
    run.repulsion = 25;
    run.size = {14, 8, 8};
    run.channel = true;
    run.gravity = one.value;
    run.settle = options.quick ? 5 : 100;
    run.measure = options.quick ? 10 : 400;
  }
  return run;
}

/// Force of the whole chain at the relative extension z (Marko and Siggia 1995), k_BT / r_c.
double marko_siggia(double z, double persistence_length) {
  return (1 / (4 * (1 - z) * (1 - z)) - 0.25 + z) / persistence_length;
}

/// The relative extension under a force.
double marko_siggia_extension(double force, double persistence_length) {
  double low = 0, high = 1;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (marko_siggia(middle, persistence_length) < force ? low : high) = middle;
  }
  return low;
}

}  // namespace

Findings study_chain(const StudyOptions& options) {
  const std::vector<Chains> all = all_chains();
  std::vector<Case> cases;
  for (const Chains& one : all)
    cases.push_back({one.label(), [=](std::uint64_t seed) {
                       const ChainResult r = run_chains(run_of(one, options, seed));
                       return std::vector<double>{r.end_to_end_square, r.gyration_square, r.bond_square,
                                                  r.extension,         r.stretch_square,  r.relaxation,
                                                  r.off_centre,        r.temperature,     r.speed};
                     }});
  const Results results = run_cases("chain",
                                    {"end_to_end_square", "gyration_square", "bond_square", "extension",
                                     "stretch_square", "relaxation", "off_centre", "temperature", "speed"},
                                    cases, options);
  // One column of a case over a number, a finding.
  const auto over = [&](const Chains& one, const char* column, double unit, const std::string& title,
                        int decimals) {
    std::vector<double> values = results.of(one.label(), column);
    for (double& value : values) value /= unit;
    return results.derived(one.label(), column, title, decimals, values);
  };
  // Slope of ln(column) over ln(of_beads), least squares over the cases of a kind.
  const auto exponent = [&](const std::string& kind, const char* column, double beads_less) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const Chains& one : all) {
      if (one.kind != kind || results.of(one.label(), column).empty()) continue;
      const double a = std::log(one.value - beads_less), b = std::log(results.mean(one.label(), column).mean);
      n += 1, x += a, y += b, xx += a * a, xy += a * b;
    }
    return n > 1 ? std::vector<double>{(n * xy - x * y) / (n * xx - x * x)} : std::vector<double>{};
  };

  Findings findings;
  for (const Chains& one : all) {
    const std::string label = one.label();
    if (one.kind == "ideal") {
      const double bond = thermal_square(engine::SpringLaw::of(harmonic_spring(), 1), 1), n = one.value;
      const double rouse = rouse_time(static_cast<std::uint32_t>(n), bond, gamma_of_study, 3, 1);
      findings.push_back(over(one, "bond_square", 1, "<b^2> (r_c^2)", 4)
                             .against_theory(reference(bond, 4, "Boltzmann"))
                             .within(0.01));
      findings.push_back(over(one, "end_to_end_square", (n - 1) * bond, "<R^2> / ((N - 1) <b^2>)", 3)
                             .against_theory({"1", "random walk"}));
      findings.push_back(
          over(one, "gyration_square", bond * (n * n - 1) / (6 * n), "6 N <R_g^2> / ((N^2 - 1) <b^2>)", 3)
              .against_theory({"1", "random walk"}));
      findings.push_back(over(one, "relaxation", 1, "time of the end-to-end vector (tau)", 2)
                             .against_theory(reference(rouse, 2, "Rouse, friction of a mean field")));
    } else if (one.kind == "solvent") {
      findings.push_back(over(one, "end_to_end_square", 1, "<R^2> in a good solvent (r_c^2)", 3));
      findings.push_back(over(one, "gyration_square", 1, "<R_g^2> in a good solvent (r_c^2)", 3));
      findings.push_back(over(one, "temperature", 1, "temperature (k_BT)", 4));
    } else if (one.kind == "pulled") {
      const engine::Spring spring = wlc_spring();
      const double contour = 10 * spring.max_length;
      findings.push_back(
          over(one, "extension", contour, "extension of the contour length", 4)
              .against_theory(reference(
                  thermal_extension(engine::SpringLaw::of(spring, 1), 1, one.value) / spring.max_length, 4,
                  "partition function of a bond"))
              .within(0.01));
      findings.push_back(
          results
              .derived(label, "marko_siggia", "the same beside one worm-like chain", 4,
                       over(one, "extension", contour, "", 4).values)
              .against_theory(reference(marko_siggia_extension(one.value, spring.persistence_length), 4,
                                        "Marko and Siggia")));
    } else {
      findings.push_back(over(one, "speed", 1, "speed (r_c/tau)", 3));
      findings.push_back(over(one, "stretch_square", 1, "<R_x^2> along the flow (r_c^2)", 2));
      findings.push_back(over(one, "end_to_end_square", 1, "<R^2> (r_c^2)", 2));
      findings.push_back(
          over(one, "off_centre", 1, "|z| of half the height", 3).against_theory({"0.5", "even"}));
      findings.push_back(over(one, "temperature", 1, "temperature across the flow (k_BT)", 3));
    }
  }
  // Liquid that keeps its momentum drags the beads of a chain along: Zimm's 3 nu, not Rouse's 2.
  findings.push_back(results
                         .derived("ideal", "relaxation_exponent", "relaxation time goes with N to the", 2,
                                  exponent("ideal", "relaxation", 0))
                         .against_theory({"1.5", "Zimm"}));
  findings.push_back(results
                         .derived("solvent", "nu", "nu of <R^2> over the number of bonds", 3,
                                  [&] {
                                    std::vector<double> twice = exponent("solvent", "end_to_end_square", 1);
                                    for (double& value : twice) value /= 2;
                                    return twice;
                                  }())
                         .against_theory({"0.588", "long chains"}));
  return findings;
}

}  // namespace dmf::tools
