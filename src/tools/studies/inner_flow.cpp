#include <fmt/format.h>

#include <cmath>

#include "tools/cases.h"
#include "tools/quasi_stationary.h"
#include "tools/saved_run.h"

namespace dmf::tools {
namespace {

using Plane = FlowField::Plane;

/// How fast the liquid in a rectangle of a plane rises, r_c/tau: s and z from the microparticle's foot.
double rising(const FlowField& flow, Plane plane, double from_s, double to_s) {
  constexpr double as_high_as_it = 2;
  return flow.mean_velocity(plane, {Eigen::Vector2d(from_s, 0), Eigen::Vector2d(to_s, as_high_as_it)}).y();
}

/// Beside the microparticle, on both sides within a radius of its surface.
double rising_beside(const FlowField& flow) {
  return 0.5 * (rising(flow, Plane::across, -2, -1) + rising(flow, Plane::across, 1, 2));
}
double rising_behind(const FlowField& flow) { return rising(flow, Plane::along, -2, -1); }

/// How much faster the liquid goes over z = 4 than below z = 2: the droplet rolls.
double rolling(const FlowField& flow) {
  const auto layer = [&flow](double from_z, double to_z) {
    return flow.mean_velocity(
        Plane::along, {Eigen::Vector2d(-FlowField::reach, from_z), Eigen::Vector2d(FlowField::reach, to_z)});
  };
  return layer(4, FlowField::height).x() - layer(0, 2).x();
}

}  // namespace

Findings study_inner_flow(const StudyOptions& options) {
  // Lan looks where the microparticle is at x = -10 (figures 3.7 and 3.8), and at a droplet alone (2.17).
  constexpr double place = -10;
  const std::vector<std::string> labels{"particle", "alone"};
  std::vector<Case> cases;
  for (const std::string& label : labels) {
    chip::Scene scene = scene_for(options, "pickup");
    if (label == "alone") scene.microparticles.clear();
    shorten_the_approach(scene);
    QuasiStationaryRun run;
    run.place = place;
    run.measure = 10000;
    run.flow = true;
    run.folder = options.output + "/runs";
    run.key = "inner_flow " + label + options_key(options);
    if (options.quick) {
      run.pickup = 100;
      run.ahead = -1;  // as soon as it is wet
      run.slide = 2;
      run.settle = 2;
      run.measure = 5;
    }
    cases.push_back(
        {label, [scene, run](std::uint64_t seed) {
           QuasiStationaryRun seeded = run;
           seeded.key += fmt::format(" seed={}", seed);
           const QuasiStationary r = run_quasi_stationary(scene, seed, seeded);
           replace_file(run.folder + "/" + file_name(seeded.key) + "_cells.csv", r.flow.as_csv());
           // A droplet that has lost it has no flow around it either.
           const FlowField flow = std::isfinite(r.velocity) ? r.flow : FlowField();
           const FlowField around_it = scene.microparticles.empty() ? FlowField() : flow;
           ResultRow row = std::vector<double>{
               r.velocity,   r.drive_z, r.droplet_ahead, rising_beside(around_it), rising_behind(around_it),
               rolling(flow)};
           row.computing = r.earlier_computing;
           return row;
         }});
  }
  const Results results = run_cases(
      "inner_flow", {"velocity", "drive_z", "droplet_ahead", "rising_beside", "rising_behind", "rolling"},
      cases, options);
  Findings findings;
  for (const std::string& label : labels) {
    findings.push_back(results.finding(label, "velocity", "velocity (r_c/tau)", 5));
    findings.push_back(results.finding(label, "drive_z", "lift of the liquid (k_BT/r_c)", 1));
    findings.push_back(results.finding(label, "droplet_ahead", "the droplet's centre is ahead by (r_c)", 2));
    findings.push_back(
        results.finding(label, "rolling", "faster over z = 4 than below z = 2 by (r_c/tau)", 5));
  }
  findings.push_back(
      results.finding("particle", "rising_beside", "liquid beside the microparticle rises at (r_c/tau)", 5)
          .against_paper({"0 to 1", "Lan: upward"}));
  findings.push_back(
      results.finding("particle", "rising_behind", "liquid behind the microparticle rises at (r_c/tau)", 5)
          .against_paper({"-1 to 0", "Lan: downward"}));
  return findings;
}

}  // namespace dmf::tools
