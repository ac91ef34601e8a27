#include <fmt/format.h>

#include "tools/cases.h"
#include "tools/quasi_stationary.h"

namespace dmf::tools {
namespace {

/// A friction, and where on the gradient Lan has measured with it (his figures 4.6 to 4.8).
struct Series {
  double static_friction, rolling_friction;
  std::vector<double> places;  ///< x, r_c
};

const std::vector<Series>& series() {
  static const std::vector<Series> all{{0.2, 0.1, {-5, 15}},
                                       {0.4, 0.2, {-15, -10, -5, 0, 5, 10, 15}},
                                       {0.8, 0.4, {-15, -10, -5, 0, 5, 10, 15}},
                                       {1.6, 0.8, {-15, -10, -5, 0, 5}}};
  return all;
}

std::string label_of(const Series& one, double place) {
  return fmt::format("f={}/{} x={}", one.static_friction, one.rolling_friction, place);
}

}  // namespace

Findings study_forces(const StudyOptions& options) {
  std::vector<Case> cases;
  for (const Series& one : series()) {
    chip::Scene scene = scene_for(options, "friction");
    scene.microparticles.at(0).static_friction = one.static_friction;
    scene.microparticles.at(0).rolling_friction = one.rolling_friction;
    shorten_the_approach(scene);
    for (const double place : one.places) {
      QuasiStationaryRun run;
      run.place = place;
      run.folder = options.output + "/runs";
      if (options.quick) {
        if (place != one.places.front()) continue;
        run.pickup = 100;
        run.ahead = -1;  // as soon as it is wet
        run.slide = 2;
        run.settle = 2;
        run.measure = 5;
      }
      const std::string label = label_of(one, place);
      run.key = "forces " + label + options_key(options);
      cases.push_back({label, [scene, run](std::uint64_t seed) {
                         QuasiStationaryRun seeded = run;
                         seeded.key += fmt::format(" seed={}", seed);
                         const QuasiStationary r = run_quasi_stationary(scene, seed, seeded);
                         ResultRow row = std::vector<double>{
                             r.velocity, r.drive_x,      r.friction_x,       r.drive_z,
                             r.height,   r.normal_force, r.contact_fraction, r.droplet_ahead};
                         row.computing = r.earlier_computing;
                         return row;
                       }});
    }
  }
  const Results results = run_cases("forces",
                                    {"velocity", "drive_x", "friction_x", "drive_z", "height", "normal_force",
                                     "contact_fraction", "droplet_ahead"},
                                    cases, options);
  Findings findings;
  for (const Series& one : series())
    for (const double place : one.places) {
      const std::string label = label_of(one, place);
      if (results.of(label, "velocity").empty()) continue;
      findings.push_back(results.finding(label, "velocity", "velocity (r_c/tau)", 5));
      findings.push_back(results.finding(label, "drive_x", "drive (k_BT/r_c)", 2));
      // Held at its place of the moving gradient: what drives it balances what holds it.
      findings.push_back(
          results.finding(label, "friction_x", "friction (k_BT/r_c)", 2)
              .against_paper(reference(-results.mean(label, "drive_x").mean, 2, "Lan: they balance")));
      findings.push_back(results.finding(label, "drive_z", "lift of the liquid (k_BT/r_c)", 1));
      findings.push_back(results.finding(label, "height", "mean height over the wall (r_c)", 5));
      findings.push_back(results.finding(label, "contact_fraction", "in contact with the wall", 3));
      findings.push_back(
          results.finding(label, "droplet_ahead", "the droplet's centre is ahead by (r_c)", 2));
    }
  return findings;
}

}  // namespace dmf::tools
