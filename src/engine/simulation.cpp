#include "engine/simulation_state.h"

namespace dmf::engine {
namespace {
Vector3d velocity_of(const Record& record) { return {record.x, record.y, record.z}; }
}  // namespace

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
    virial = virial_of(s.beads, s.pairs.blocks(), s.pairs.ghosts(), s.bonds, s.parameters);
    snapshot->virial = virial.total;
  }
  if (request.stress)
    snapshot->stress =
        stress_profile(*request.stress, s.beads, s.pairs.blocks(), s.pairs.ghosts(), s.bonds, s.parameters);
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
    loaded->pairs.set_protrusion(loaded->microparticles.largest_bounding_radius());
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