#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "chip/configuration.h"
#include "engine/wettability.h"
#include "tools/structured_wall.h"
#include "tools/study.h"

namespace dmf::tools {
namespace {

/// One row of the study: what is varied, and what Yao found.
struct Case {
  std::string label;
  double attraction, spacing, force, drive;  ///< spacing 0: smooth
};

/// Yao's f_s are those of ridges 4 wide, whole numbers apart: 3, 5, 9, 11 are 0.571, 0.444, 0.308, 0.267.
std::vector<Case> cases(bool quick, const engine::ContactAngleCurve& curve) {
  const double drive = quick ? 20 : 2000;
  std::vector<Case> all;
  // Figure 4: static angles at f_s 0.444, beside those of the smooth wall in the same slab.
  for (const double attraction : {-11.0, -13.0, -15.0, -17.0})
    for (const double s : {0.0, 5.0})
      all.push_back({fmt::format("static A={:g} S={:g}", attraction, s), attraction, s, 0, 0});
  // Figure 5: against the smooth wall, at two angles.
  for (const auto& [angle, spacing] : {std::pair{130.59, 5.0}, {67.84, 9.0}})
    for (const double s : {0.0, spacing})
      all.push_back(
          {fmt::format("order theta={:g} S={:g}", angle, s), curve.attraction(angle), s, 0.0008, drive});
  // Figure 7: velocity over f_s.
  for (const double attraction : {-13.0, -14.0, -15.0})
    for (const double spacing : {3.0, 5.0, 9.0, 11.0, 13.0})
      all.push_back(
          {fmt::format("optimum A={:g} S={:g}", attraction, spacing), attraction, spacing, 0.0007, drive});
  return all;
}

StructuredWallRun run_of(const StudyOptions& options, const Case& one, int seed) {
  StructuredWallRun run;
  run.attraction = one.attraction;
  run.spacing = one.spacing;
  run.force = one.force;
  run.drive = one.drive;
  run.length = one.drive > 0 ? 200 : 100;
  run.settle = options.quick ? 40 : 150;
  run.rest = options.quick ? 10 : 150;
  run.seed = static_cast<std::uint64_t>(seed);
  run.parameters.time_step = options.time_step;
  run.parameters.integrator = options.integrator;
  if (options.lambda > 0) run.parameters.integrator_lambda = options.lambda;
  return run;
}

std::string file_name(std::string key) {
  for (char& c : key)
    if (c == ' ' || c == '/') c = '_';
  return key;
}

}  // namespace

void study_structured_wall(const StudyOptions& options) {
  const engine::ContactAngleCurve curve =
      options.calibration == "lan2016"
          ? engine::ContactAngleCurve::lan2016()
          : engine::ContactAngleCurve::load(chip::find_config("calibration", options.calibration));
  const std::vector<Case> all = cases(options.quick, curve);
  std::vector<std::string> labels;
  for (const Case& one : all) labels.push_back(one.label);
  require_known(options, labels);
  ResultTable table(options.output + "/structured_wall_runs.csv",
                    {"angle", "difference", "sunk", "velocity"});
  const auto key = [&](const Case& one, int seed) {
    return fmt::format("{}{} seed={}", one.label, options_key(options), seed);
  };
  std::vector<Job> jobs;
  for (const Case& one : all) {
    if (!is_wanted(options, one.label)) continue;
    for (int seed = 1; seed <= options.seeds; ++seed)
      jobs.push_back(
          {key(one, seed), [=, &options] {
             std::ofstream csv;
             const auto sample = [&](const FrontSample& seen) {
               if (!csv.is_open()) {
                 csv.open(options.output + "/structured_wall_" + file_name(key(one, seed)) + ".csv");
                 csv << "time,centre,front,angle\n";
               }
               csv << fmt::format("{:.6g},{:.6g},{:.6g},{:.6g}\n", seen.time, seen.centre, seen.front,
                                  seen.angle);
             };
             return row_or_nan(key(one, seed), 4, [&] {
               const StructuredWallResult result = run_structured_wall(run_of(options, one, seed), sample);
               return std::vector<double>{result.angle, result.difference, result.sunk, result.velocity};
             });
           }});
  }
  run_jobs("structured_wall", jobs, options, table);

  fmt::print("ridges 4 wide, 1 high; Cassie-Baxter from the calibrated angle of the smooth wall\n");
  fmt::print("{:<24} {:>8} {:>8} {:>10} {:>16} {:>8} {:>22}\n", "", "f_s", "smooth", "C.-Baxter", "angle",
             "sunk", "velocity");
  for (const Case& one : all) {
    if (!is_wanted(options, one.label)) continue;
    std::vector<double> angles, sunk, velocities;
    for (int seed = 1; seed <= options.seeds; ++seed) {
      const std::vector<double>& row = table.row(key(one, seed));
      angles.push_back(row[0]);
      sunk.push_back(row[2]);
      velocities.push_back(row[3]);
    }
    const StructuredWallRun run = run_of(options, one, 1);
    const double smooth = curve.angle(one.attraction);
    const MeanAndSpread angle = mean_and_spread(angles), velocity = mean_and_spread(velocities);
    fmt::print("{:<24} {:>8.3f} {:>8.1f} {:>10.1f} {:>9.1f} +- {:<4.1f} {:>8.2f} {:>12.5f} +- {:<8.5f}\n",
               one.label, run.solid_fraction(), smooth, cassie_baxter_angle(run.solid_fraction(), smooth),
               angle.mean, angle.deviation, mean_and_spread(sunk).mean, velocity.mean, velocity.deviation);
  }
}

}  // namespace dmf::tools
