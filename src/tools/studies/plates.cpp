#include <fmt/format.h>

#include "tools/cases.h"
#include "tools/liquid.h"
#include "tools/pancake.h"

namespace dmf::tools {
namespace {

struct Pancake {
  double gap, angle;

  std::string label() const { return fmt::format("gap={} angle={}", gap, angle); }
};

}  // namespace

Findings study_plates(const StudyOptions& options) {
  const engine::ContactAngleCurve curve = curve_for(options);
  const std::vector<Pancake> all =
      options.quick ? std::vector<Pancake>{{6, 120}}
                    : std::vector<Pancake>{{4, 70}, {4, 90},  {4, 110}, {4, 130}, {6, 70},
                                           {6, 90}, {6, 110}, {6, 130}, {8, 110}, {8, 130}};
  const Results films = run_cases("plates_film", {"tension", "normal_pressure"},
                                  {{"film",
                                    [&](std::uint64_t seed) {
                                      LiquidRun film;
                                      film.seed = seed;
                                      film.time_step = options.time_step_or(film.time_step);
                                      film.quick = options.quick;
                                      const FilmResult result = run_film(film);
                                      return std::vector<double>{result.tension, result.normal_pressure};
                                    }}},
                                  without_only(options));
  std::vector<Case> cases;
  for (const Pancake& one : all)
    cases.push_back({one.label(), [=, &options, &curve](std::uint64_t seed) {
                       PancakeRun run;
                       run.radius = options.radius_or(run.radius);
                       run.time_step = options.time_step_or(run.time_step);
                       if (options.quick) run.radius = 8, run.settle = 10, run.measure = 10;
                       run.gap = one.gap;
                       run.contact_angle = one.angle;
                       run.seed = seed;
                       const PancakeResult r = run_pancake(run, curve);
                       return std::vector<double>{r.density, r.pressure, r.wall_distance, r.equator};
                     }});
  const Results results =
      run_cases("plates", {"density", "pressure", "wall_distance", "equator"}, cases, options);

  const double tension = films.mean("film", "tension").mean,
               at_rest = films.mean("film", "normal_pressure").mean;
  Findings findings;
  for (const Pancake& one : all) {
    std::vector<double> pressures = results.of(one.label(), "pressure"), laplace;
    const std::vector<double> distances = results.of(one.label(), "wall_distance"),
                              equators = results.of(one.label(), "equator");
    for (std::size_t k = 0; k < pressures.size(); ++k) {
      pressures[k] -= at_rest;
      laplace.push_back(tension * bridge_pressure(one.gap - 2 * distances[k], one.angle, equators[k]));
    }
    findings.push_back(
        results.derived(one.label(), "pressure", "pressure, over a film's (k_BT/r_c^3)", 2, pressures)
            .against_theory(reference(mean_and_spread(laplace).mean, 2, "Young and Laplace"))
            .within_margin(0.15));
    findings.push_back(results.finding(one.label(), "wall_distance", "keeps off the plates (r_c)", 2));
    findings.push_back(results.finding(one.label(), "equator", "radius half-way (r_c)", 2));
    findings.push_back(results.finding(one.label(), "density", "density (1/r_c^3)", 3));
  }
  return findings;
}

}  // namespace dmf::tools
