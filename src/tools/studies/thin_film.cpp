#include <fmt/format.h>

#include "tools/cases.h"
#include "tools/sessile.h"

namespace dmf::tools {
namespace {

/// Wall attraction, and the angle that a run starts with, degrees.
struct Wall {
  double attraction, start;
};
const std::vector<Wall> walls{{-20, 57}, {-22.5, 28}, {-23.5, 17}, {-24, 20}, {-25, 20}};

std::string label_of(const Wall& wall) { return fmt::format("A={:g}", wall.attraction); }

SessileRun sessile_run(const StudyOptions& options, const Wall& wall, std::uint64_t seed) {
  SessileRun run;
  run.attraction = wall.attraction;
  run.radius = options.radius_or(7);
  run.starting_angle = wall.start;
  run.flat = true;
  run.seed = seed;
  run.settle = run.measure = options.quick ? 15 : 80;
  run.parameters.integrator = engine::Integrator::baoab;
  run.parameters.time_step = 0.03;
  apply(options, run.parameters);
  return run;
}

}  // namespace

Findings study_thin_film(const StudyOptions& options) {
  std::vector<Case> cases;
  for (const Wall& wall : walls)
    cases.push_back({label_of(wall), [=, &options](std::uint64_t seed) {
                       const SessileResult found = run_sessile(sessile_run(options, wall, seed));
                       return std::vector<double>{found.angle,
                                                  found.by_edge,
                                                  found.by_mean_height,
                                                  found.by_mean_height_first,
                                                  found.by_mean_height_second,
                                                  found.thickness,
                                                  found.temperature};
                     }});
  const Results results = run_cases(
      "thin_film",
      {"circle", "by_edge", "by_mean_height", "first_half", "second_half", "thickness", "temperature"}, cases,
      options);
  Findings findings;
  for (const Wall& wall : walls) {
    const std::string label = label_of(wall);
    const double by_circle = results.mean(label, "circle").mean;
    Finding by_height =
        results.finding(label, "by_mean_height", "contact angle by volume and mean height (degrees)", 1);
    // Where both measures work they are held against each other.
    if (wall.attraction >= -20)
      by_height.against_theory(reference(by_circle, 1, "circle through the surface")).within_margin(3);
    findings.push_back(by_height);
    findings.push_back(results.finding(label, "first_half", "in the first half of the measurement", 1));
    findings.push_back(results.finding(label, "second_half", "in the second half of the measurement", 1));
    findings.push_back(results.finding(label, "by_edge", "contact angle by volume and edge (degrees)", 1));
    findings.push_back(results.finding(label, "circle", "by a circle through the surface (degrees)", 1));
    findings.push_back(results.finding(label, "thickness", "thickness in the middle (r_c)", 2));
  }
  return findings;
}

}  // namespace dmf::tools
