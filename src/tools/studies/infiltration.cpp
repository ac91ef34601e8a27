#include <fmt/format.h>

#include <fstream>

#include "tools/cases.h"
#include "tools/infiltration.h"
#include "tools/saved_run.h"

namespace dmf::tools {
namespace {

struct Pores {
  PoreSpace space;
  double angle, acceleration;

  std::string label() const {
    return fmt::format("{} theta={:g} g={:g}", space == PoreSpace::slit ? "slit" : "grains", angle,
                       acceleration);
  }
};

/// By itself at three angles; pushed where it does not wet, below and above what its entry takes.
const std::vector<Pores> all{{PoreSpace::slit, 50, 0},      {PoreSpace::slit, 130, 0},
                             {PoreSpace::grains, 50, 0},    {PoreSpace::grains, 90, 0},
                             {PoreSpace::grains, 130, 0},   {PoreSpace::grains, 130, 0.01},
                             {PoreSpace::grains, 130, 0.06}};

InfiltrationRun run_of(const StudyOptions& options, const Pores& one, std::uint64_t seed) {
  InfiltrationRun run;
  run.space = one.space;
  run.contact_angle = one.angle;
  run.acceleration = one.acceleration;
  if (one.space == PoreSpace::slit) run.width = 8;
  if (options.quick) run.time = 30;
  run.seed = seed;
  run.parameters.integrator = engine::Integrator::baoab;  // three times as cheap
  run.parameters.time_step = 0.03;
  apply(options, run.parameters);
  return run;
}

}  // namespace

Findings study_infiltration(const StudyOptions& options) {
  const engine::ContactAngleCurve curve = curve_for(options);
  std::vector<Case> cases;
  for (const Pores& one : all)
    cases.push_back({one.label(), [=, &options, &curve](std::uint64_t seed) {
                       std::ofstream csv(fmt::format("{}/infiltration_{}_seed{}.csv", options.output,
                                                     file_name(one.label() + options_key(options)), seed));
                       csv << "time,filled\n";
                       return std::vector<double>{run_infiltration(
                           run_of(options, one, seed), curve, [&](const InfiltrationSample& seen) {
                             csv << fmt::format("{:.6g},{:.6g}\n", seen.time, seen.share);
                           })};
                     }});
  const Results results = run_cases("infiltration", {"filled"}, cases, options);
  Findings findings;
  for (const Pores& one : all) {
    const InfiltrationRun run = run_of(options, one, 1);
    const engine::LiquidParameters& liquid = run.parameters.liquid;
    Finding filled = results.finding(
        one.label(), "filled", fmt::format("filled share of the pore space after {:g} tau", run.time), 3);
    const double entry = entry_pressure(liquid.surface_tension, one.angle, run.gap),
                 push = liquid.bulk_density * one.acceleration * run.slug;
    if (one.angle > 90 && push < entry)
      filled.against_theory(
          {"0 to 0.1", fmt::format("pushed with {:.2f}, entry pressure {:.2f}", push, entry)});
    else if (one.space == PoreSpace::slit)
      filled.against_theory(reference(
          washburn_depth(liquid.surface_tension, liquid.viscosity, one.angle, run.gap, run.time) / run.depth,
          3, "Lucas and Washburn"));
    findings.push_back(filled);
  }
  return findings;
}

}  // namespace dmf::tools
