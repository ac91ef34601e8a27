#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "chip/configuration.h"
#include "engine/wettability.h"
#include "tools/sessile.h"
#include "tools/study.h"

namespace dmf::tools {
namespace {

/// Lan (2.39) with its signs restored: a guess to start the cap from, and what to compare with. Degrees.
double lan_angle(double attraction) { return (552.125 - std::pow(attraction + 1.211, 2)) / 3.30033; }

SessileRun sessile_run(const StudyOptions& options, double attraction, double starting_angle, int seed) {
  SessileRun run;
  run.attraction = attraction;
  run.radius = options.radius > 0 ? options.radius : 10;
  run.starting_angle = std::clamp(starting_angle, 38.0, 155.0);
  run.seed = static_cast<std::uint64_t>(seed);
  run.settle = options.quick ? 40 : 120;
  run.measure = options.quick ? 40 : 160;
  run.parameters.time_step = options.time_step;
  run.parameters.integrator = options.integrator;
  if (options.list_skin > 0) run.parameters.list_skin = options.list_skin;
  if (options.lambda > 0) run.parameters.integrator_lambda = options.lambda;
  return run;
}

std::vector<double> row_of(const SessileResult& result) {
  return {result.angle, result.first_half, result.second_half, result.temperature};
}

const std::vector<std::string> columns{"angle_deg", "first_half_deg", "second_half_deg", "temperature"};

}  // namespace

void study_contact_angle(const StudyOptions& options) {
  const std::vector<double> attractions =
      options.quick
          ? std::vector<double>{-18, -10}
          : std::vector<double>{-22.5, -21.75, -21, -20, -19, -18, -16.5, -15, -13.5, -12, -10.5, -9.25, -8};
  ResultTable table(options.output + "/contact_angle_runs.csv", columns);
  const auto key = [&](double attraction, int seed) {
    const SessileRun run = sessile_run(options, attraction, 90, seed);
    return fmt::format("A={} R={} dt={}{} lambda={} seed={}", attraction, run.radius,
                       run.parameters.time_step, integrator_key(options.integrator),
                       run.parameters.integrator_lambda, seed);
  };
  std::vector<Job> jobs;
  for (int seed = 1; seed <= options.seeds; ++seed)
    for (const double attraction : attractions)
      jobs.push_back({key(attraction, seed), [=, &options] {
                        return row_of(
                            run_sessile(sessile_run(options, attraction, lan_angle(attraction), seed)));
                      }});
  run_jobs("contact_angle", jobs, options, table);

  fmt::print("{:>8} {:>10} {:>8} {:>12} {:>12} {:>8}\n", "A_lw", "angle", "+-", "first half", "second half",
             "Lan");
  std::string points;
  for (const double attraction : attractions) {
    std::vector<double> angles, first, second;
    for (int seed = 1; seed <= options.seeds; ++seed) {
      const std::vector<double>& row = table.row(key(attraction, seed));
      angles.push_back(row[0]);
      first.push_back(row[1]);
      second.push_back(row[2]);
    }
    const MeanAndSpread angle = mean_and_spread(angles);
    fmt::print("{:8.2f} {:10.2f} {:8.2f} {:12.2f} {:12.2f} {:8.2f}\n", attraction, angle.mean,
               angle.deviation, mean_and_spread(first).mean, mean_and_spread(second).mean,
               lan_angle(attraction));
    points += fmt::format("  - [{}, {:.2f}, {:.2f}]\n", attraction, angle.mean, angle.standard_error);
  }
  const std::string file = options.output + "/calibration.yaml";
  std::ofstream(file) << fmt::format(
      "description: static contact angle of an R = {} droplet over wall attraction A_lw, mean and standard "
      "error of {} seeds\n"
      "command: dmf_study contact_angle --seeds {} --radius {} --time-step {}\n"
      "# A_lw (k_BT / r_c), angle (degrees), standard error (degrees)\n"
      "points:\n{}",
      options.radius > 0 ? options.radius : 10, options.seeds, options.seeds,
      options.radius > 0 ? options.radius : 10, options.time_step, points);
  fmt::print("written: {}\n", file);
}

void study_commanded_angle(const StudyOptions& options) {
  const engine::ContactAngleCurve curve =
      options.calibration == "lan2016"
          ? engine::ContactAngleCurve::lan2016()
          : engine::ContactAngleCurve::load(chip::find_config("calibration", options.calibration));
  const std::vector<double> angles =
      options.quick ? std::vector<double>{70, 130} : std::vector<double>{50, 70, 90, 110, 130, 145};
  ResultTable table(options.output + "/commanded_angle_runs.csv", columns);
  const auto key = [&](double angle, int seed) {
    return fmt::format("commanded={} A={:.6f} R={} dt={}{} seed={}", angle, curve.attraction(angle),
                       options.radius > 0 ? options.radius : 10, options.time_step,
                       integrator_key(options.integrator), seed);
  };
  std::vector<Job> jobs;
  // Seeds that the calibration has not seen.
  for (int seed = 101; seed <= 100 + options.seeds; ++seed)
    for (const double angle : angles)
      jobs.push_back({key(angle, seed), [=, &options] {
                        return row_of(
                            run_sessile(sessile_run(options, curve.attraction(angle), angle, seed)));
                      }});
  run_jobs("commanded_angle", jobs, options, table);

  fmt::print("{:>10} {:>10} {:>8} {:>8}\n", "commanded", "shown", "+-", "off by");
  for (const double angle : angles) {
    std::vector<double> shown;
    for (int seed = 101; seed <= 100 + options.seeds; ++seed) shown.push_back(table.row(key(angle, seed))[0]);
    const MeanAndSpread mean = mean_and_spread(shown);
    fmt::print("{:10.1f} {:10.2f} {:8.2f} {:+8.2f}\n", angle, mean.mean, mean.deviation, mean.mean - angle);
  }
}

}  // namespace dmf::tools
