#include <algorithm>
#include <cmath>

#include "engine/bodies/microparticles.h"

// What microparticles touch, and what that does to them.

namespace dmf::engine {
namespace {

/// Two microparticles hold each other up to this distance between their surfaces, ever less, r_c.
constexpr double adhesion_range = 0.1;

}  // namespace

void Microparticles::touch_walls(Microparticle& particle) {
  particle.contacts.clear();
  for (const ContactSphere& sphere : particle.contact_spheres) {
    const Vector3d arm = particle.body.orientation * sphere.offset;
    touch_sides(particle, sphere, arm);
    if (!solid_.empty()) touch_solid(particle, sphere, arm);
  }
}

void Microparticles::touch_sides(Microparticle& particle, const ContactSphere& sphere, const Vector3d& arm) {
  const Domain& domain = parameters_.domain;
  const BoundaryParameters& boundaries = parameters_.boundaries;
  const Vector3d centre = particle.body.position + arm;
  for (int axis = 0; axis < 3; ++axis) {
    if (domain.periodic(axis) || parameters_.flat(axis)) continue;
    for (const int side : {1, -1}) {
      const auto& reflection = side > 0 ? boundaries.lower_reflection : boundaries.upper_reflection;
      if (reflection[axis] == Reflection::symmetric) continue;  // meets its mirror image there
      const double distance =
          side > 0 ? centre[axis] - domain.lower[axis] : domain.upper[axis] - centre[axis];
      if (distance >= sphere.radius) continue;
      WallContact contact = press(particle, sphere, arm, side * Vector3d::Unit(axis), distance);
      // Sides that are no plates only keep things in: no friction.
      if (axis != 2 || !(side > 0 ? domain.has_wall() : domain.has_top_plate())) continue;
      contact.velocity.head<2>() = side > 0 ? boundaries.lower_velocity : boundaries.upper_velocity;
      particle.contacts.push_back(contact);
    }
  }
}

void Microparticles::touch_solid(Microparticle& particle, const ContactSphere& sphere, const Vector3d& arm) {
  touches_.clear();
  solid_.append_touches(particle.body.position + arm, sphere.radius, touches_);
  for (const SolidTouch& touch : touches_)
    particle.contacts.push_back(press(particle, sphere, arm, touch.normal, touch.distance));
}

WallContact Microparticles::press(Microparticle& particle, const ContactSphere& sphere, const Vector3d& arm,
                                  const Vector3d& normal, double distance) const {
  const MicroparticleParameters& model = parameters_.microparticles;
  const RigidBody& body = particle.body;
  const Vector3d to_contact = arm - distance * normal;
  const Vector3d velocity = body.velocity + body.angular_velocity().cross(to_contact);
  const double magnitude = damped_hertz_force(model.elastic_modulus, sphere.radius, sphere.radius - distance,
                                              body.mass, model.contact_damping, normal.dot(velocity));
  const Vector3d force = magnitude * normal;
  particle.force += force;
  particle.torque += to_contact.cross(force);
  return {to_contact, normal, sphere.radius, magnitude, Vector3d::Zero()};
}

void Microparticles::touch_each_other() {
  for (std::size_t i = 0; i < all_.size(); ++i)
    for (std::size_t j = i + 1; j < all_.size(); ++j) {
      Microparticle &first = all_[i], &second = all_[j];
      const Vector3d between = images_.nearest_image(first.body.position - second.body.position);
      if (between.norm() > first.bounding_radius + second.bounding_radius + adhesion_range) continue;
      for (const ContactSphere& a : first.contact_spheres)
        for (const ContactSphere& b : second.contact_spheres) {
          const SphereTouch touch = push(first, a, b, second.body.orientation * b.offset - between);
          // One point of action for both, so that angular momentum is kept.
          second.force -= touch.force;
          second.torque -= (between + touch.arm).cross(touch.force);
        }
    }
}

void Microparticles::touch_mirror_images() {
  // Each its own: with heights z of two that do not overlap, |i - j'|^2 = |i - j|^2 + 4 z_i z_j is farther
  // than others reach.
  const BoundaryParameters& boundaries = parameters_.boundaries;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool above : {false, true}) {
      if ((above ? boundaries.upper_reflection : boundaries.lower_reflection)[axis] != Reflection::symmetric)
        continue;
      const double plane = (above ? parameters_.domain.upper : parameters_.domain.lower)[axis];
      for (Microparticle& particle : all_) {
        const double height = particle.body.position[axis] - plane;
        if (std::abs(height) > particle.bounding_radius + 0.5 * adhesion_range) continue;
        for (const ContactSphere& own : particle.contact_spheres)
          for (const ContactSphere& mirrored : particle.contact_spheres) {
            Vector3d to_image = particle.body.orientation * mirrored.offset;
            to_image[axis] = -2 * height - to_image[axis];
            push(particle, own, mirrored, to_image);
          }
      }
    }
}

Microparticles::SphereTouch Microparticles::push(Microparticle& particle, const ContactSphere& own,
                                                 const ContactSphere& other, const Vector3d& to_other) const {
  const Vector3d arm = particle.body.orientation * own.offset;
  const Vector3d apart = arm - to_other;
  const double distance = apart.norm();
  if (distance == 0 || distance > own.radius + other.radius + adhesion_range) return {};
  const Vector3d normal = apart / distance;
  const SphereTouch touch{force_between(own, other, distance) * normal, arm - own.radius * normal};
  particle.force += touch.force;
  particle.torque += touch.arm.cross(touch.force);
  return touch;
}

double Microparticles::force_between(const ContactSphere& first, const ContactSphere& second,
                                     double distance) const {
  const MicroparticleParameters& model = parameters_.microparticles;
  const double gap = distance - first.radius - second.radius;
  const double radius = first.radius * second.radius / (first.radius + second.radius);
  const double adhesion =
      model.particle_adhesion * 2.0 * radius * std::clamp(1.0 - gap / adhesion_range, 0.0, 1.0);
  return (gap < 0 ? hertz_force(model.elastic_modulus, radius, -gap) : 0.0) - adhesion;
}

}  // namespace dmf::engine
