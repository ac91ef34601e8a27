#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/wettability.h"
#include "tools/cases.h"
#include "tools/saved_run.h"
#include "tools/sessile.h"

namespace dmf::tools {
namespace {

/// Lan (2.39) with its signs restored: a guess to start the cap from, and what to compare with. Degrees.
double lan_angle(double attraction) { return (552.125 - std::pow(attraction + 1.211, 2)) / 3.30033; }

SessileRun sessile_run(const StudyOptions& options, double attraction, double starting_angle,
                       std::uint64_t seed) {
  SessileRun run;
  run.attraction = attraction;
  run.radius = options.radius_or(10);
  run.starting_angle = std::clamp(starting_angle, 38.0, 155.0);
  run.seed = seed;
  run.settle = options.quick ? 40 : 120;
  run.measure = options.quick ? 40 : 160;
  apply(options, run.parameters);
  return run;
}

std::vector<double> row_of(const SessileResult& result) {
  return {result.angle, result.first_half, result.second_half, result.temperature};
}

const std::vector<std::string> columns{"angle_deg", "first_half_deg", "second_half_deg", "temperature"};

}  // namespace

Findings study_contact_angle(const StudyOptions& options) {
  const std::vector<double> attractions =
      options.quick
          ? std::vector<double>{-18, -10}
          : std::vector<double>{-22.5, -21.75, -21, -20, -19, -18, -16.5, -15, -13.5, -12, -10.5, -9.25, -8};
  const auto label = [](double attraction) { return fmt::format("A={}", attraction); };
  std::vector<Case> cases;
  for (const double attraction : attractions)
    cases.push_back({label(attraction), [=, &options](std::uint64_t seed) {
                       return row_of(
                           run_sessile(sessile_run(options, attraction, lan_angle(attraction), seed)));
                     }});
  const Results results = run_cases("contact_angle", columns, cases, options);
  Findings findings;
  std::string points;
  int runs = 0;
  for (const double attraction : attractions) {
    Finding angle = results.finding(label(attraction), "angle_deg", "contact angle (degrees)", 1)
                        .against_paper(reference(lan_angle(attraction), 1, "Lan (2.39)"))
                        .within_margin(3);
    if (angle.happened() == 0) continue;
    runs = angle.happened();
    points +=
        fmt::format("  - [{}, {:.2f}, {:.2f}]\n", attraction, angle.mean().mean, angle.mean().standard_error);
    findings.push_back(std::move(angle));
    findings.push_back(
        results.finding(label(attraction), "first_half_deg", "in the first half of the measurement", 1));
    findings.push_back(
        results.finding(label(attraction), "second_half_deg", "in the second half of the measurement", 1));
  }
  if (options.recorded || !options.only.empty()) return findings;
  const SessileRun run = sessile_run(options, -10, 90, 1);
  replace_file(
      options.output + "/calibration.yaml",
      fmt::format(
          "description: static contact angle of an R = {} droplet over wall attraction A_lw, mean and "
          "standard error of {} seeds\n"
          "command: dmf_study contact_angle --seeds {} --radius {} --time-step {}\n"
          "# A_lw (k_BT / r_c), angle (degrees), standard error (degrees)\n"
          "points:\n{}",
          run.radius, runs, runs, run.radius, run.parameters.time_step, points));
  return findings;
}

Findings study_commanded_angle(const StudyOptions& options) {
  const engine::ContactAngleCurve curve = curve_for(options);
  const std::vector<double> angles =
      options.quick ? std::vector<double>{70, 130} : std::vector<double>{50, 70, 90, 110, 130, 145};
  // Another calibration asks the same angle of another attraction.
  const auto label = [&](double angle) {
    return fmt::format("commanded={} A={:.3f}", angle, curve.attraction(angle));
  };
  std::vector<Case> cases;
  for (const double angle : angles)
    cases.push_back({label(angle), [=, &options, &curve](std::uint64_t seed) {
                       return row_of(run_sessile(sessile_run(options, curve.attraction(angle), angle, seed)));
                     }});
  // Seeds that the calibration has not seen.
  const Results results = run_cases("commanded_angle", columns, cases, options, 101);
  Findings findings;
  for (const double angle : angles)
    findings.push_back(results.finding(label(angle), "angle_deg", "contact angle (degrees)", 1)
                           .against_theory(reference(angle, 0, "commanded"))
                           .within_margin(3));
  return findings;
}

}  // namespace dmf::tools
