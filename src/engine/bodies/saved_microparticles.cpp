#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "engine/bodies/microparticles.h"
#include "engine/bodies/shape.h"
#include "engine/saved_state.h"

// How microparticles are saved, and what of a saved one is refused.

namespace dmf::engine {

namespace {

void archive_placement(Archive& archive, MicroparticlePlacement& placement) {
  archive(placement.center.x());
  archive(placement.center.y());
  archive(placement.z);
  archive(placement.radius);
  archive(placement.beads);
  archive(placement.smooth);
  std::uint64_t points = placement.points.size();
  archive(points);
  if (archive.reading()) {
    archive.require_left(points, 3 * sizeof(double));
    if (points > largest_bead_count) throw InvalidInput("saved state: a microparticle of too many points");
    placement.points.resize(points);
  }
  for (Vector3d& point : placement.points) archive(point);
  archive(placement.mass);
  archive(placement.attraction);
  archive(placement.static_friction);
  archive(placement.kinetic_friction);
  archive(placement.rolling_friction);
  archive(placement.magnetic);
}

void archive_totals(Archive& archive, MicroparticleTotals& totals) {
  archive(totals.steps);
  archive(totals.steps_in_contact);
  archive(totals.height);
  archive(totals.normal_force);
  archive(totals.drive_force);
  archive(totals.friction_force);
}

void archive_motion(Archive& archive, Microparticle& particle) {
  archive(particle.body.position);
  for (int k = 0; k < 4; ++k) archive(particle.body.orientation.coeffs()[k]);
  archive(particle.body.velocity);
  archive(particle.body.angular_momentum);
  archive(particle.force);
  archive(particle.torque);
  std::uint64_t contacts = particle.contacts.size();
  archive(contacts);
  archive.require_left(contacts, 11 * sizeof(double));
  if (archive.reading()) particle.contacts.resize(contacts);
  for (WallContact& contact : particle.contacts) {
    archive(contact.arm);
    archive(contact.normal);
    archive(contact.radius);
    archive(contact.normal_force);
    archive(contact.velocity);
    if (!(std::abs(contact.normal.squaredNorm() - 1) < 1e-9))
      throw InvalidInput("saved state: a microparticle touches a wall that faces nowhere");
  }
  archive_totals(archive, particle.totals);
  archive_totals(archive, particle.last_look);
  archive(particle.means.contact_fraction);
  archive(particle.means.normal_force);
  archive(particle.means.drive_force);
  archive(particle.means.friction_force);
}

/// Whether what was read can be a body of a run.
void require_sound_motion(const Microparticle& particle, const Domain& domain) {
  const RigidBody& body = particle.body;
  const bool finite = body.position.allFinite() && body.velocity.allFinite() &&
                      body.angular_momentum.allFinite() && particle.force.allFinite() &&
                      particle.torque.allFinite() && std::abs(body.orientation.norm() - 1) < 1e-3;
  if (!finite)
    throw InvalidInput(fmt::format("saved state: microparticle {} moves to no number", particle.id));
  const Eigen::Vector3f centre = body.position.cast<float>();
  require_inside({centre.x(), centre.y(), centre.z(), 0.f}, particle.bounding_radius + 1, domain);
}

}  // namespace

void Microparticles::archive(Archive& archive) {
  archive(next_id_);
  std::uint64_t count = all_.size();
  archive(count);
  for (std::uint64_t k = 0; k < count; ++k) {
    if (archive.reading()) {
      MicroparticlePlacement placement;
      archive_placement(archive, placement);
      const std::vector<std::string> wrong = violations(placement, parameters_);
      if (!wrong.empty()) throw InvalidInput(fmt::format("saved state: {}", fmt::join(wrong, "; ")));
      Microparticle particle = shaped(placement, parameters_);
      particle.first_bead = static_cast<std::uint32_t>(beads_.size());
      append_beads(particle);
      all_.push_back(std::move(particle));
    } else {
      archive_placement(archive, all_[k].placement);
    }
    archive(all_[k].id);
    archive_motion(archive, all_[k]);
    if (!archive.reading()) continue;
    if (all_[k].id >= next_id_ || all_[k].id <= (k > 0 ? all_[k - 1].id : 0))
      throw InvalidInput(
          fmt::format("saved state: microparticle {}, allowed: rising ids below {}", all_[k].id, next_id_));
    require_sound_motion(all_[k], parameters_.domain);
    // A few bytes make a shell of thousands of beads: each has three records below.
    archive.require_left(beads_.size(), 3 * sizeof(Record));
  }
  for (AlignedVector<Record>* array : {&beads_.position, &beads_.moving, &beads_.listed}) {
    archive(*array);
    if (array->size() != beads_.own_density.size())
      throw InvalidInput("saved state: beads of microparticles are missing");
  }
  if (!archive.reading()) return;
  for (const Microparticle& particle : all_)
    for (std::uint32_t k = particle.first_bead; k < particle.first_bead + particle.bead_count(); ++k)
      for (const Record& place : {beads_.position[k], beads_.listed[k]})
        require_inside(place, 2 * particle.bounding_radius + 2, parameters_.domain);
}

}  // namespace dmf::engine
