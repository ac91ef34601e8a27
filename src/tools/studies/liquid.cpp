#include "tools/liquid.h"

#include <fmt/format.h>

#include "engine/parameters.h"
#include "tools/study.h"

namespace dmf::tools {

void study_liquid(const StudyOptions& options) {
  const double radius = options.radius > 0 ? options.radius : 8;
  ResultTable films(options.output + "/liquid_film_runs.csv", {"density", "tension", "normal_pressure"});
  ResultTable droplets(options.output + "/liquid_droplet_runs.csv",
                       {"density", "pressure", "radius", "temperature", "momentum"});
  ResultTable bulks(options.output + "/liquid_bulk_runs.csv",
                    {"density", "temperature", "pressure", "viscosity"});
  const auto how = [options](int seed) {
    return LiquidRun{static_cast<std::uint64_t>(seed),
                     options.time_step,
                     options.lambda,
                     options.quick,
                     options.integrator,
                     options.list_skin};
  };
  const auto key = [&](const char* what, int seed) {
    return fmt::format("{} dt={}{} lambda={} seed={}", what, options.time_step,
                       integrator_key(options.integrator),
                       options.lambda > 0 ? options.lambda : engine::Parameters{}.integrator_lambda, seed);
  };
  const std::string droplet = fmt::format("droplet R={}", radius);
  std::vector<Job> film_jobs, droplet_jobs, bulk_jobs;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    film_jobs.push_back({key("film", seed), [=] {
                           const FilmResult r = run_film(how(seed));
                           return std::vector<double>{r.density, r.tension, r.normal_pressure};
                         }});
    droplet_jobs.push_back(
        {key(droplet.c_str(), seed), [=] {
           const FreeDropletResult r = run_free_droplet(how(seed), radius);
           return std::vector<double>{r.density, r.pressure, r.radius, r.temperature, r.momentum};
         }});
    bulk_jobs.push_back({key("bulk", seed), [=] {
                           const BulkResult r = run_bulk(how(seed));
                           return std::vector<double>{r.density, r.temperature, r.pressure, r.viscosity};
                         }});
  }
  run_jobs("film", film_jobs, options, films);
  run_jobs("free droplet", droplet_jobs, options, droplets);
  run_jobs("bulk", bulk_jobs, options, bulks);

  const auto column_of = [](const ResultTable& table, const std::vector<Job>& jobs, std::size_t column) {
    std::vector<double> values;
    for (const Job& job : jobs) values.push_back(table.row(job.key).at(column));
    return values;
  };
  const auto print = [](const char* what, const std::vector<double>& values) {
    const MeanAndSpread result = mean_and_spread(values);
    fmt::print("{:<58} {:10.4g} +- {:.2g}\n", what, result.mean, result.deviation);
  };
  const auto pressures = column_of(droplets, droplet_jobs, 1), radii = column_of(droplets, droplet_jobs, 2),
             normal_pressures = column_of(films, film_jobs, 2);
  const double zero_pressure = mean_and_spread(normal_pressures).mean;
  std::vector<double> laplace;
  for (std::size_t k = 0; k < radii.size(); ++k)
    laplace.push_back((pressures[k] - zero_pressure) * radii[k] / 2);

  fmt::print("{} seeds, dt {}\n", options.seeds, options.time_step);
  print("bulk temperature (k_BT)", column_of(bulks, bulk_jobs, 1));
  print("bulk density of the box (1/r_c^3)", column_of(bulks, bulk_jobs, 0));
  print("bulk pressure at that density (k_BT/r_c^3)", column_of(bulks, bulk_jobs, 2));
  print("viscosity (m / (r_c tau))", column_of(bulks, bulk_jobs, 3));
  print("density inside the film", column_of(films, film_jobs, 0));
  print("surface tension, flat film (k_BT/r_c^2)", column_of(films, film_jobs, 1));
  print("density inside the free droplet", column_of(droplets, droplet_jobs, 0));
  print("surface tension, Laplace (k_BT/r_c^2)", laplace);
  print("normal pressure of the film: error of the time step", normal_pressures);
  print("temperature of the free droplet", column_of(droplets, droplet_jobs, 3));
  print("momentum of the free droplet at the end (m r_c/tau)", column_of(droplets, droplet_jobs, 4));
}

}  // namespace dmf::tools
