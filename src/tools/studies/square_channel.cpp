#include <fmt/format.h>

#include <fstream>

#include "tools/cases.h"
#include "tools/duct.h"

namespace dmf::tools {
namespace {

const std::vector<double> repulsions{9.68, 18};  // of fluid and wall: the ends of Chen's range

std::string label_of(double repulsion) { return fmt::format("a_AW={:g}", repulsion); }

DuctRun duct_run(const StudyOptions& options, double repulsion, std::uint64_t seed) {
  DuctRun run{scene_for(options, "square_channel"), seed};
  run.scene.parameters.label_grid.attraction = repulsion;
  if (options.quick) {
    lay_duct(6, run.half_width(), run.scene);
    run.settle = 40;
    run.measure = 10;
  }
  return run;
}

void write_profile(const StudyOptions& options, const DuctRun& run, const DuctResult& result) {
  std::ofstream csv(fmt::format("{}/square_channel_a{:g}_seed{}.csv", options.output,
                                run.scene.parameters.label_grid.attraction.value(), run.seed));
  csv << "y,z,velocity,theory,density\n";
  const double strength = 4 * run.acceleration() / result.viscosity;
  for (int z = 0; z < result.cells; ++z)
    for (int y = 0; y < result.cells; ++y) {
      const std::size_t cell = static_cast<std::size_t>(z) * result.cells + y;
      const double at_y = result.middle(y), at_z = result.middle(z);
      csv << fmt::format("{},{},{:.6g},{:.6g},{:.6g}\n", at_y, at_z, result.velocity[cell],
                         strength * duct_velocity(at_y, at_z, result.fitted_width, result.fitted_width),
                         result.density[cell]);
    }
}

}  // namespace

Findings study_square_channel(const StudyOptions& options) {
  std::vector<Case> cases;
  for (const double repulsion : repulsions)
    cases.push_back({label_of(repulsion), [=, &options](std::uint64_t seed) {
                       const DuctRun run = duct_run(options, repulsion, seed);
                       const DuctResult result = run_duct(run);
                       write_profile(options, run, result);
                       return std::vector<double>{result.mass_flow, result.viscosity,   result.fitted_width,
                                                  result.deviation, result.temperature, result.densest};
                     }});
  const Results results =
      run_cases("square_channel",
                {"mass_flow", "viscosity", "fitted_half_width", "deviation", "temperature", "wall_density"},
                cases, options);
  Findings findings;
  for (const double repulsion : repulsions) {
    const std::string label = label_of(repulsion);
    findings.push_back(results.finding(label, "mass_flow", "mass flow (m/tau)", 0)
                           .against_paper({"3416", "Chen"})
                           .within(0.02));
    findings.push_back(
        results
            .finding(label, "deviation", "profile off the series of a duct, rms of the largest velocity", 4)
            .against_theory({"0 to 0.025", "Chen: within 2.5 % of a finite-volume solver"}));
    findings.push_back(
        results.finding(label, "fitted_half_width", "half width at which the profile vanishes (r_c)", 2)
            .against_theory({"10", "no slip"})
            .within(0.02));
    findings.push_back(results.finding(label, "viscosity", "viscosity of the fit (m/(r_c tau))", 2));
    findings.push_back(results.finding(label, "temperature", "temperature across the flow (k_BT)", 4));
    findings.push_back(
        results.finding(label, "wall_density", "density of the cells at the walls, of the mean", 3));
  }
  return findings;
}

}  // namespace dmf::tools
