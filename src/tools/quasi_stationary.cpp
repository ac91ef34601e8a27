#include "tools/quasi_stationary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <variant>

#include "engine/archive.h"
#include "engine/simulation.h"
#include "tools/largest_droplet.h"
#include "tools/processes.h"
#include "tools/saved_run.h"

namespace dmf::tools {
namespace {

using engine::DropletObservation;
using engine::MicroparticleObservation;
using engine::MicroparticleTotals;
using engine::Snapshot;
using engine::Vector3d;

/// theta(x) of the plate, linear between its points and constant beyond.
class Gradient {
 public:
  explicit Gradient(const chip::Scene& scene) {
    for (const chip::ScheduledCommand& scheduled : scene.schedule)
      if (const auto* program = std::get_if<chip::SetWettability>(&scheduled.command)) {
        positions_.clear();
        for (const double x : program->positions) positions_.push_back(x / scene.units.length_m);
        angles_ = program->contact_angles_deg;
      }
    if (positions_.empty())
      throw std::runtime_error(fmt::format("{}: no gradient in its schedule", scene.name));
  }

  double angle(double x) const {
    const auto after = std::upper_bound(positions_.begin(), positions_.end(), x);
    if (after == positions_.begin()) return angles_.front();
    if (after == positions_.end()) return angles_.back();
    const auto k = static_cast<std::size_t>(after - positions_.begin());
    const double part = (x - positions_[k - 1]) / (positions_[k] - positions_[k - 1]);
    return angles_[k - 1] + part * (angles_[k] - angles_[k - 1]);
  }

 private:
  std::vector<double> positions_, angles_;
};

enum class Phase { rest, pickup, slide, settle, measure, over, lost };

/// MicroparticleTotals as far as they are needed here, plain numbers that can be saved.
struct Sums {
  double steps = 0, steps_in_contact = 0, height = 0, normal_force = 0;
  double drive_x = 0, drive_z = 0, friction_x = 0;
};

Sums sums_of(const MicroparticleTotals& totals) {
  return {static_cast<double>(totals.steps),
          static_cast<double>(totals.steps_in_contact),
          totals.height,
          totals.normal_force,
          totals.drive_force.x(),
          totals.drive_force.z(),
          totals.friction_force.x()};
}

/// How far the run has come, and its sums: what is saved beside the engine's state.
struct Course {
  Phase phase = Phase::rest;
  double phase_start = 0;  ///< tau
  double place = 0;        ///< x of the gradient that the microparticle is at now
  double x = 0;            ///< of the microparticle, in the box
  double way = 0;          ///< that it has gone in all, across periodic sides too
  double start_way = 0;    ///< at the start of the measurement
  double start_time = 0;
  Sums start;
  double ahead = 0, looks = 0;
};

class Run {
 public:
  Run(const chip::Scene& scene, std::uint64_t seed, const QuasiStationaryRun& how)
      : scene_(scene),
        how_(how),
        gradient_(scene),
        simulation_(with_seed(scene, seed), load_curve(scene), {1, "auto"}) {
    const double rest = scene.electrowetting.rest_angle;
    simulation_.set_wettability([rest](double, double) { return rest; });
    for (const auto& droplet : scene.droplets) simulation_.add_droplet(droplet);
    for (const auto& body : scene.microparticles) simulation_.add_microparticle(body);
    if (scene.body_forces.gravity.norm() > 0 || scene.body_forces.magnetic.norm() > 0)
      simulation_.set_body_forces(scene.body_forces);
    course_.x = centre(*simulation_.observe()).x();
  }

  bool over() const { return course_.phase == Phase::over || course_.phase == Phase::lost; }
  const engine::Simulation& simulation() const { return simulation_; }

  /// How much of it is over, 0 to 1, if the droplet picks the microparticle up now.
  double share_done() const {
    const double time = simulation_.time(), elapsed = time - course_.phase_start;
    double left = how_.measure;
    if (course_.phase == Phase::measure) left -= elapsed;
    if (course_.phase < Phase::measure) left += how_.settle;
    if (course_.phase == Phase::settle) left -= elapsed;
    if (course_.phase < Phase::settle) left += std::abs(how_.place - course_.place) / how_.slide;
    if (course_.phase == Phase::rest) left += scene_.settle_time - time;
    return over() ? 1 : time / (time + left);
  }

  /// To the next look of the tracker.
  void advance() {
    const bool measuring = course_.phase == Phase::measure;
    do {
      simulation_.step();
      if (measuring && how_.flow && simulation_.steps() % how_.flow_every == 0) sample_flow();
    } while (simulation_.steps() % simulation_.parameters().observe_interval != 0);
    const auto snapshot = simulation_.observe();
    if (!largest_droplet(*snapshot)) return enter(Phase::lost);
    follow(*snapshot);
    if (measuring) {
      course_.ahead += ahead(*snapshot);
      course_.looks += 1;
    }
    next_phase(*snapshot);
    if (course_.phase != Phase::rest) show_gradient();
  }

  QuasiStationary result() const {
    QuasiStationary result;
    const auto snapshot = simulation_.observe();
    const bool kept = course_.phase == Phase::over;
    const double time = simulation_.time() - course_.start_time;
    result.velocity = kept ? (course_.way - course_.start_way) / time : NAN;
    result.droplet_ahead = kept ? course_.ahead / course_.looks : NAN;
    result.flow = flow_;
    const Sums &then = course_.start,
               now = loaded() ? sums_of(snapshot->microparticles.at(0).totals) : Sums{};
    const double steps = kept && loaded() ? now.steps - then.steps : NAN;
    result.drive_x = (now.drive_x - then.drive_x) / steps;
    result.drive_z = (now.drive_z - then.drive_z) / steps;
    result.friction_x = (now.friction_x - then.friction_x) / steps;
    result.normal_force = (now.normal_force - then.normal_force) / steps;
    result.height = (now.height - then.height) / steps;
    result.contact_fraction = (now.steps_in_contact - then.steps_in_contact) / steps;
    return result;
  }

  std::string state() const {
    const std::string saved = simulation_.save_state();
    std::vector<char> bytes(saved.begin(), saved.end());
    engine::Archive archive;
    Course course = course_;
    FlowField flow = flow_;
    archive(course);
    flow.archive(archive);
    archive(bytes);
    return archive.take();
  }

  void restore(const std::string& state) {
    engine::Archive archive(state);
    std::vector<char> bytes;
    archive(course_);
    flow_.archive(archive);
    archive(bytes);
    simulation_.load_state({bytes.begin(), bytes.end()});
  }

 private:
  static engine::Parameters with_seed(const chip::Scene& scene, std::uint64_t seed) {
    engine::Parameters parameters = scene.parameters;
    parameters.seed = seed;
    return parameters;
  }

  /// Is there a microparticle at all?
  bool loaded() const { return !scene_.microparticles.empty(); }

  Vector3d centre(const Snapshot& snapshot) const {
    return loaded() ? snapshot.microparticles.at(0).position : largest_droplet(snapshot)->centroid;
  }

  /// The nearest image across periodic sides.
  double nearest(double distance, int axis) const {
    const engine::Domain& domain = scene_.parameters.domain;
    const double size = domain.size()[axis];
    return domain.periodic(axis) ? distance - size * std::round(distance / size) : distance;
  }

  void follow(const Snapshot& snapshot) {
    const double x = centre(snapshot).x(), step = nearest(x - course_.x, 0);
    course_.x = x;
    course_.way += step;
    // During the pickup the gradient lies still, and the microparticle moves on it.
    if (course_.phase == Phase::pickup) course_.place = x;
  }

  double ahead(const Snapshot& snapshot) const {
    return nearest(largest_droplet(snapshot)->centroid.x() - course_.x, 0);
  }

  void sample_flow() {
    engine::ObserveRequest with_beads;
    with_beads.beads = true;
    const auto snapshot = simulation_.observe(with_beads);
    const Vector3d middle = centre(*snapshot);
    const double plane = scene_.parameters.domain.lower.z();
    for (std::size_t k = 0; k < snapshot->positions.size(); ++k) {
      const Vector3d p = snapshot->positions[k].cast<double>();
      flow_.add({nearest(p.x() - middle.x(), 0), nearest(p.y() - middle.y(), 1), p.z() - plane},
                snapshot->velocities[k].cast<double>());
    }
    flow_.count_look();
  }

  void enter(Phase phase) {
    course_.phase = phase;
    course_.phase_start = simulation_.time();
  }

  void next_phase(const Snapshot& snapshot) {
    const double elapsed = simulation_.time() - course_.phase_start;
    const double look = simulation_.parameters().observe_interval * simulation_.parameters().time_step;
    switch (course_.phase) {
      case Phase::rest:
        if (simulation_.time() < scene_.settle_time) return;
        course_.place = course_.x;
        return enter(Phase::pickup);
      case Phase::pickup:
        if (!loaded() || (has_it(snapshot) && ahead(snapshot) > how_.ahead * scene_.droplets.at(0).radius))
          return enter(Phase::slide);
        if (elapsed > how_.pickup) enter(Phase::lost);
        return;
      case Phase::slide: {
        const double step = how_.slide * look, rest = how_.place - course_.place;
        course_.place += std::clamp(rest, -step, step);
        if (std::abs(rest) <= step) enter(Phase::settle);
        break;
      }
      case Phase::settle:
        if (elapsed < how_.settle) break;
        course_.start_way = course_.way;
        course_.start_time = simulation_.time();
        if (loaded()) course_.start = sums_of(snapshot.microparticles.at(0).totals);
        enter(Phase::measure);
        break;
      case Phase::measure:
        if (elapsed >= how_.measure) enter(Phase::over);
        break;
      case Phase::over:
      case Phase::lost:
        return;
    }
    if (loaded() && !has_it(snapshot)) enter(Phase::lost);
  }

  bool has_it(const Snapshot& snapshot) const {
    return snapshot.microparticles.at(0).droplet == largest_droplet(snapshot)->id;
  }

  void show_gradient() {
    simulation_.set_wettability(
        [this](double x, double) { return gradient_.angle(course_.place + nearest(x - course_.x, 0)); });
  }

  const chip::Scene& scene_;
  const QuasiStationaryRun& how_;
  Gradient gradient_;
  engine::Simulation simulation_;
  Course course_;
  FlowField flow_;
};

}  // namespace

QuasiStationary run_quasi_stationary(const chip::Scene& scene, std::uint64_t seed,
                                     const QuasiStationaryRun& how) {
  Run run(scene, seed, how);
  SavedRun saved(how.folder, how.key, how.save_every);
  if (const auto state = saved.load()) run.restore(*state);
  while (!run.over()) {
    tell_share_done(run.share_done());
    run.advance();
    if (how.after_look) how.after_look(run.simulation().time());
    if (saved.due() && !run.over()) saved.save(run.state(), seed, run.simulation().steps());
  }
  saved.remove();
  QuasiStationary result = run.result();
  result.earlier_computing = saved.earlier_computing();
  return result;
}

}  // namespace dmf::tools
