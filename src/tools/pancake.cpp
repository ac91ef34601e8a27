#include "tools/pancake.h"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "yaml/units.h"

namespace dmf::tools {
namespace {

using engine::Vector3d;

}  // namespace

PancakeResult run_pancake(const PancakeRun& run, const engine::ContactAngleCurve& curve) {
  engine::Parameters parameters;
  const double half = run.radius + 5;
  parameters.domain.lower = Vector3d(-half, -half, 0);
  parameters.domain.upper = Vector3d(half, half, run.gap);
  parameters.domain.upper_side[2] = engine::Side::wall;
  parameters.wall.top_contact_angle = run.contact_angle;
  parameters.time_step = run.time_step;
  parameters.seed = run.seed;
  engine::Simulation simulation(parameters, curve, {1, "auto"});
  simulation.set_wettability([&run](double, double) { return run.contact_angle; });
  const double volume = M_PI * run.radius * run.radius * engine::liquid_height(parameters);
  simulation.add_droplet({Vector3d(0, 0, 0.5 * run.gap), std::cbrt(volume * 0.75 / M_PI)});

  const auto steps_of = [&run](double time) {
    return static_cast<std::uint64_t>(std::llround(time / run.time_step));
  };
  for (std::uint64_t k = 0; k < steps_of(run.settle); ++k) simulation.step();

  // The column: far from the rim. In its middle: beyond the reach of both plates' layers where the gap
  // allows.
  const double column = run.radius - 4, slice = std::min(1.0, 0.5 * (run.gap - 3));
  constexpr double ring = 0.25;  // r_c, of the radial profile
  std::vector<double> profile(static_cast<std::size_t>(std::ceil(half / ring)), 0.0);
  double in_column = 0, in_middle = 0, pressure = 0, looks = 0;
  for (std::uint64_t k = 1; k <= steps_of(run.measure); ++k) {
    simulation.step();
    if (k % steps_of(0.2) != 0) continue;
    const auto snapshot = simulation.observe({true, false, true});
    if (snapshot->droplets.empty()) continue;
    const Vector3d centre = snapshot->droplets[0].centroid;
    for (std::size_t bead = 0; bead < snapshot->positions.size(); ++bead) {
      const Vector3d from_centre = snapshot->positions[bead].cast<double>() - centre;
      const double r = from_centre.head<2>().norm();
      const bool middle = std::abs(snapshot->positions[bead].z() - 0.5 * run.gap) < slice;
      if (middle && r < half) profile[static_cast<std::size_t>(r / ring)] += 1;
      if (r > column) continue;
      in_column += 1;
      if (!middle) continue;
      in_middle += 1;
      pressure += snapshot->velocities[bead].cast<double>().squaredNorm() / 3 + snapshot->bead_virials[bead];
    }
    looks += 1;
  }
  const double area = M_PI * column * column, volume_of_middle = area * 2 * slice;
  PancakeResult result{};
  result.density = in_middle / looks / volume_of_middle;
  result.pressure = pressure / looks / volume_of_middle;
  result.wall_distance = 0.5 * (run.gap - in_column / looks / area / result.density);
  double outside = 0;
  for (std::size_t k = 0; k < profile.size(); ++k) {
    const double inner = static_cast<double>(k) * ring;
    const double density =
        profile[k] / looks / (M_PI * ((inner + ring) * (inner + ring) - inner * inner) * 2 * slice);
    const double at = inner + 0.5 * ring;
    const double before = outside;
    outside = density;
    if (at > column && density < 0.5 * result.density) {
      result.equator = at - ring * (0.5 * result.density - density) / (before - density);
      break;
    }
  }
  return result;
}

double bridge_pressure(double height, double angle, double equator) {
  const double sine = std::sin(angle * degree), cosine = std::cos(angle * degree);
  if (cosine == 0 || std::abs(angle - 90) < 1e-9) return 1 / equator;
  // Half of the height that a surface of pressure p has, from the equator to the plate. Differences of nearly
  // equal numbers are multiplied out: close to 90 degrees all radii are nearly the equator's.
  const auto half_height = [&](double p) {
    const double q = 1 - p * equator;
    const double discriminant = q * q - cosine * cosine;
    if (discriminant < 0) return std::numeric_limits<double>::max();  // never gets as flat as that
    // Where sin(phi) = sin(theta), on the near side: the radius at the plate less the equator's.
    const double change = (std::copysign(cosine * cosine / (std::abs(q) + std::sqrt(discriminant)), q) -
                           cosine * cosine / (1 + sine)) /
                          p;
    // dz/dr = sin(phi) / cos(phi) diverges at the equator: r = R + change s^2 smooths it.
    const auto integrand = [&](double s) {
      const double from_equator = change * s * s, r = equator + from_equator;
      const double less_than_one = -from_equator * (0.5 * p * (r + equator) - 1) / r;  // 1 - sin(phi)
      return (1 - less_than_one) / std::sqrt(less_than_one * (2 - less_than_one)) * 2 * s * std::abs(change);
    };
    return boost::math::quadrature::gauss_kronrod<double, 61>::integrate(integrand, 0.0, 1.0, 5, 1e-9);
  };
  // A rim that bulges has more than a cylinder's pressure, one that curves in less.
  const double cylinder = 1 / equator, flat = -2 * cosine / height;
  const double low = cosine < 0 ? cylinder : flat - cylinder,
               high = cosine < 0 ? flat + 2 * cylinder : cylinder;
  const auto miss = [&](double p) { return half_height(p) - 0.5 * height; };
  boost::math::tools::eps_tolerance<double> tolerance(40);
  std::uintmax_t iterations = 200;
  const auto root = boost::math::tools::bisect(miss, low, high, tolerance, iterations);
  return 0.5 * (root.first + root.second);
}

}  // namespace dmf::tools
