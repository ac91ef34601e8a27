#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

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

/// What Lan says of how forces and velocity go together (4.1.3): with the friction at one place, and along
/// the way at one friction.
void compare_trends(const Results& results, Findings& findings) {
  struct Point {
    double friction, place, velocity, drive;
  };
  std::vector<Point> measured;
  for (const Series& one : series())
    for (const double place : one.places) {
      const std::string label = label_of(one, place);
      const Point point{one.static_friction, place, results.mean(label, "velocity").mean,
                        results.mean(label, "drive_x").mean};
      if (!results.of(label, "velocity").empty() && std::isfinite(point.velocity)) measured.push_back(point);
    }
  const auto order = [&](const std::vector<Point>& points, const std::string& of, const char* quantity,
                         const char* title, double Point::*what, double Point::*against, const char* lan) {
    if (points.size() < 3) return;
    std::vector<std::pair<double, double>> pairs;
    for (const Point& point : points) pairs.emplace_back(point.*what, point.*against);
    findings.push_back(
        results.derived(of, quantity, title, 2, {rank_correlation(pairs)}).against_paper({lan, "Lan"}));
  };
  const auto where = [&measured](double Point::*what, double value) {
    std::vector<Point> found;
    std::copy_if(measured.begin(), measured.end(), std::back_inserter(found),
                 [what, value](const Point& point) { return point.*what == value; });
    return found;
  };
  for (const double place : {-5.0, 15.0}) {
    const std::vector<Point> here = where(&Point::place, place);
    const std::string of = fmt::format("x={}", place);
    order(here, of, "drive_with_friction", "drive with f_s: rank correlation", &Point::drive,
          &Point::friction, "1");
    order(here, of, "velocity_with_friction", "velocity with f_s: rank correlation", &Point::velocity,
          &Point::friction, "-1");
  }
  for (const Series& one : series()) {
    const std::vector<Point> way = where(&Point::friction, one.static_friction);
    const std::string of = fmt::format("f={}/{}", one.static_friction, one.rolling_friction);
    order(way, of, "drive_with_velocity", "drive with velocity along x: rank correlation", &Point::drive,
          &Point::velocity, "1");
    if (one.static_friction > 0.4)
      order(way, of, "velocity_with_x", "velocity with x: rank correlation", &Point::velocity, &Point::place,
            "1");
    else if (way.size() == one.places.size() && way.size() > 2)
      // It rises first and falls then.
      findings.push_back(results
                             .derived(of, "fastest_at", "fastest at x (r_c)", 0,
                                      {std::max_element(way.begin(), way.end(),
                                                        [](const Point& a, const Point& b) {
                                                          return a.velocity < b.velocity;
                                                        })
                                           ->place})
                             .against_paper({"-10 to 10", "Lan: between the ends"}));
  }
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
  compare_trends(results, findings);
  return findings;
}

}  // namespace dmf::tools
