#pragma once
// What a simulation holds and its members share. Not for others.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>

#include <cmath>
#include <limits>

#include "engine/archive.h"
#include "engine/beads.h"
#include "engine/bodies/microparticles.h"
#include "engine/bonds/bonded_placement.h"
#include "engine/bonds/bonds.h"
#include "engine/forces.h"
#include "engine/integrate.h"
#include "engine/memory.h"
#include "engine/observe/carriage.h"
#include "engine/observe/droplet_tracker.h"
#include "engine/observe/solvents.h"
#include "engine/observe/state_hash.h"
#include "engine/observe/temperature.h"
#include "engine/observe/virial.h"
#include "engine/observe/watchdog.h"
#include "engine/observe/wetted_area.h"
#include "engine/pairs.h"
#include "engine/placement.h"
#include "engine/saved_state.h"
#include "engine/simulation.h"
#include "engine/thermostat.h"
#include "engine/walls/walls.h"

namespace dmf::engine {

struct Simulation::State {
  /// @throws InvalidInput, naming all that is wrong with the parameters.
  State(const Parameters& p, ContactAngleCurve c, const Execution& execution)
      : parameters(checked(p)),
        curve(std::move(c)),
        threads(execution.threads > 0 ? execution.threads : omp_get_max_threads()),
        wall(parameters),
        microparticles(parameters),
        bonds(parameters),
        pairs(parameters),
        forces(parameters, execution.kernel),
        tracker(parameters) {}

  static const Parameters& checked(const Parameters& parameters) {
    const std::vector<std::string> found = violations(parameters);
    if (!found.empty()) throw InvalidInput(fmt::format("{}", fmt::join(found, "\n")));
    return parameters;
  }

  Parameters parameters;
  ContactAngleCurve curve;
  int threads;
  Walls wall;
  Beads beads;
  Microparticles microparticles;
  Bonds bonds;
  Pairs pairs;
  Forces forces;
  DropletTracker tracker;
  Carriage carriage;
  BodyForces far;
  std::uint64_t step = 0;
  std::uint32_t next_bead_id = 0;
  std::string fault;

  /// Of a liquid that flows, or is hot enough to be one, what moves relative to the beads around it.
  double temperature() const {
    const double kinetic = kinetic_temperature(beads, parameters.dimensions);
    const bool driven =
        !far.gravity.isZero(0) || parameters.boundaries.moving() || parameters.boundaries.shear_rate != 0;
    if (!driven && kinetic <= parameters.watchdog.highest_temperature * parameters.liquid.temperature)
      return kinetic;
    const double local = local_temperature(beads, pairs.blocks(), parameters.dimensions);
    return local > 0 ? local : kinetic;
  }

  /// What a force from afar may do: what starts from rest in every step anew moves by a dt^2, at most 0.001
  /// r_c.
  double largest_acceleration() const { return 1e-3 / (parameters.time_step * parameters.time_step); }

  void require_sound(const BodyForces& forces) const {
    const double largest = largest_acceleration();
    const auto check = [](const char* key, const Vector3d& value, double allowed, const char* unit) {
      if (!value.allFinite() || value.norm() > allowed)
        throw InvalidInput(fmt::format("{}: ({}, {}, {}), allowed: finite, a magnitude of up to {:.4g} ({})",
                                       key, value.x(), value.y(), value.z(), allowed, unit));
    };
    check("body_forces.gravity", forces.gravity, largest, "r_c / tau^2");
    for (const auto& [key, force] :
         {std::pair("gravity", forces.gravity), std::pair("magnetic", forces.magnetic)})
      if (parameters.dimensions == 2 && force.y() != 0)
        throw InvalidInput(
            fmt::format("body_forces.{}: {} along y, allowed: 0 with dimensions: 2", key, force.y()));
    double lightest = std::numeric_limits<double>::infinity();
    for (const Microparticle& particle : microparticles.all())
      if (particle.placement.magnetic) lightest = std::min(lightest, particle.body.mass);
    check("body_forces.magnetic", forces.magnetic, largest * lightest, "k_BT / r_c");
  }

  /// For liquid at these places. @throws InvalidInput.
  void require_room(const std::vector<Vector3d>& sites) const {
    require_memory(parameters, static_cast<double>(beads.size() + sites.size()),
                   static_cast<double>(microparticles.beads().size()),
                   static_cast<double>(bonds.bead_count()));
    microparticles.require_clear(sites);
  }

  /// Stops the run for good. @throws Instability.
  [[noreturn]] void stop(const std::string& why) {
    fault =
        fmt::format("step {} (time {:.6g}): {}", step, static_cast<double>(step) * parameters.time_step, why);
    throw Instability(fault);
  }

  void require_sound_drift(const DriftReport& report) {
    if (report.wild_bead < 0) return;
    const Record& p = beads.position[report.wild_bead];
    const Record& v = beads.velocity[report.wild_bead];
    stop(fmt::format(
        "bead {} (droplet {}, 0 is the vapour) at ({:.3f}, {:.3f}, {:.3f}) moves with velocity ({:.3g}, "
        "{:.3g}, {:.3g}), more than {} r_c a step or to no number; look at time_step ({}) and the liquid's "
        "attraction and repulsion",
        beads.id[report.wild_bead], tracker.droplet_of(beads.id[report.wild_bead]), p.x, p.y, p.z, v.x, v.y,
        v.z, largest_step, parameters.time_step));
  }

  void require_sound_bodies(const BodyDriftReport& report) {
    if (report.wild == 0) return;
    stop(fmt::format(
        "microparticle {} moves more than {} r_c a step, to no number or into the solid of the label grid; "
        "look at time_step ({}), elastic_modulus ({}), its mass and the forces on it",
        report.wild, largest_step, parameters.time_step, parameters.microparticles.elastic_modulus));
  }

  /// Images beyond sheared and symmetric sides go along. @param moved  of the present step, as far as the
  /// beads have moved in it.
  void advance_images(double moved) {
    if (!pairs.ghosts().needed()) return;
    pairs.ghosts().advance((static_cast<double>(step) + moved) * parameters.time_step, step);
    microparticles.set_images(pairs.ghosts().images());
    bonds.set_images(pairs.ghosts().images());
  }

  /// After every move: stops a run that jumped, sorts beads anew when cells may miss a pair.
  void keep_pairs(const DriftReport& moved, const BodyDriftReport& bodies_moved = {}) {
    require_sound_drift(moved);
    require_sound_bodies(bodies_moved);
    if (pairs.stale(std::max(moved.largest_displacement_squared, bodies_moved.largest_displacement_squared)))
      find_pairs();
  }

  void find_pairs() {
    try {
      pairs.set_protrusion(microparticles.largest_bounding_radius());
      pairs.rebuild(beads, wall);
      if (!bonds.empty()) bonds.find(beads);
      if (microparticles.empty()) return pairs.forget_bodies();
      microparticles.note_listed();
      pairs.find_bodies(microparticles, beads, wall);
    } catch (const std::length_error& crowd) {
      stop(fmt::format("{}: the liquid has collapsed; look at its attraction and repulsion", crowd.what()));
    }
  }

  /// Told before their places are worked out.
  void require_room_for_bonded(double more) const {
    require_memory(parameters, static_cast<double>(beads.size()) + more,
                   static_cast<double>(microparticles.beads().size()),
                   static_cast<double>(bonds.bead_count()) + more);
  }

  void add_bond_forces() {
    if (bonds.empty()) return;
    const std::string broken = bonds.add_forces(beads);
    if (!broken.empty()) stop(broken);
  }

  void look() {
    tracker.update(step, beads, pairs, solvents(beads, pairs, bonds));
    carriage.update(step, microparticles, beads, pairs, parameters, tracker);
    microparticles.note_look();
  }

  void require_sound() {
    const std::string found = find_fault(parameters, beads, temperature(), microparticles, tracker, carriage);
    if (!found.empty()) stop(found);
  }

  MicroparticleObservation observed(const Microparticle& particle) const {
    MicroparticleObservation seen;
    const Carriage::Entry carried = carriage.of(particle.id);
    seen.id = particle.id;
    seen.radius = particle.bounding_radius;
    seen.magnetic = particle.placement.magnetic;
    seen.points = particle.points;
    seen.point_radius = particle.points ? particle.placement.radius : 0.0;
    seen.beads = particle.bead_count();
    seen.mass = particle.body.mass;
    seen.attraction = particle.placement.attraction;
    seen.position = particle.body.position;
    seen.orientation = particle.body.orientation;
    seen.velocity = particle.body.velocity;
    seen.angular_velocity = particle.body.angular_velocity();
    seen.contact_fraction = particle.means.contact_fraction;
    seen.normal_force = particle.means.normal_force;
    seen.drive_force = particle.means.drive_force;
    seen.friction_force = particle.means.friction_force;
    seen.immersion = carried.immersion;
    seen.droplet = carried.droplet;
    seen.place = place_in(carried, particle.body.position, tracker.droplets(), pairs.ghosts().images());
    seen.totals = particle.totals;
    return seen;
  }

  void archive(Archive& archive) {
    // 1: beads in the order of neighbour lists. 2: no microparticles. 3: not whence the vapour is. 4: one
    // liquid, no bonds, no sheared sides. 5: microparticles touch plates only, which rest.
    constexpr std::uint64_t current = 6;
    std::uint64_t format = current;
    // What a bead takes below, and a profile a droplet.
    if (!archive.reading()) archive.reserve(90 * beads.size() + 4 * wall.size() + (1u << 16));
    archive(format);
    if (format != current)
      throw InvalidInput(fmt::format("saved state: format {}, allowed: {}", format, current));
    archive(step);
    if (step > most_steps)
      throw InvalidInput(fmt::format("saved state: step {}, allowed: up to {}", step, most_steps));
    archive(next_bead_id);
    for (AlignedVector<Record>* array :
         {&beads.position, &beads.predicted, &beads.velocity, &beads.force, &beads.listed})
      archive(*array);
    archive(beads.id);
    archive(beads.species);
    std::vector<float> attraction = wall.attraction();
    archive(attraction);
    wall.set_attraction(attraction);
    tracker.archive(archive);
    microparticles.archive(archive);
    carriage.archive(archive);
    archive(far.gravity);
    archive(far.magnetic);
    require_sound(far);
    bonds.archive(archive);
    pairs.ghosts().archive(archive);
  }
};

}  // namespace dmf::engine
