#include "engine/simulation.h"

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
#include "engine/observe/state_hash.h"
#include "engine/observe/temperature.h"
#include "engine/observe/virial.h"
#include "engine/observe/watchdog.h"
#include "engine/observe/wetted_area.h"
#include "engine/pairs.h"
#include "engine/placement.h"
#include "engine/saved_state.h"
#include "engine/thermostat.h"
#include "engine/walls/walls.h"

namespace dmf::engine {
namespace {

const Parameters& checked(const Parameters& parameters) {
  const std::vector<std::string> found = violations(parameters);
  if (!found.empty()) throw InvalidInput(fmt::format("{}", fmt::join(found, "\n")));
  return parameters;
}

Vector3d velocity_of(const Record& record) { return {record.x, record.y, record.z}; }

}  // namespace

struct Simulation::State {
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
    if (parameters.dimensions == 2 && forces.gravity.y() != 0)
      throw InvalidInput(
          fmt::format("body_forces.gravity: {} along y, allowed: 0 with dimensions: 2", forces.gravity.y()));
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
        "microparticle {} moves more than {} r_c a step, or to no number; look at time_step ({}), "
        "elastic_modulus ({}), its mass and the forces on it",
        report.wild, largest_step, parameters.time_step, parameters.microparticles.elastic_modulus));
  }

  /// Images beyond sheared and symmetric sides go along. @param moved  of the present step, as far as the
  /// beads have moved in it.
  void advance_images(double moved) {
    if (!pairs.ghosts().needed()) return;
    pairs.ghosts().advance((static_cast<double>(step) + moved) * parameters.time_step, step);
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
    tracker.update(step, beads, pairs.blocks());
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
    seen.place = place_in(carried, particle.body.position, tracker.droplets(), parameters.domain);
    seen.totals = particle.totals;
    return seen;
  }

  void archive(Archive& archive) {
    // 1: beads in the order of neighbour lists. 2: no microparticles. 3: not whence the vapour is. 4: one
    // liquid, no bonds, no sheared sides.
    constexpr std::uint64_t current = 5;
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

Simulation::Simulation(const Parameters& parameters, ContactAngleCurve curve, const Execution& execution)
    : state_(std::make_unique<State>(parameters, std::move(curve), execution)) {
  state_->wall.set_fixed_wettability(parameters, state_->curve);
  if (fixed_wall_attraction(parameters)) return;
  const double angle = state_->curve.max_angle();
  set_wettability([angle](double, double) { return angle; });
}

Simulation::~Simulation() = default;

void Simulation::step() {
  State& s = *state_;
  if (!s.fault.empty()) throw Instability(s.fault);
  omp_set_num_threads(s.threads);

  // Voltages have become wettability in set_wettability(), between steps.
  if (s.parameters.integrator == Integrator::groot_warren) {
    const DriftReport moved = drift(s.beads, s.parameters, s.step, s.wall.solid());
    s.advance_images(1);
    s.keep_pairs(moved, s.microparticles.drift());
    s.forces.density(s.beads, s.wall, s.microparticles, s.pairs);
    s.forces.force(s.beads, s.wall, s.microparticles, s.pairs);
    if (!s.far.gravity.isZero()) add_gravity(s.beads, s.far.gravity);
    s.add_bond_forces();
    finish(s.beads, s.parameters);
    s.microparticles.finish(s.far);
  } else {
    const DriftReport half_way = kick_and_half_drift(s.beads, s.parameters, s.step, s.wall.solid());
    s.advance_images(0.5);
    s.keep_pairs(half_way);
    thermostat(s.beads, s.wall, s.microparticles, s.pairs, s.forces, s.parameters);
    const DriftReport moved = half_drift(s.beads, s.parameters, s.step, s.wall.solid());
    s.advance_images(1);
    s.keep_pairs(moved);
    s.forces.density(s.beads, s.wall, s.microparticles, s.pairs);
    s.forces.force(PairForce::conservative, s.beads.force, s.beads, s.wall, s.microparticles, s.pairs);
    if (!s.far.gravity.isZero()) add_gravity(s.beads, s.far.gravity);
    s.add_bond_forces();
  }
  ++s.step;

  if (s.step % s.parameters.observe_interval == 0) {
    s.look();
    s.require_sound();
  }
}

/// After beads came or went: lists and droplets are up to date again.
void Simulation::refresh() {
  State& s = *state_;
  omp_set_num_threads(s.threads);
  s.advance_images(0);
  s.find_pairs();
  s.forces.density(s.beads, s.wall, s.microparticles, s.pairs);
  s.look();
}

void Simulation::set_wettability(const ContactAngleField& field) {
  if (const auto given = fixed_wall_attraction(state_->parameters))
    throw InvalidInput(fmt::format(
        "wettability: a contact angle, allowed: none on a wall whose attraction is given ({})", *given));
  state_->wall.set_wettability(field, state_->curve);
}

std::size_t Simulation::add_droplet(const DropletPlacement& placement) {
  const std::vector<Vector3d> sites = droplet_sites(placement, state_->parameters);
  state_->require_room(sites);
  require_free(state_->beads, sites, state_->parameters);
  return place(sites, placement.species);
}

std::size_t Simulation::fill(const FillPlacement& placement) {
  const State& s = *state_;
  const std::vector<Vector3d> sites = free_sites(placement, s.beads, s.microparticles, s.parameters);
  s.require_room(sites);
  return place(sites, placement.species);
}

std::size_t Simulation::place(const std::vector<Vector3d>& sites, std::uint32_t species) {
  State& s = *state_;
  const std::size_t placed =
      place_beads(s.beads, sites, species, s.parameters, s.step, s.next_bead_id).size();
  refresh();
  return placed;
}

std::size_t Simulation::fill_box() {
  return fill_slab(state_->parameters.domain.lower, state_->parameters.domain.upper);
}

std::size_t Simulation::fill_slab(const Vector3d& lower, const Vector3d& upper) {
  const std::vector<Vector3d> sites = slab_sites({lower, upper}, state_->parameters);
  state_->require_room(sites);
  require_free(state_->beads, sites, state_->parameters);
  return place(sites, 0);
}

namespace {
void require_sound(const std::vector<std::string>& wrong) {
  if (!wrong.empty()) throw InvalidInput(fmt::format("{}", fmt::join(wrong, "\n")));
}
}  // namespace

std::vector<std::uint32_t> Simulation::take(const std::vector<Vector3d>& sites) {
  State& s = *state_;
  s.require_room_for_bonded(static_cast<double>(sites.size()));
  s.microparticles.require_clear(sites);
  return take_sites(s.beads, sites, s.bonds, s.parameters, s.step, s.next_bead_id);
}

void Simulation::require_bonds_allowed() const {
  const State& s = *state_;
  if (s.parameters.dimensions == 2 || s.pairs.ghosts().needed())
    throw InvalidInput(
        "bonds: with dimensions: 2, symmetric sides or a shear rate, allowed: in three dimensions without");
}

std::uint32_t Simulation::add_chains(const ChainPlacement& placement) {
  require_bonds_allowed();
  State& s = *state_;
  require_sound(violations(placement, s.parameters));
  s.require_room_for_bonded(placement.points.empty() ? 1.0 * placement.count * placement.beads : 0.0);
  const std::uint32_t first = s.bonds.next_chain();
  const std::vector<std::vector<Vector3d>> chains = chain_sites(placement, s.parameters, s.step, first);
  std::vector<Vector3d> sites;
  for (const std::vector<Vector3d>& chain : chains) sites.insert(sites.end(), chain.begin(), chain.end());
  const std::vector<std::uint32_t> ids = take(sites);
  auto next = ids.begin();
  for (const std::vector<Vector3d>& chain : chains) {
    const auto end = next + static_cast<std::ptrdiff_t>(chain.size());
    s.bonds.bind_chain(placement.spring, placement.stretching_force, {next, end});
    next = end;
  }
  refresh();
  return first;
}

std::uint32_t Simulation::add_membrane(const MembranePlacement& placement) {
  require_bonds_allowed();
  State& s = *state_;
  require_sound(violations(placement, s.parameters));
  const std::uint32_t id = s.bonds.bind_membrane(placement, take(placement.mesh->vertices));
  refresh();
  return id;
}

void Simulation::remove_droplet(std::uint32_t id) {
  State& s = *state_;
  std::vector<bool> gone(s.next_bead_id, false);
  bool there = false;
  for (const std::uint32_t bead : s.beads.id) {
    gone[bead] = id != 0 && s.tracker.droplet_of(bead) == id;
    there = there || gone[bead];
  }
  if (!there) {
    std::vector<std::uint32_t> known;
    for (const DropletObservation& droplet : s.tracker.droplets()) known.push_back(droplet.id);
    throw InvalidInput(
        fmt::format("droplet {} does not exist; droplets are [{}]", id, fmt::join(known, ", ")));
  }
  s.tracker.forget(id);
  s.bonds.remove_with(gone);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < s.beads.size(); ++i)
    if (!gone[s.beads.id[i]]) kept.push_back(i);
  s.beads.reorder(kept);
  refresh();
}

std::shared_ptr<const Snapshot> Simulation::observe(const ObserveRequest& request) const {
  const State& s = *state_;
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->step = s.step;
  snapshot->time = time();
  snapshot->temperature = s.temperature();
  for (const Record& v : s.beads.velocity) snapshot->momentum += velocity_of(v);
  snapshot->moving_beads = s.beads.size();
  snapshot->wall_beads = s.wall.size();
  snapshot->vapour_beads = s.tracker.vapour_beads();
  snapshot->droplets = s.tracker.droplets();
  for (const Microparticle& particle : s.microparticles.all())
    snapshot->microparticles.push_back(s.observed(particle));
  snapshot->chains = s.bonds.observe_chains(s.beads);
  snapshot->membranes = s.bonds.observe_membranes(s.beads);
  Virial virial;
  if (request.virial) {
    virial = virial_of(s.beads, s.pairs.blocks(), s.pairs.ghosts(), s.parameters);
    snapshot->virial = virial.total;
  }
  if (request.stress)
    snapshot->stress =
        stress_profile(*request.stress, s.beads, s.pairs.blocks(), s.pairs.ghosts(), s.parameters);
  if (request.hash) snapshot->state_hash = state_hash(s.step, s.beads, s.wall, s.microparticles, s.bonds);
  if (request.wetted && s.parameters.domain.has_wall())
    snapshot->wetted = wetted_area(s.beads, s.parameters.domain.lower.z(), s.parameters);
  if (request.beads) {
    std::vector<std::uint32_t> index_of_id(s.next_bead_id, 0xffffffffu);
    for (std::uint32_t i = 0; i < s.beads.size(); ++i) index_of_id[s.beads.id[i]] = i;
    for (std::uint32_t id = 0; id < s.next_bead_id; ++id) {
      if (index_of_id[id] == 0xffffffffu) continue;
      const Record &p = s.beads.position[index_of_id[id]], &v = s.beads.velocity[index_of_id[id]];
      snapshot->positions.emplace_back(p.x, p.y, p.z);
      snapshot->velocities.emplace_back(v.x, v.y, v.z);
      snapshot->bead_ids.push_back(id);
      snapshot->bead_droplets.push_back(s.tracker.droplet_of(id));
      if (!s.beads.species.empty()) snapshot->bead_species.push_back(s.beads.species[index_of_id[id]]);
      if (request.virial) snapshot->bead_virials.push_back(virial.of_bead[index_of_id[id]]);
    }
  }
  return snapshot;
}

std::uint32_t Simulation::add_microparticle(const MicroparticlePlacement& placement) {
  State& s = *state_;
  const BoundaryParameters& boundaries = s.parameters.boundaries;
  if (s.parameters.dimensions == 2 || boundaries.moving() || s.pairs.ghosts().needed())
    throw InvalidInput(
        "microparticle: with dimensions: 2, sides that move or are symmetric, or a shear rate, allowed: in "
        "three dimensions without");
  const std::size_t told = std::max<std::size_t>({1, placement.beads, placement.points.size()});
  require_memory(s.parameters, static_cast<double>(s.beads.size()),
                 static_cast<double>(s.microparticles.beads().size() + told),
                 static_cast<double>(s.bonds.bead_count()));
  std::vector<Vector3d> liquid;
  for (const Record& bead : s.beads.position) liquid.emplace_back(bead.x, bead.y, bead.z);
  const double force = placement.magnetic ? s.far.magnetic.norm() : 0.0;
  const std::uint32_t id = s.microparticles.add(placement, liquid, force / s.largest_acceleration());
  refresh();
  return id;
}

void Simulation::remove_microparticle(std::uint32_t id) {
  state_->microparticles.remove(id);
  refresh();
}

void Simulation::set_body_forces(const BodyForces& forces) {
  state_->require_sound(forces);
  state_->far = forces;
}

const BodyForces& Simulation::body_forces() const { return state_->far; }

std::vector<MicroparticleEvent> Simulation::take_microparticle_events() {
  return state_->carriage.take_events();
}

std::vector<DropletEvent> Simulation::take_events() { return state_->tracker.take_events(); }

std::string Simulation::save_state() const {
  Archive archive;
  state_->archive(archive);
  return archive.take();
}

void Simulation::load_state(const std::string& bytes) {
  const State& s = *state_;
  auto loaded = std::make_unique<State>(s.parameters, s.curve, Execution{s.threads, s.forces.kernel_name()});
  Archive archive(bytes);
  loaded->archive(archive);
  if (!archive.at_end()) throw InvalidInput("saved state: longer than it should be");
  require_sound(loaded->beads, loaded->next_bead_id, loaded->tracker, s.parameters);
  loaded->bonds.require_sound(loaded->beads);
  omp_set_num_threads(s.threads);
  try {
    loaded->pairs.restore(loaded->beads, loaded->wall);
    loaded->advance_images(0);
    loaded->pairs.find_bodies(loaded->microparticles, loaded->beads, loaded->wall);
    loaded->bonds.find(loaded->beads);
  } catch (const std::length_error& crowd) {
    throw InvalidInput(fmt::format("saved state: {}", crowd.what()));
  }
  loaded->forces.density(loaded->beads, loaded->wall, loaded->microparticles, loaded->pairs);
  state_ = std::move(loaded);
}

std::uint64_t Simulation::steps() const { return state_->step; }
double Simulation::time() const { return static_cast<double>(state_->step) * state_->parameters.time_step; }
const Parameters& Simulation::parameters() const { return state_->parameters; }
const ContactAngleCurve& Simulation::curve() const { return state_->curve; }
const std::string& Simulation::kernel() const { return state_->forces.kernel_name(); }
int Simulation::threads() const { return state_->threads; }

}  // namespace dmf::engine
