#include "engine/bodies/shape.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "engine/bodies/shell.h"
#include "engine/bodies/smooth_sphere.h"
#include "engine/kernels/lanes-inl.h"
#include "engine/pair_law-inl.h"

namespace dmf::engine {
namespace {

/// Beads of a patch: as many as a cell of liquid holds.
constexpr std::uint32_t patch_size = 24;

std::uint32_t bead_count(const MicroparticlePlacement& placement, int dimensions) {
  if (!placement.points.empty()) return static_cast<std::uint32_t>(placement.points.size());
  if (placement.smooth) return 1;
  if (placement.beads > 0) return placement.beads;
  if (dimensions == 2)
    return static_cast<std::uint32_t>(std::lround(usual_beads_per_length * 2 * M_PI * placement.radius));
  return nearest_shell_count(usual_beads_per_area * 4 * M_PI * placement.radius * placement.radius);
}

/// Bounding radius of a body of points around their origin.
double extent(const MicroparticlePlacement& placement) {
  double largest = 0;
  for (const Vector3d& point : placement.points) largest = std::max(largest, point.norm());
  return largest + placement.radius;
}

double mass_of(const MicroparticlePlacement& placement, int dimensions) {
  // A smooth sphere weighs what the shell that it stands for would.
  MicroparticlePlacement with_beads = placement;
  with_beads.smooth = false;
  return placement.mass.value_or(static_cast<double>(bead_count(with_beads, dimensions)));
}

/// Collects what is wrong with a placement.
class Violations {
 public:
  template <class... Arguments>
  void unless(bool sound, const char* text, const Arguments&... arguments) {
    if (!sound) found_.push_back("microparticle." + fmt::format(fmt::runtime(text), arguments...));
  }
  bool any() const { return !found_.empty(); }
  const std::vector<std::string>& found() const { return found_; }

 private:
  std::vector<std::string> found_;
};

void check_shell(const MicroparticlePlacement& placement, Violations& check) {
  const std::uint32_t beads = bead_count(placement, 3);
  check.unless(is_shell_count(beads),
               "beads: {}, allowed: numbers that spread evenly over a sphere, 10 (h^2 + h k + k^2) + 2; the "
               "nearest is {}",
               beads, nearest_shell_count(beads));
  check.unless(beads <= largest_bead_count, "beads: {}, allowed: up to {}", beads, largest_bead_count);
  // A count that is rounded down to an even spread may lie a hair below.
  const double area = 4 * M_PI * placement.radius * placement.radius;
  check.unless(beads >= 0.999 * fewest_beads_per_area * area,
               "beads: {} on radius {} r_c let liquid in, allowed: {:.0f} or more, or a radius up to {:.4g}",
               beads, placement.radius, std::ceil(fewest_beads_per_area * area),
               std::sqrt(beads / (4 * M_PI * fewest_beads_per_area)));
}

void check_circle(const MicroparticlePlacement& placement, Violations& check) {
  const std::uint32_t beads = bead_count(placement, 2);
  const double fewest = std::ceil(fewest_beads_per_length * 2 * M_PI * placement.radius);
  check.unless(beads <= largest_bead_count, "beads: {}, allowed: up to {}", beads, largest_bead_count);
  check.unless(beads >= fewest, "beads: {} around a disc of radius {} r_c let liquid in, allowed: {} or more",
               beads, placement.radius, fewest);
}

void check_contact(const MicroparticlePlacement& placement, const Parameters& parameters, Violations& check) {
  const MicroparticleParameters& model = parameters.microparticles;
  const bool meets_wall = parameters.domain.has_wall() || parameters.label_grid.grid;
  if (!meets_wall || model.wall_attraction == 0) return;
  const double radius = placement.points.empty() ? placement.radius : extent(placement);
  const bool flat = parameters.dimensions == 2;
  const double beads = bead_count(placement, parameters.dimensions);
  WallParameters wall = parameters.wall;  // the denser one's
  if (parameters.label_grid.grid)
    wall.lattice_constant = std::min(wall.lattice_constant, parameters.label_grid.lattice_constant);
  const double beads_per_area =
      placement.smooth ? usual_beads_per_area : beads / (4 * M_PI * radius * radius);
  const double load =
      flat ? wall_adhesion_of_disc(model.wall_attraction, radius, beads / (2 * M_PI * radius), wall)
           : wall_adhesion(model.wall_attraction, radius, beads_per_area, wall);
  const double mass = mass_of(placement, parameters.dimensions);
  const double largest = largest_elastic_modulus(mass, placement.radius, load, parameters.time_step);
  // sqrt(k / m) time_step grows with E^(1/3).
  check.unless(model.elastic_modulus <= largest,
               "contact: too stiff for a mass of {}: elastic_modulus {:.3g}, allowed: up to {:.3g} at "
               "time_step {}, or time_step up to {:.2g}",
               mass, model.elastic_modulus, largest, parameters.time_step,
               parameters.time_step * std::cbrt(largest / model.elastic_modulus));
}

}  // namespace

std::vector<std::string> violations(const MicroparticlePlacement& placement, const Parameters& parameters) {
  Violations check;
  const auto within = [](double value, double lower, double upper) {
    return value >= lower && value <= upper;
  };
  check.unless(placement.center.allFinite() && std::isfinite(placement.z.value_or(0)),
               "center: ({}, {}, {}), allowed: finite numbers", placement.center.x(), placement.center.y(),
               placement.z.value_or(0));
  check.unless(within(placement.radius, 0.5, 20), "radius: {}, allowed: 0.5 to 20 (r_c)", placement.radius);
  check.unless(placement.points.size() <= largest_bead_count, "points: {}, allowed: up to {}",
               placement.points.size(), largest_bead_count);
  check.unless(std::all_of(placement.points.begin(), placement.points.end(),
                           [](const Vector3d& point) { return point.norm() <= 100; }),
               "points: allowed: within 100 r_c of their origin");
  check.unless(placement.points.empty() || placement.beads == 0 || placement.beads == placement.points.size(),
               "beads: {}, allowed: none beside points", placement.beads);
  const double mass = placement.mass.value_or(1);
  check.unless(mass > 0 && std::isfinite(mass), "mass: {}, allowed: above 0", mass);
  check.unless(placement.attraction > -200 && placement.attraction < 0,
               "attraction: {}, allowed: above -200, below 0 (attraction is negative)", placement.attraction);
  check.unless(within(placement.static_friction, 0, 10), "static_friction: {}, allowed: 0 to 10",
               placement.static_friction);
  const double kinetic = placement.kinetic_friction.value_or(0);
  check.unless(within(kinetic, 0, placement.static_friction),
               "kinetic_friction: {}, allowed: 0 to static_friction ({})", kinetic,
               placement.static_friction);
  check.unless(within(placement.rolling_friction, 0, 10), "rolling_friction: {}, allowed: 0 to 10",
               placement.rolling_friction);
  check.unless(placement.z.has_value() || parameters.domain.has_wall(),
               "center: no z, allowed: a z where there is no wall to rest on");
  if (check.any()) return check.found();  // what follows computes with these numbers
  check.unless(!placement.smooth || (placement.beads == 0 && placement.points.empty()),
               "smooth: true, allowed: neither beads nor points beside it");
  check.unless(!placement.smooth ||
                   liquid_law(parameters.liquid, parameters.time_step).weight() == DissipativeWeight::shared,
               "smooth: true, allowed: in a liquid of dissipation_exponent 2 and dissipation_radius 1");
  const bool flat = parameters.dimensions == 2;
  check.unless(!placement.smooth || !flat, "smooth: true, allowed: in three dimensions");
  check.unless(!flat || std::all_of(placement.points.begin(), placement.points.end(),
                                    [](const Vector3d& point) { return point.y() == 0; }),
               "points: allowed: 0 along y with dimensions: 2");
  if (placement.points.empty() && !placement.smooth)
    flat ? check_circle(placement, check) : check_shell(placement, check);
  check_contact(placement, parameters, check);
  check.unless(parameters.integrator == Integrator::groot_warren,
               "integrator: baoab, allowed: groot_warren, the one that moves microparticles");
  return check.found();
}

Microparticle shaped(const MicroparticlePlacement& placement, const Parameters& parameters) {
  Microparticle particle;
  particle.placement = placement;
  particle.friction = {placement.static_friction,
                       placement.kinetic_friction.value_or(placement.static_friction),
                       placement.rolling_friction};
  RigidBody& body = particle.body;
  body.mass = mass_of(placement, parameters.dimensions);
  const bool flat = parameters.dimensions == 2;
  const double radius = placement.radius;
  double lowest = -radius;
  if (placement.points.empty()) {
    const std::uint32_t beads = bead_count(placement, parameters.dimensions);
    if (placement.smooth)
      particle.offsets = {Vector3d::Zero()};
    else
      particle.offsets = flat ? circle_points(beads) : shell_points(beads);
    for (Vector3d& offset : particle.offsets) offset *= radius;
    const Vector3d of_radius = flat ? Vector3d(0.5, 1, 0.5) : Vector3d::Constant(2.0 / 3.0);
    body.inertia = body.mass * radius * radius * of_radius;
    particle.contact_spheres = {{Vector3d::Zero(), radius}};
    particle.bounding_radius = radius;
  } else {
    const double share = 1.0 / static_cast<double>(placement.points.size());
    for (const Vector3d& point : placement.points) {
      body.position += share * point;
      lowest = std::min(lowest, point.z() - radius);
    }
    // Each point is a solid sphere: so no body is without inertia about any axis.
    Eigen::Matrix3d inertia = 0.4 * body.mass * radius * radius * Eigen::Matrix3d::Identity();
    for (const Vector3d& point : placement.points) {
      const Vector3d arm = point - body.position;
      inertia +=
          share * body.mass * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
    }
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    body.inertia = inertia.diagonal();
    if (!flat) {  // in a plane it only turns about y, which is a principal axis
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(inertia);
      axes = principal.eigenvectors();
      if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
      body.inertia = principal.eigenvalues();
      body.orientation = Eigen::Quaterniond(axes).normalized();
    }
    auto shape = std::make_shared<std::vector<Vector3d>>();
    for (const Vector3d& point : placement.points) {
      particle.offsets.push_back(axes.transpose() * (point - body.position));
      particle.contact_spheres.push_back({particle.offsets.back(), radius});
      particle.bounding_radius = std::max(particle.bounding_radius, particle.offsets.back().norm() + radius);
      shape->push_back(particle.offsets.back());
    }
    particle.points = shape;
  }
  body.position += Vector3d(placement.center.x(), placement.center.y(),
                            placement.z.value_or(parameters.domain.lower.z() - lowest));
  if (flat) body.position.y() = parameters.plane();
  particle.patch_ends = order_in_patches(particle.offsets, patch_size);
  return particle;
}

std::vector<float> own_densities(const Microparticle& particle, const Parameters& parameters) {
  const double repulsion_radius = parameters.liquid.repulsion_radius;
  if (particle.placement.smooth) {
    const SmoothShell shell(particle.placement.radius, usual_beads_per_area, repulsion_radius);
    return {static_cast<float>(shell.own_density())};
  }
  const std::vector<Vector3d>& offsets = particle.offsets;
  std::vector<float> densities;
  for (const Vector3d& at : offsets) {
    double total = 0;
    for (const Vector3d& other : offsets)
      if (&other != &at) total += HWY_NAMESPACE::density_weight((at - other).norm(), 1.0 / repulsion_radius);
    densities.push_back(
        static_cast<float>(density_normalization(repulsion_radius, parameters.dimensions) * total));
  }
  return densities;
}

}  // namespace dmf::engine
