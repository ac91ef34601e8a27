#include "engine/bodies/microparticles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/bodies/shape.h"
#include "engine/integrate.h"
#include "engine/kernels/lanes-inl.h"
#include "engine/noise-inl.h"

namespace dmf::engine {
namespace {

Record record_of(const Vector3d& v, float w) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), w};
}

Vector3d vector_of(const Record& record) { return {record.x, record.y, record.z}; }

void require_sound(const MicroparticlePlacement& placement, const Parameters& parameters) {
  const std::vector<std::string> found = violations(placement, parameters);
  if (!found.empty()) throw InvalidInput(fmt::format("{}", fmt::join(found, "\n")));
}

/// Nearest that liquid may be to the surface of a microparticle when one of both is placed, r_c.
constexpr double smallest_gap = 0.5;

Vector3d centre_of(const Microparticle& particle, const ContactSphere& sphere) {
  return particle.body.position + particle.body.orientation * sphere.offset;
}

/// How near a sphere's centre comes to the solid of a label grid when that is less than its radius.
double distance_to(const Solid& solid, const Vector3d& centre, double radius) {
  if (solid.contains(centre.cast<float>())) return 0;
  std::vector<SolidTouch> touches;
  solid.append_touches(centre, radius, touches);
  double nearest = radius;
  for (const SolidTouch& touch : touches) nearest = std::min(nearest, touch.distance);
  return nearest;
}

/// From a microparticle's surface to a place, r_c; where that is far, something far.
double gap_to(const Vector3d& place, const Microparticle& particle, const ShearedDomain& domain) {
  const Vector3d from_centre = domain.nearest_image(place - particle.body.position);
  double gap = from_centre.norm() - particle.bounding_radius;
  if (gap >= smallest_gap) return gap;
  gap = std::numeric_limits<double>::infinity();
  for (const ContactSphere& sphere : particle.contact_spheres)
    gap = std::min(gap, (from_centre - particle.body.orientation * sphere.offset).norm() - sphere.radius);
  return gap;
}

void require_apart(const Microparticle& particle, const std::vector<Vector3d>& liquid,
                   const ShearedDomain& domain) {
  for (const Vector3d& bead : liquid) {
    const double gap = gap_to(bead, particle, domain);
    if (gap < smallest_gap)
      throw InvalidInput(
          fmt::format("microparticle at ({:.4g}, {:.4g}, {:.4g}): {:.3g} r_c from its "
                      "surface to the liquid at ({:.4g}, {:.4g}, {:.4g}), allowed: {} or "
                      "more",
                      particle.body.position.x(), particle.body.position.y(), particle.body.position.z(), gap,
                      bead.x(), bead.y(), bead.z(), smallest_gap));
  }
}

}  // namespace

Microparticles::Microparticles(const Parameters& parameters)
    : parameters_(parameters), images_{parameters.domain}, solid_(parameters) {}

double Microparticles::largest_bounding_radius() const {
  double largest = 0;
  for (const Microparticle& particle : all_) largest = std::max(largest, particle.bounding_radius);
  return largest;
}

std::uint32_t Microparticles::add(const MicroparticlePlacement& placement,
                                  const std::vector<Vector3d>& liquid, double smallest_mass) {
  require_sound(placement, parameters_);
  Microparticle particle = shaped(placement, parameters_);
  if (particle.body.mass < smallest_mass)
    throw InvalidInput(
        fmt::format("microparticle.mass: {}, allowed: {:.4g} or more while the magnet pulls as "
                    "it does",
                    particle.body.mass, smallest_mass));
  require_room(particle);
  require_apart(particle, liquid, images_);
  particle.id = next_id_++;
  particle.first_bead = static_cast<std::uint32_t>(beads_.size());
  append_beads(particle);
  place_beads(particle, Vector3d::Zero());
  all_.push_back(std::move(particle));
  return all_.back().id;
}

void Microparticles::remove(std::uint32_t id) {
  const auto found = std::find_if(all_.begin(), all_.end(), [id](const auto& one) { return one.id == id; });
  if (found == all_.end()) {
    std::vector<std::uint32_t> known;
    for (const Microparticle& one : all_) known.push_back(one.id);
    throw InvalidInput(
        fmt::format("microparticle {} does not exist; microparticles are [{}]", id, fmt::join(known, ", ")));
  }
  const std::uint32_t first = found->first_bead, count = found->bead_count();
  const auto cut = [&](auto& array) { array.erase(array.begin() + first, array.begin() + first + count); };
  cut(beads_.position);
  cut(beads_.moving);
  cut(beads_.liquid_force);
  cut(beads_.wall_force);
  cut(beads_.listed);
  cut(beads_.own_density);
  beads_.key.resize(beads_.size());  // by index
  for (auto later = all_.erase(found); later != all_.end(); ++later) later->first_bead -= count;
}

void Microparticles::require_clear(const std::vector<Vector3d>& sites) const {
  for (const Microparticle& particle : all_) require_apart(particle, sites, images_);
}

bool Microparticles::clear_of(const Vector3d& site) const {
  return std::all_of(all_.begin(), all_.end(), [&](const Microparticle& particle) {
    return gap_to(site, particle, images_) >= smallest_gap;
  });
}

bool Microparticles::is_in_solid(const Microparticle& particle) const {
  return !solid_.empty() && std::any_of(particle.contact_spheres.begin(), particle.contact_spheres.end(),
                                        [&](const ContactSphere& sphere) {
                                          return solid_.contains(centre_of(particle, sphere).cast<float>());
                                        });
}

void Microparticles::require_room(const Microparticle& particle) const {
  const Domain& domain = parameters_.domain;
  static const char* const axes = "xyz";
  for (const ContactSphere& sphere : particle.contact_spheres) {
    const Vector3d centre = centre_of(particle, sphere);
    for (int axis = 0; axis < 3; ++axis) {
      if (parameters_.flat(axis)) continue;
      if (domain.periodic(axis)) {
        const double needed = 2.0 * (particle.bounding_radius + parameters_.liquid.cutoff_radius);
        if (domain.size()[axis] < needed)
          throw InvalidInput(
              fmt::format("microparticle: radius {}, allowed: {} or less, what fits into the "
                          "period along {}",
                          particle.bounding_radius,
                          0.5 * domain.size()[axis] - parameters_.liquid.cutoff_radius, axes[axis]));
        continue;
      }
      const double from = domain.lower[axis] + sphere.radius, to = domain.upper[axis] - sphere.radius;
      const double tolerance = 0.01 * sphere.radius;
      if (!(centre[axis] >= from - tolerance && centre[axis] <= to + tolerance))
        throw InvalidInput(fmt::format(
            "microparticle: center's {} {:.6g}, allowed: {:.6g} to {:.6g} for a radius of {} (r_c)",
            axes[axis], centre[axis], from, to, sphere.radius));
    }
    if (const double distance = distance_to(solid_, centre, sphere.radius); distance < 0.99 * sphere.radius)
      throw InvalidInput(fmt::format(
          "microparticle: its centre ({:.6g}, {:.6g}, {:.6g}) is {:.4g} r_c from the label grid's "
          "solid, allowed: its radius of {} or more",
          centre.x(), centre.y(), centre.z(), distance, sphere.radius));
    for (const Microparticle& other : all_)
      for (const ContactSphere& its : other.contact_spheres) {
        const double distance = images_.nearest_image(centre - centre_of(other, its)).norm();
        const double allowed = sphere.radius + its.radius;
        if (distance < allowed)
          throw InvalidInput(
              fmt::format("microparticle: {:.6g} r_c from microparticle {}, allowed: {:.6g} or more, "
                          "centre to centre",
                          distance, other.id, allowed));
      }
  }
}

void Microparticles::append_beads(const Microparticle& particle) {
  const std::size_t count = beads_.size() + particle.bead_count();
  for (AlignedVector<Record>* array :
       {&beads_.position, &beads_.moving, &beads_.liquid_force, &beads_.wall_force, &beads_.listed})
    array->resize(count);
  const std::vector<float> own = parameters_.microparticles.counts_own_beads
                                     ? own_densities(particle, parameters_)
                                     : std::vector<float>(particle.bead_count(), 0.f);
  beads_.own_density.insert(beads_.own_density.end(), own.begin(), own.end());
  while (beads_.key.size() < count)
    beads_.key.push_back(HWY_NAMESPACE::body_key(static_cast<std::uint32_t>(beads_.key.size())));
}

void Microparticles::place_beads(const Microparticle& particle, const Vector3d& centre_velocity) {
  const Eigen::Matrix3d turned = particle.body.orientation.toRotationMatrix();
  const Vector3d rate = particle.body.angular_velocity();
  const float attraction = static_cast<float>(particle.placement.attraction);
  for (std::uint32_t k = 0; k < particle.bead_count(); ++k) {
    const Vector3d arm = turned * particle.offsets[k];
    Record& moving = beads_.moving[particle.first_bead + k];
    beads_.position[particle.first_bead + k] = record_of(particle.body.position + arm, attraction);
    moving = record_of(centre_velocity + rate.cross(arm), moving.w);
  }
}

BodyDriftReport Microparticles::drift() {
  BodyDriftReport report;
  const double dt = parameters_.time_step;
  for (Microparticle& particle : all_) {
    RigidBody& body = particle.body;
    body.velocity += 0.5 * dt / body.mass * particle.force;
    body.angular_momentum += 0.5 * dt * particle.torque;
    const FrictionReport friction =
        apply_friction(parameters_.microparticles.contact, particle.friction, particle.contacts, dt, body);
    particle.totals.friction_force += friction.force;
    const Vector3d centre_velocity = body.velocity + friction.rolling;
    const double way =
        dt * (centre_velocity.norm() + particle.bounding_radius * body.angular_velocity().norm());
    const bool too_far = !(way < largest_step);
    body.position += dt * centre_velocity;
    body.turn(dt);
    if (too_far || is_in_solid(particle)) report.wild = particle.id;
    place_beads(particle, centre_velocity);
  }
  for (std::size_t k = 0; k < beads_.size(); ++k)
    report.largest_displacement_squared = std::max(
        report.largest_displacement_squared,
        static_cast<float>((vector_of(beads_.position[k]) - vector_of(beads_.listed[k])).squaredNorm()));
  return report;
}

void Microparticles::finish(const BodyForces& far) {
  const double dt = parameters_.time_step;
  for (Microparticle& particle : all_) {
    const Eigen::Matrix3d turned = particle.body.orientation.toRotationMatrix();
    Vector3d drive = Vector3d::Zero();
    particle.force = particle.torque = Vector3d::Zero();
    for (std::uint32_t k = 0; k < particle.bead_count(); ++k) {
      const Vector3d of_liquid = vector_of(beads_.liquid_force[particle.first_bead + k]);
      const Vector3d force = of_liquid + vector_of(beads_.wall_force[particle.first_bead + k]);
      drive += of_liquid;
      particle.force += force;
      particle.torque += (turned * particle.offsets[k]).cross(force);
    }
    particle.force += particle.body.mass * far.gravity;
    if (particle.placement.magnetic) particle.force += far.magnetic;
    touch_walls(particle);
    particle.totals.drive_force += drive;
  }
  touch_each_other();
  touch_mirror_images();
  for (Microparticle& particle : all_) {
    particle.body.velocity += 0.5 * dt / particle.body.mass * particle.force;
    particle.body.angular_momentum += 0.5 * dt * particle.torque;
    MicroparticleTotals& totals = particle.totals;
    ++totals.steps;
    totals.height += particle.body.position.z() - parameters_.domain.lower.z();
    bool stands = false;
    for (const WallContact& contact : particle.contacts)
      if (contact.normal.z() > 0) {
        stands = true;
        totals.normal_force += contact.normal_force * contact.normal.z();
      }
    totals.steps_in_contact += stands ? 1 : 0;
  }
}

void Microparticles::note_listed() {
  for (Microparticle& particle : all_) {
    const Vector3d shift = images_.shift_into(particle.body.position);
    if (shift.isZero()) continue;
    const double slower = images_.velocity_shift(shift);
    particle.body.position += shift;
    particle.body.velocity.x() += slower;
    for (std::uint32_t k = particle.first_bead; k < particle.first_bead + particle.bead_count(); ++k) {
      beads_.position[k] = record_of(vector_of(beads_.position[k]) + shift, beads_.position[k].w);
      beads_.moving[k].x = static_cast<float>(beads_.moving[k].x + slower);
    }
  }
  beads_.listed = beads_.position;
}

void Microparticles::note_look() {
  for (Microparticle& particle : all_) {
    const MicroparticleTotals &now = particle.totals, &before = particle.last_look;
    if (now.steps == before.steps) continue;
    const double steps = static_cast<double>(now.steps - before.steps);
    particle.means = {static_cast<double>(now.steps_in_contact - before.steps_in_contact) / steps,
                      (now.normal_force - before.normal_force) / steps,
                      (now.drive_force - before.drive_force) / steps,
                      (now.friction_force - before.friction_force) / steps};
    particle.last_look = now;
  }
}

}  // namespace dmf::engine
