#include <fmt/format.h>

#include <cmath>

#include "chip/configuration.h"
#include "tools/liquid.h"
#include "tools/pancake.h"
#include "tools/study.h"

namespace dmf::tools {
namespace {

struct Case {
  double gap, angle;
};

}  // namespace

void study_plates(const StudyOptions& options) {
  const engine::ContactAngleCurve curve =
      options.calibration == "lan2016"
          ? engine::ContactAngleCurve::lan2016()
          : engine::ContactAngleCurve::load(chip::find_config("calibration", options.calibration));
  const std::vector<Case> cases = options.quick
                                      ? std::vector<Case>{{6, 120}}
                                      : std::vector<Case>{{4, 70}, {4, 90},  {4, 110}, {4, 130}, {6, 70},
                                                          {6, 90}, {6, 110}, {6, 130}, {8, 110}, {8, 130}};
  PancakeRun usual;
  if (options.radius > 0) usual.radius = options.radius;
  usual.time_step = options.time_step;
  if (options.quick) usual.radius = 8, usual.settle = 10, usual.measure = 10;
  ResultTable table(options.output + "/plates_runs.csv", {"density", "pressure", "wall_distance", "equator"});
  ResultTable films(options.output + "/plates_film.csv", {"tension", "normal_pressure"});
  const auto key = [&](const Case& one, int seed) {
    return fmt::format("gap={} angle={} R={} dt={} seed={}", one.gap, one.angle, usual.radius,
                       options.time_step, seed);
  };
  const std::string film_key = fmt::format("film dt={} quick={}", options.time_step, options.quick);
  LiquidRun film;
  film.time_step = options.time_step;
  film.quick = options.quick;
  run_jobs("plates: film",
           {{film_key,
             [&] {
               const FilmResult result = run_film(film);
               return std::vector<double>{result.tension, result.normal_pressure};
             }}},
           options, films);
  const double tension = films.row(film_key)[0], at_rest = films.row(film_key)[1];
  std::vector<Job> jobs;
  for (int seed = 1; seed <= options.seeds; ++seed)
    for (const Case& one : cases)
      jobs.push_back({key(one, seed), [&, one, seed] {
                        PancakeRun run = usual;
                        run.gap = one.gap;
                        run.contact_angle = one.angle;
                        run.seed = static_cast<std::uint64_t>(seed);
                        const PancakeResult result = run_pancake(run, curve);
                        return std::vector<double>{result.density, result.pressure, result.wall_distance,
                                                   result.equator};
                      }});
  run_jobs("plates", jobs, options, table);

  fmt::print("tension {:.3f}, stress of a film at rest {:.3f}\n", tension, at_rest);
  fmt::print("{:>5} {:>6} {:>10} {:>10} {:>8} {:>10} {:>8} {:>8} {:>8}\n", "gap", "angle", "pressure",
             "Laplace's", "off by", "keeps off", "+-", "equator", "density");
  for (const Case& one : cases) {
    std::vector<double> pressures, expected, distances, equators, densities;
    for (int seed = 1; seed <= options.seeds; ++seed) {
      const std::vector<double>& row = table.row(key(one, seed));
      pressures.push_back(row[1] - at_rest);
      expected.push_back(tension * bridge_pressure(one.gap - 2 * row[2], one.angle, row[3]));
      distances.push_back(row[2]);
      equators.push_back(row[3]);
      densities.push_back(row[0]);
    }
    const double pressure = mean_and_spread(pressures).mean, laplace = mean_and_spread(expected).mean;
    fmt::print("{:5} {:6} {:10.3f} {:10.3f} {:+8.3f} {:10.3f} {:8.3f} {:8.2f} {:8.3f}\n", one.gap, one.angle,
               pressure, laplace, pressure - laplace, mean_and_spread(distances).mean,
               mean_and_spread(distances).deviation, mean_and_spread(equators).mean,
               mean_and_spread(densities).mean);
  }
}

}  // namespace dmf::tools
