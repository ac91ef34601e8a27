#include "engine/bodies/contact.h"

#include <algorithm>
#include <cmath>

namespace dmf::engine {
namespace {

Vector3d in_wall(const Vector3d& v, const WallContact& contact) {
  return v - contact.normal.dot(v) * contact.normal;
}

/// Impulse against a motion that `stopping` would end: all of it while it stays within the static limit, the
/// kinetic one beyond.
double friction_impulse(double stopping, double normal_impulse, const Friction& friction) {
  return stopping <= friction.static_limit * normal_impulse
             ? stopping
             : std::min(stopping, friction.kinetic * normal_impulse);
}

/// The impulse along -`direction` at `arm` that stops a velocity of 1 there is the inverse of this.
double mobility(const RigidBody& body, const Vector3d& arm, const Vector3d& direction) {
  const Vector3d turned = body.inverse_inertia_times(arm.cross(direction)).cross(arm);
  return 1.0 / body.mass + turned.dot(direction);
}

void apply_impulse(RigidBody& body, const Vector3d& arm, const Vector3d& impulse) {
  body.velocity += impulse / body.mass;
  body.angular_momentum += arm.cross(impulse);
}

/// Slows turning about axes in the wall by the torque f_r F_normal R.
void resist_rolling(const Friction& friction, const WallContact& contact, double time_step, RigidBody& body) {
  const Vector3d rate = in_wall(body.angular_velocity(), contact);
  const double speed = rate.norm();
  if (speed == 0) return;
  const Vector3d axis = rate / speed;
  const double stopping = speed / body.inverse_inertia_times(axis).dot(axis);
  const double limit = friction.rolling * contact.normal_force * contact.radius * time_step;
  body.angular_momentum -= std::min(stopping, limit) * axis;
}

}  // namespace

double hertz_force(double elastic_modulus, double radius, double indentation) {
  return 4.0 / 3.0 * elastic_modulus * std::sqrt(radius) * indentation * std::sqrt(indentation);
}

double damped_hertz_force(double elastic_modulus, double radius, double indentation, double mass,
                          double damping, double parting) {
  const double elastic = hertz_force(elastic_modulus, radius, indentation);
  if (damping == 0) return elastic;
  const double stiffness = 2.0 * elastic_modulus * std::sqrt(radius * indentation);
  return std::max(0.0, elastic - 2.0 * damping * std::sqrt(mass * stiffness) * parting);
}

double largest_elastic_modulus(double mass, double radius, double load, double time_step) {
  // k = 2 E sqrt(R d) with F = 4/3 E sqrt(R) d^(3/2), so k^3 = 6 E^2 R F.
  const double stiffness = mass * 0.25 / (time_step * time_step);
  return std::sqrt(stiffness * stiffness * stiffness / (6.0 * radius * load));
}

double wall_adhesion(double attraction, double radius, double beads_per_area, const WallParameters& wall) {
  // A layer of n beads an area at distance z attracts one bead with n pi |A| z (1 - z)^2 for z < 1; the
  // sphere has 2 pi R beads_per_area beads for each unit of height.
  const double per_area = 2.0 / (wall.lattice_constant * wall.lattice_constant);
  const auto integral = [](double z) { return z * z / 2 - 2 * z * z * z / 3 + z * z * z * z / 4; };
  double total = 0;
  for (int layer = 0; layer < wall.layers; ++layer) {
    const double from = std::min(1.0, 0.5 * layer * wall.lattice_constant);
    const double to = std::min(1.0, from + 2.0 * radius);
    total += integral(to) - integral(from);
  }
  return -attraction * M_PI * per_area * 2.0 * M_PI * radius * beads_per_area * total;
}

double wall_adhesion_of_disc(double attraction, double radius, double beads_per_length,
                             const WallParameters& wall) {
  // A row of n beads a length at distance z attracts one bead with 2 n |A| (z arsinh(x / z) - z x) for z < 1,
  // x = sqrt(1 - z^2).
  const auto row = [](double z) {
    if (z <= 0 || z >= 1) return 0.0;
    const double x = std::sqrt(1 - z * z);
    return 2 * z * (std::asinh(x / z) - x);
  };
  constexpr int pieces = 2000;  // of half the circle
  double total = 0;
  for (int k = 0; k < pieces; ++k) {
    const double height = radius * (1 - std::cos(M_PI * (k + 0.5) / pieces));
    for (int layer = 0; layer < wall.layers; ++layer)
      total += row(height + 0.5 * layer * wall.lattice_constant);
  }
  return -attraction / wall.lattice_constant * beads_per_length * 2 * M_PI * radius / pieces * total;
}

FrictionReport apply_friction(ContactModel model, const Friction& friction,
                              const std::vector<WallContact>& contacts, double time_step, RigidBody& body) {
  FrictionReport report;
  for (const WallContact& contact : contacts) {
    // lan2016 looks at the centre, coulomb at the point of contact.
    const bool at_centre = model == ContactModel::lan2016;
    const Vector3d arm = at_centre ? Vector3d::Zero() : contact.arm;
    const Vector3d sliding =
        in_wall(body.velocity + body.angular_velocity().cross(arm) - contact.velocity, contact);
    if (const double speed = sliding.norm(); speed > 0) {
      const Vector3d direction = sliding / speed;
      const double stopping = speed / mobility(body, arm, direction);
      const Vector3d impulse =
          -friction_impulse(stopping, contact.normal_force * time_step, friction) * direction;
      apply_impulse(body, arm, impulse);
      report.force += impulse / time_step;
    }
    resist_rolling(friction, contact, time_step, body);
  }
  if (model == ContactModel::lan2016 && !contacts.empty()) {
    const WallContact& contact = contacts.front();
    report.rolling = in_wall(body.angular_velocity(), contact).cross(contact.radius * contact.normal);
  }
  return report;
}

}  // namespace dmf::engine
