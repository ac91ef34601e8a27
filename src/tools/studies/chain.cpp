#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "tools/chain_run.h"
#include "tools/study.h"

namespace dmf::tools {
namespace {

constexpr double gamma_of_study = 4.5;  // of a random amplitude of 3 at k_BT = 1

struct Case {
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

ChainRun run_of(const Case& one, const StudyOptions& options, int seed) {
  ChainRun run;
  run.seed = static_cast<std::uint64_t>(seed);
  run.time_step = options.time_step;
  run.integrator = options.integrator;
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

void study_chain(const StudyOptions& options) {
  std::vector<Case> cases;
  for (const double beads : {5, 10, 20, 30}) cases.push_back({"ideal", beads});
  for (const double beads : {5, 8, 13, 20}) cases.push_back({"solvent", beads});
  for (const double force : {1, 3, 10, 20, 40}) cases.push_back({"pulled", force});
  for (const double gravity : {0.0, 0.02, 0.05}) cases.push_back({"channel", gravity});
  std::vector<std::string> labels;
  for (const Case& one : cases) labels.push_back(one.label());
  require_known(options, labels);

  ResultTable table(options.output + "/chain_runs.csv",
                    {"end_to_end_square", "gyration_square", "bond_square", "extension", "stretch_square",
                     "relaxation", "off_centre", "temperature", "speed"});
  const auto key = [&](const Case& one, int seed) {
    return fmt::format("{}{} seed={}", one.label(), options_key(options), seed);
  };
  std::vector<Job> jobs;
  for (const Case& one : cases) {
    if (!is_wanted(options, one.label())) continue;
    for (int seed = 1; seed <= options.seeds; ++seed)
      jobs.push_back({key(one, seed), [=] {
                        const ChainResult r = run_chains(run_of(one, options, seed));
                        return std::vector<double>{r.end_to_end_square, r.gyration_square, r.bond_square,
                                                   r.extension,         r.stretch_square,  r.relaxation,
                                                   r.off_centre,        r.temperature,     r.speed};
                      }});
  }
  run_jobs("chain", jobs, options, table);

  const auto mean = [&](const Case& one, int column) {
    std::vector<double> values;
    for (int seed = 1; seed <= options.seeds; ++seed) values.push_back(table.row(key(one, seed))[column]);
    return mean_and_spread(values);
  };
  // Slope of ln(value) over ln(beads), least squares.
  const auto exponent = [&](const std::string& kind, int column, auto of_beads) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const Case& one : cases) {
      if (one.kind != kind || !is_wanted(options, one.label())) continue;
      const double a = std::log(of_beads(one.value)), b = std::log(mean(one, column).mean);
      n += 1, x += a, y += b, xx += a * a, xy += a * b;
    }
    return (n * xy - x * y) / (n * xx - x * x);
  };
  const auto wanted = [&](const std::string& kind) {
    int count = 0;
    for (const Case& one : cases) count += one.kind == kind && is_wanted(options, one.label());
    return count;
  };

  if (wanted("ideal") > 0)
    fmt::print(
        "ideal chains in a melt of their own: <R^2> / ((N - 1) <b^2>), <R_g^2> likewise, and the time "
        "of the end-to-end vector against Rouse's\n");
  for (const Case& one : cases) {
    if (one.kind != "ideal" || !is_wanted(options, one.label())) continue;
    const double bond = thermal_square(engine::SpringLaw::of(harmonic_spring(), 1), 1), n = one.value;
    const MeanAndSpread r2 = mean(one, 0), g2 = mean(one, 1), b2 = mean(one, 2), time = mean(one, 5);
    const double rouse = rouse_time(static_cast<std::uint32_t>(n), bond, gamma_of_study, 3, 1);
    fmt::print(
        "N {:>3g}: R^2 {:.3f} +- {:.3f}, R_g^2 {:.3f} +- {:.3f}, <b^2> {:.4f} (theory {:.4f}), time {:.3g} "
        "+- "
        "{:.1g} (Rouse {:.3g})\n",
        n, r2.mean / ((n - 1) * bond), r2.deviation / ((n - 1) * bond),
        g2.mean / (bond * (n * n - 1) / (6 * n)), g2.deviation / (bond * (n * n - 1) / (6 * n)), b2.mean,
        bond, time.mean, time.deviation, rouse);
  }
  if (wanted("ideal") > 1)
    fmt::print(
        "time goes with N^{:.2f} (Rouse 2, Zimm 1.5: liquid that keeps its momentum drags beads along)\n",
        exponent("ideal", 5, [](double n) { return n; }));

  if (wanted("solvent") > 1) {
    fmt::print("chains in a good solvent (plain DPD, a = 25 for all):\n");
    for (const Case& one : cases) {
      if (one.kind != "solvent" || !is_wanted(options, one.label())) continue;
      const MeanAndSpread r2 = mean(one, 0), g2 = mean(one, 1);
      fmt::print("N {:>3g}: R^2 {:.3f} +- {:.3f}, R_g^2 {:.3f} +- {:.3f}, temperature {:.4f}\n", one.value,
                 r2.mean, r2.deviation, g2.mean, g2.deviation, mean(one, 7).mean);
    }
    const auto bonds = [](double n) { return n - 1; };
    fmt::print("nu from R {:.3f}, from R_g {:.3f} (0.588 of long chains, 0.5 of ideal ones)\n",
               0.5 * exponent("solvent", 0, bonds), 0.5 * exponent("solvent", 1, bonds));
  }

  if (wanted("pulled") > 0)
    fmt::print(
        "worm-like chains of ten bonds pulled at their ends: extension of the contour length, exact for "
        "such bonds, and of one worm-like chain (Marko and Siggia)\n");
  for (const Case& one : cases) {
    if (one.kind != "pulled" || !is_wanted(options, one.label())) continue;
    const engine::Spring spring = wlc_spring();
    const double contour = 10 * spring.max_length;
    const MeanAndSpread x = mean(one, 3);
    fmt::print("f {:>4g}: {:.4f} +- {:.4f}, exact {:.4f}, Marko and Siggia {:.4f}\n", one.value,
               x.mean / contour, x.deviation / contour,
               thermal_extension(engine::SpringLaw::of(spring, 1), 1, one.value) / spring.max_length,
               marko_siggia_extension(one.value, spring.persistence_length));
  }

  if (wanted("channel") > 0)
    fmt::print("worm-like chains of 15 beads in a channel of height 8 under a body force:\n");
  for (const Case& one : cases) {
    if (one.kind != "channel" || !is_wanted(options, one.label())) continue;
    const MeanAndSpread x2 = mean(one, 4), r2 = mean(one, 0), off = mean(one, 6), speed = mean(one, 8);
    fmt::print(
        "g {:>4g}: speed {:.3f}, R_x^2 {:.2f} +- {:.2f} of R^2 {:.2f}, |z| of half the height {:.3f} +- "
        "{:.3f}, "
        "temperature across {:.3f}\n",
        one.value, speed.mean, x2.mean, x2.deviation, r2.mean, off.mean, off.deviation, mean(one, 7).mean);
  }
}

}  // namespace dmf::tools
