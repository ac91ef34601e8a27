#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "chip/configuration.h"
#include "tools/infiltration.h"
#include "tools/study.h"

namespace dmf::tools {
namespace {

struct Case {
  PoreSpace space;
  double angle, acceleration;

  std::string label() const {
    return fmt::format("{} theta={:g} g={:g}", space == PoreSpace::slit ? "slit" : "grains", angle,
                       acceleration);
  }
};

/// By itself at three angles; pushed where it does not wet, below and above what its entry takes.
const std::vector<Case> all{{PoreSpace::slit, 50, 0},      {PoreSpace::slit, 130, 0},
                            {PoreSpace::grains, 50, 0},    {PoreSpace::grains, 90, 0},
                            {PoreSpace::grains, 130, 0},   {PoreSpace::grains, 130, 0.01},
                            {PoreSpace::grains, 130, 0.06}};

InfiltrationRun run_of(const StudyOptions& options, const Case& one, int seed) {
  InfiltrationRun run;
  run.space = one.space;
  run.contact_angle = one.angle;
  run.acceleration = one.acceleration;
  if (one.space == PoreSpace::slit) run.width = 8;
  if (options.quick) run.time = 30;
  run.seed = static_cast<std::uint64_t>(seed);
  run.parameters.time_step = options.time_step;
  run.parameters.integrator = options.integrator;
  run.parameters.list_skin = options.list_skin;
  if (options.lambda > 0) run.parameters.integrator_lambda = options.lambda;
  return run;
}

}  // namespace

void study_infiltration(const StudyOptions& options) {
  const engine::ContactAngleCurve curve =
      options.calibration == "lan2016"
          ? engine::ContactAngleCurve::lan2016()
          : engine::ContactAngleCurve::load(chip::find_config("calibration", options.calibration));
  std::vector<std::string> labels;
  for (const Case& one : all) labels.push_back(one.label());
  require_known(options, labels);
  ResultTable table(options.output + "/infiltration_runs.csv", {"filled"});
  const auto key = [&](const Case& one, int seed) {
    return fmt::format("{}{} seed={}", one.label(), options_key(options), seed);
  };
  std::vector<Job> jobs;
  for (const Case& one : all) {
    if (!is_wanted(options, one.label())) continue;
    for (int seed = 1; seed <= options.seeds; ++seed)
      jobs.push_back({key(one, seed), [=, &options, &curve] {
                        std::string name = key(one, seed);
                        std::replace(name.begin(), name.end(), ' ', '_');
                        std::ofstream csv(fmt::format("{}/infiltration_{}.csv", options.output, name));
                        csv << "time,filled\n";
                        return row_or_nan(name, 1, [&] {
                          return std::vector<double>{run_infiltration(
                              run_of(options, one, seed), curve, [&](const InfiltrationSample& seen) {
                                csv << fmt::format("{:.6g},{:.6g}\n", seen.time, seen.share);
                              })};
                        });
                      }});
  }
  run_jobs("infiltration", jobs, options, table);

  fmt::print("{:<26} {:>18} {:>16} {:>16} {:>12}\n", "", "filled", "entry pressure", "pushed by", "Washburn");
  for (const Case& one : all) {
    if (!is_wanted(options, one.label())) continue;
    std::vector<double> filled;
    for (int seed = 1; seed <= options.seeds; ++seed) filled.push_back(table.row(key(one, seed))[0]);
    const MeanAndSpread share = mean_and_spread(filled);
    const InfiltrationRun run = run_of(options, one, 1);
    const engine::LiquidParameters& liquid = run.parameters.liquid;
    const double depth =
        washburn_depth(liquid.surface_tension, liquid.viscosity, one.angle, run.gap, run.time);
    fmt::print("{:<26} {:>10.3f} +- {:<5.3f} {:>16.2f} {:>16.2f} {:>12}\n", one.label(), share.mean,
               share.deviation, entry_pressure(liquid.surface_tension, one.angle, run.gap),
               liquid.bulk_density * one.acceleration * run.slug,
               one.space == PoreSpace::slit ? fmt::format("{:.3f}", depth / run.depth) : "");
  }
}

}  // namespace dmf::tools
