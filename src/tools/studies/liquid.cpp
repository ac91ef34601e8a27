#include "tools/liquid.h"

#include <fmt/format.h>

#include "tools/cases.h"

namespace dmf::tools {

Findings study_liquid(const StudyOptions& options) {
  const double radius = options.radius_or(8);
  const auto how = [&options](std::uint64_t seed) {
    LiquidRun run;
    run.seed = seed;
    run.time_step = options.time_step_or(run.time_step);
    run.lambda = options.lambda;
    run.quick = options.quick;
    run.integrator = options.integrator.value_or(run.integrator);
    run.list_skin = options.list_skin;
    return run;
  };
  const StudyOptions all = without_only(options);
  const Results films = run_cases("liquid_film", {"density", "tension", "normal_pressure"},
                                  {{"film",
                                    [&](std::uint64_t seed) {
                                      const FilmResult r = run_film(how(seed));
                                      return std::vector<double>{r.density, r.tension, r.normal_pressure};
                                    }}},
                                  all);
  const Results droplets =
      run_cases("liquid_droplet", {"density", "pressure", "radius", "temperature", "momentum"},
                {{"droplet",
                  [&](std::uint64_t seed) {
                    const FreeDropletResult r = run_free_droplet(how(seed), radius);
                    return std::vector<double>{r.density, r.pressure, r.radius, r.temperature, r.momentum};
                  }}},
                all);
  const Results bulks =
      run_cases("liquid_bulk", {"density", "temperature", "pressure", "viscosity"},
                {{"bulk",
                  [&](std::uint64_t seed) {
                    const BulkResult r = run_bulk(how(seed));
                    return std::vector<double>{r.density, r.temperature, r.pressure, r.viscosity};
                  }}},
                all);

  // Laplace's law against the film's normal pressure, which the time step shifts from zero.
  const double zero_pressure = films.mean("film", "normal_pressure").mean;
  std::vector<double> laplace = droplets.of("droplet", "pressure");
  const std::vector<double> radii = droplets.of("droplet", "radius");
  for (std::size_t k = 0; k < laplace.size(); ++k) laplace[k] = (laplace[k] - zero_pressure) * radii[k] / 2;

  const double tension = films.mean("film", "tension").mean;
  return {
      bulks.finding("bulk", "temperature", "temperature (k_BT)", 4).against_theory({"1", "set"}).within(0.01),
      bulks.finding("bulk", "density", "density of the box (1/r_c^3)", 3),
      bulks.finding("bulk", "pressure", "pressure at that density (k_BT/r_c^3)", 2),
      bulks.finding("bulk", "viscosity", "viscosity (m/(r_c tau))", 1),
      films.finding("film", "density", "density inside (1/r_c^3)", 3)
          .against_theory({"6.0 to 6.1", "known of this liquid"})
          .within(0.01),
      films.finding("film", "tension", "surface tension (k_BT/r_c^2)", 2)
          .against_theory({"about 7.5", "known of this liquid"})
          .within(0.02),
      films.finding("film", "normal_pressure", "normal pressure: error of the time step (k_BT/r_c^3)", 2),
      droplets.finding("droplet", "density", "density inside (1/r_c^3)", 3),
      droplets.derived("droplet", "tension", "surface tension by Laplace's law (k_BT/r_c^2)", 2, laplace)
          .against_theory(reference(tension, 2, "the film's")),
      droplets.finding("droplet", "temperature", "temperature (k_BT)", 4)
          .against_theory({"1", "set"})
          .within(0.01),
      droplets.finding("droplet", "momentum", "momentum at the end, of all beads (m r_c/tau)", 4)
          .against_theory({"0", "kept"})
          .within_margin(0.02)};
}

}  // namespace dmf::tools
