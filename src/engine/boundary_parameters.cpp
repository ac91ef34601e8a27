#include "engine/boundary_parameters.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/parameters.h"

namespace dmf::engine {
namespace {

/// That a side may move, or two sides against each other, in one step, r_c.
constexpr double most_in_a_step = 0.1;

void check_reflections(const Domain& domain, const BoundaryParameters& boundaries,
                       std::vector<std::string>& found) {
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      const Side side = (upper ? domain.upper_side : domain.lower_side)[axis];
      const Reflection reflection = (upper ? boundaries.upper_reflection : boundaries.lower_reflection)[axis];
      const std::string key = fmt::format("boundaries.{}_{}", upper ? "upper" : "lower", "xyz"[axis]);
      if (side == Side::periodic && reflection != Reflection::bounce_back)
        found.push_back(key + ": a reflection on a periodic side, allowed: none, or another side");
      if (axis < 2 && domain.has_wall() && reflection == Reflection::symmetric)
        found.push_back(key + ": symmetric beside a wall of beads, allowed: without walls, they end there");
      if (side == Side::wall && reflection == Reflection::symmetric)
        found.push_back(key + ": symmetric on a wall of beads, allowed: a side without beads");
      if (side == Side::wall && reflection == Reflection::frozen_particles)
        found.push_back(key + ": frozen_particles on a wall of beads, allowed: a side without beads");
    }
  if (!(boundaries.layer_thickness > 0 && boundaries.layer_thickness <= 0.5))
    found.push_back(fmt::format("boundaries.layer_thickness: {}, allowed: above 0 up to 0.5 (r_c)",
                                boundaries.layer_thickness));
  const auto& [attraction, lateral_friction] = boundaries.frozen_particles;
  if (attraction && !(*attraction >= -200 && *attraction <= 200))
    found.push_back(
        fmt::format("boundaries.frozen_particles.attraction: {}, allowed: -200 to 200", *attraction));
  if (!(lateral_friction >= 0 && lateral_friction <= 1000))
    found.push_back(fmt::format(
        "boundaries.frozen_particles.lateral_friction: {}, allowed: 0 to 1000 (m / tau)", lateral_friction));
}

void check_velocities(const Parameters& parameters, std::vector<std::string>& found) {
  const BoundaryParameters& boundaries = parameters.boundaries;
  const Domain& domain = parameters.domain;
  const double fastest = most_in_a_step / parameters.time_step;
  for (const bool upper : {false, true}) {
    const Eigen::Vector2d& velocity = upper ? boundaries.upper_velocity : boundaries.lower_velocity;
    if (velocity.isZero(0)) continue;
    const std::string key = fmt::format("boundaries.{}_velocity: ({}, {})", upper ? "upper" : "lower",
                                        velocity.x(), velocity.y());
    if (!(velocity.norm() <= fastest))
      found.push_back(fmt::format("{}, allowed: up to {:.4g} r_c / tau, {} r_c in a time_step", key, fastest,
                                  most_in_a_step));
    if (domain.periodic(2)) found.push_back(key + ", allowed: zero on a periodic side");
    if (parameters.dimensions == 2 && velocity.y() != 0)
      found.push_back(key + ", allowed: y zero with dimensions: 2");
  }
  const double range = parameters.liquid.range();
  if (boundaries.moving() && domain.has_top_plate() && domain.size().z() < 2 * range)
    found.push_back(fmt::format("domain.z: {} long, allowed: at least {} (r_c) between walls that move",
                                domain.size().z(), 2 * range));
}

void check_shear(const Parameters& parameters, std::vector<std::string>& found) {
  const double rate = parameters.boundaries.shear_rate;
  if (rate == 0) return;
  const Domain& domain = parameters.domain;
  if (!domain.periodic(0) || !domain.periodic(2))
    found.push_back(
        fmt::format("boundaries.shear_rate: {}, allowed: 0 unless domain.sides x and z are periodic", rate));
  const double largest = most_in_a_step / (parameters.time_step * domain.size().z());
  if (!(std::abs(rate) <= largest))
    found.push_back(
        fmt::format("boundaries.shear_rate: {}, allowed: up to {:.4g} / tau either way, {} r_c in a "
                    "time_step between the z sides",
                    rate, largest, most_in_a_step));
}

/// What does not know of images that are more than shifted, or of a plane.
void check_company(const Parameters& parameters, std::vector<std::string>& found) {
  const BoundaryParameters& boundaries = parameters.boundaries;
  const bool mirrors = boundaries.has(Reflection::symmetric);
  if (mirrors && !parameters.mixture.liquids.empty())
    found.push_back("boundaries: symmetric sides with several species, allowed: with one");
  if (parameters.label_grid.grid && (mirrors || boundaries.shear_rate != 0 || parameters.dimensions == 2))
    found.push_back(
        "label_grid: with symmetric sides, a shear rate or dimensions: 2, allowed: in three dimensions "
        "without");
}

}  // namespace

std::vector<std::string> boundary_violations(const Parameters& parameters) {
  std::vector<std::string> found;
  check_reflections(parameters.domain, parameters.boundaries, found);
  check_velocities(parameters, found);
  check_shear(parameters, found);
  check_company(parameters, found);
  if (parameters.dimensions != 2 && parameters.dimensions != 3)
    found.push_back(fmt::format("dimensions: {}, allowed: 2 or 3", parameters.dimensions));
  if (parameters.dimensions == 2 && (parameters.domain.lower_side[1] != Side::reflecting ||
                                     parameters.domain.upper_side[1] != Side::reflecting))
    found.push_back(
        "dimensions: 2 with periodic y sides, allowed: closed ones, beads stay half-way between them");
  return found;
}

}  // namespace dmf::engine
