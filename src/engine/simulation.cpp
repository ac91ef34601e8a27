#include "engine/simulation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>

#include <cmath>

#include "engine/archive.h"
#include "engine/beads.h"
#include "engine/forces.h"
#include "engine/integrate.h"
#include "engine/observe/droplet_tracker.h"
#include "engine/observe/state_hash.h"
#include "engine/observe/virial.h"
#include "engine/pairs.h"
#include "engine/placement.h"
#include "engine/thermostat.h"
#include "engine/walls/plane_wall.h"

namespace dmf::engine {
namespace {

const Parameters& checked(const Parameters& parameters) {
  const std::vector<std::string> found = violations(parameters);
  if (!found.empty()) throw InvalidInput(fmt::format("{}", fmt::join(found, "\n")));
  return parameters;
}

/// Mean kinetic temperature above this many times the set one is a run that is blowing up.
constexpr double runaway_factor = 5.0;

Vector3d velocity_of(const Record& record) { return {record.x, record.y, record.z}; }

}  // namespace

struct Simulation::State {
  State(const Parameters& p, ContactAngleCurve c, const Execution& execution)
      : parameters(checked(p)),
        curve(std::move(c)),
        threads(execution.threads > 0 ? execution.threads : omp_get_max_threads()),
        wall(parameters.domain, parameters.wall, parameters.liquid.cutoff_radius + parameters.list_skin),
        pairs(parameters),
        forces(parameters, execution.kernel),
        tracker(parameters, wall.plane()) {}

  Parameters parameters;
  ContactAngleCurve curve;
  int threads;
  PlaneWall wall;
  Beads beads;
  Pairs pairs;
  Forces forces;
  DropletTracker tracker;
  std::uint64_t step = 0;
  std::uint32_t next_bead_id = 0;
  std::string fault;

  double temperature() const {
    double twice_energy = 0;
    for (const Record& v : beads.velocity) twice_energy += velocity_of(v).squaredNorm();
    return beads.size() > 0 ? twice_energy / (3.0 * static_cast<double>(beads.size())) : 0.0;
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
        "bead {} at ({:.3f}, {:.3f}, {:.3f}) moves with velocity ({:.3g}, {:.3g}, {:.3g}), more than {} r_c "
        "a step; look at time_step ({}) and the liquid's attraction and repulsion",
        beads.id[report.wild_bead], p.x, p.y, p.z, v.x, v.y, v.z, largest_step, parameters.time_step));
  }

  /// After every move: stops a run that jumped, sorts beads anew when cells may miss a pair.
  void keep_pairs(const DriftReport& moved) {
    require_sound_drift(moved);
    if (!pairs.stale(moved.largest_displacement_squared)) return;
    try {
      pairs.rebuild(beads, wall);
    } catch (const std::length_error& crowd) {
      stop(fmt::format("{}: the liquid has collapsed; look at its attraction and repulsion", crowd.what()));
    }
  }

  void require_sound_temperature() {
    const double now = temperature();
    if (!(now <= runaway_factor * parameters.liquid.temperature))
      stop(fmt::format("temperature {:.4g} against {} set; look at time_step ({}) and random_amplitude ({})",
                       now, parameters.liquid.temperature, parameters.time_step,
                       parameters.liquid.random_amplitude));
  }

  void archive(Archive& archive) {
    constexpr std::uint64_t current = 2;  // 1: beads in the order of neighbour lists
    std::uint64_t format = current;
    archive(format);
    if (format != current)
      throw InvalidInput(fmt::format("saved state: format {}, allowed: {}", format, current));
    archive(step);
    archive(next_bead_id);
    for (AlignedVector<Record>* array :
         {&beads.position, &beads.predicted, &beads.velocity, &beads.force, &beads.listed})
      archive(*array);
    archive(beads.id);
    std::vector<float> attraction = wall.attraction();
    archive(attraction);
    wall.set_attraction(attraction);
    tracker.archive(archive);
  }
};

Simulation::Simulation(const Parameters& parameters, ContactAngleCurve curve, const Execution& execution)
    : state_(std::make_unique<State>(parameters, std::move(curve), execution)) {
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
    s.keep_pairs(drift(s.beads, s.parameters, s.step));
    s.forces.density(s.beads, s.wall, s.pairs);
    s.forces.force(s.beads, s.wall, s.pairs);
    finish(s.beads, s.parameters);
  } else {
    s.keep_pairs(kick_and_half_drift(s.beads, s.parameters, s.step));
    thermostat(s.beads, s.wall, s.pairs, s.forces, s.parameters);
    s.keep_pairs(half_drift(s.beads, s.parameters, s.step));
    s.forces.density(s.beads, s.wall, s.pairs);
    s.forces.force(PairForce::conservative, s.beads.force, s.beads, s.wall, s.pairs);
  }
  ++s.step;

  if (s.step % s.parameters.observe_interval == 0) {
    s.require_sound_temperature();
    s.tracker.update(s.step, s.beads, s.pairs.blocks());
  }
}

/// After beads came or went: lists and droplets are up to date again.
void Simulation::refresh() {
  State& s = *state_;
  omp_set_num_threads(s.threads);
  s.pairs.rebuild(s.beads, s.wall);
  s.forces.density(s.beads, s.wall, s.pairs);
  s.tracker.update(s.step, s.beads, s.pairs.blocks());
}

void Simulation::set_wettability(const ContactAngleField& field) {
  state_->wall.set_wettability(field, state_->curve);
}

std::size_t Simulation::add_droplet(const DropletPlacement& placement) {
  State& s = *state_;
  const std::size_t placed =
      place_beads(s.beads, droplet_sites(placement, s.parameters), s.parameters, s.step, s.next_bead_id);
  refresh();
  return placed;
}

std::size_t Simulation::fill_box() {
  return fill_slab(state_->parameters.domain.lower, state_->parameters.domain.upper);
}

std::size_t Simulation::fill_slab(const Vector3d& lower, const Vector3d& upper) {
  State& s = *state_;
  const std::size_t placed =
      place_beads(s.beads, slab_sites(lower, upper, s.parameters), s.parameters, s.step, s.next_bead_id);
  refresh();
  return placed;
}

void Simulation::remove_droplet(std::uint32_t id) {
  State& s = *state_;
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < s.beads.size(); ++i)
    if (id == 0 || s.tracker.droplet_of(s.beads.id[i]) != id) kept.push_back(i);
  if (kept.size() == s.beads.size()) {
    std::vector<std::uint32_t> known;
    for (const DropletObservation& droplet : s.tracker.droplets()) known.push_back(droplet.id);
    throw InvalidInput(
        fmt::format("droplet {} does not exist; droplets are [{}]", id, fmt::join(known, ", ")));
  }
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
  Virial virial;
  if (request.virial) {
    virial = virial_of(s.beads, s.pairs.blocks(), s.parameters);
    snapshot->virial = virial.total;
  }
  if (request.hash) snapshot->state_hash = state_hash(s.step, s.beads, s.wall);
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
      if (request.virial) snapshot->bead_virials.push_back(virial.of_bead[index_of_id[id]]);
    }
  }
  return snapshot;
}

std::vector<DropletEvent> Simulation::take_events() { return state_->tracker.take_events(); }

std::string Simulation::save_state() const {
  Archive archive;
  state_->archive(archive);
  return archive.bytes();
}

void Simulation::load_state(const std::string& bytes) {
  const State& s = *state_;
  auto loaded = std::make_unique<State>(s.parameters, s.curve, Execution{s.threads, s.forces.kernel_name()});
  Archive archive(bytes);
  loaded->archive(archive);
  if (!archive.at_end()) throw InvalidInput("saved state: longer than it should be");
  const std::size_t count = loaded->beads.size();
  for (const AlignedVector<Record>* array :
       {&loaded->beads.position, &loaded->beads.predicted, &loaded->beads.velocity, &loaded->beads.force,
        &loaded->beads.listed})
    if (array->size() != count) throw InvalidInput("saved state: arrays of unequal length");
  omp_set_num_threads(s.threads);
  loaded->pairs.restore(loaded->beads, loaded->wall);
  loaded->forces.density(loaded->beads, loaded->wall, loaded->pairs);
  state_ = std::move(loaded);
}

std::uint64_t Simulation::steps() const { return state_->step; }
double Simulation::time() const { return static_cast<double>(state_->step) * state_->parameters.time_step; }
const Parameters& Simulation::parameters() const { return state_->parameters; }
const ContactAngleCurve& Simulation::curve() const { return state_->curve; }
const std::string& Simulation::kernel() const { return state_->forces.kernel_name(); }
int Simulation::threads() const { return state_->threads; }

}  // namespace dmf::engine
