#include "tools/liquid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/simulation.h"

namespace dmf::tools {
namespace {

using engine::Parameters;
using engine::Side;
using engine::Simulation;
using engine::Vector3d;

Parameters periodic_box(const LiquidRun& how, const Vector3d& size) {
  Parameters parameters;
  parameters.domain.lower = Vector3d::Zero();
  parameters.domain.upper = size;
  parameters.domain.lower_side =
      parameters.domain.upper_side = {Side::periodic, Side::periodic, Side::periodic};
  parameters.time_step = how.time_step;
  if (how.lambda > 0) parameters.integrator_lambda = how.lambda;
  parameters.integrator = how.integrator;
  if (how.list_skin > 0) parameters.list_skin = how.list_skin;
  parameters.seed = how.seed;
  parameters.liquid = how.liquid;
  parameters.spline = how.spline;
  return parameters;
}

engine::ContactAngleCurve no_wall() { return engine::ContactAngleCurve::lan2016(); }

double measuring_time(const LiquidRun& how, double usual, double quick) {
  return how.measure > 0 ? how.measure : how.quick ? quick : usual;
}

/// How far beads have come since the first look, in a periodic cube that they must not cross half of between
/// two looks.
class Displacements {
 public:
  explicit Displacements(double size) : size_(size) {}
  void follow(const std::vector<Eigen::Vector3f>& positions) {
    total_.resize(positions.size(), Vector3d::Zero());
    for (std::size_t k = 0; k < last_.size(); ++k) {
      Vector3d way = (positions[k] - last_[k]).cast<double>();
      for (int axis = 0; axis < 3; ++axis) way[axis] -= size_ * std::nearbyint(way[axis] / size_);
      total_[k] += way;
    }
    last_ = positions;
  }
  double mean_square() const {
    double sum = 0;
    for (const Vector3d& way : total_) sum += way.squaredNorm();
    return sum / static_cast<double>(total_.size());
  }

 private:
  double size_;
  std::vector<Eigen::Vector3f> last_;
  std::vector<Vector3d> total_;
};

/// Steps for `settle` tau, then calls look() every `interval` tau for `measure` tau.
template <class Look>
void run(Simulation& simulation, double settle, double measure, double interval, Look look) {
  const double dt = simulation.parameters().time_step;
  const auto steps_of = [dt](double time) { return static_cast<std::uint64_t>(std::llround(time / dt)); };
  for (std::uint64_t k = 0; k < steps_of(settle); ++k) simulation.step();
  const std::uint64_t interval_steps = steps_of(interval);
  for (std::uint64_t k = 1; k <= steps_of(measure); ++k) {
    simulation.step();
    if (k % interval_steps == 0) look();
  }
}

}  // namespace

FilmResult run_film(const LiquidRun& how) {
  const double width = 10, thickness = 10, height = 22;
  Simulation simulation(periodic_box(how, {width, width, height}), no_wall(), {1, "auto"});
  simulation.fill_slab({0, 0, 6}, {width, width, 6 + thickness});
  double tension = 0, density = 0, normal_stress = 0, looks = 0, beads = 0;
  run(simulation, how.quick ? 10 : 50, measuring_time(how, 300, 20), 0.2, [&] {
    const auto snapshot = simulation.observe({true, false, true});
    Eigen::Matrix3d stress = *snapshot->virial;
    double middle = 0;
    for (std::size_t k = 0; k < snapshot->positions.size(); ++k) {
      const Vector3d v = snapshot->velocities[k].cast<double>();
      stress += v * v.transpose();
      middle += snapshot->positions[k].z() / static_cast<double>(snapshot->positions.size());
    }
    normal_stress += stress(2, 2);
    beads = static_cast<double>(snapshot->positions.size());
    tension += (stress(2, 2) - 0.5 * (stress(0, 0) + stress(1, 1))) / (2 * width * width);
    for (const Eigen::Vector3f& position : snapshot->positions)
      if (std::abs(position.z() - middle) < 2.5) density += 1.0 / (5 * width * width);
    looks += 1;
  });
  density /= looks;
  return {density, tension / looks, normal_stress / looks * density / beads};
}

FreeDropletResult run_free_droplet(const LiquidRun& how, double radius) {
  const double size = 2 * radius + 6;
  Simulation simulation(periodic_box(how, Vector3d::Constant(size)), no_wall(), {1, "auto"});
  simulation.add_droplet({Vector3d::Constant(size / 2), radius});
  double pressure = 0, density = 0, looks = 0, beads = 0, temperature = 0;
  const double inner = radius - 2.5, volume = 4.0 / 3 * M_PI * inner * inner * inner;
  Vector3d momentum = Vector3d::Zero();
  run(simulation, how.quick ? 10 : 50, measuring_time(how, 300, 20), 0.2, [&] {
    const auto snapshot = simulation.observe({true, false, true});
    if (snapshot->droplets.empty()) return;
    for (std::size_t k = 0; k < snapshot->positions.size(); ++k) {
      Vector3d from_centre = snapshot->positions[k].cast<double>() - snapshot->droplets[0].centroid;
      for (int axis = 0; axis < 3; ++axis)
        from_centre[axis] -= size * std::nearbyint(from_centre[axis] / size);
      if (from_centre.norm() > inner) continue;
      density += 1 / volume;
      pressure +=
          (snapshot->velocities[k].cast<double>().squaredNorm() / 3 + snapshot->bead_virials[k]) / volume;
    }
    beads += static_cast<double>(snapshot->droplets[0].beads);
    temperature += snapshot->temperature;
    momentum = snapshot->momentum;
    looks += 1;
  });
  const double equimolar_radius = std::cbrt(3 * beads / looks / (4 * M_PI * density / looks));
  return {density / looks, pressure / looks, equimolar_radius, temperature / looks, momentum.norm()};
}

BulkResult run_bulk(const LiquidRun& how) {
  // A whole number of lattice cells at the liquid's own density.
  const double size = how.bulk_cells * std::cbrt(4 / how.liquid.bulk_density);
  // A whole number of steps, about 0.1 tau.
  const double interval = how.time_step * std::max(1.0, std::round(0.1 / how.time_step));
  Parameters parameters = periodic_box(how, Vector3d::Constant(size));
  parameters.watchdog.evaporation = 1;  // where liquid and gas part, nothing is wrong
  Simulation simulation(parameters, no_wall(), {1, "auto"});
  const double density = static_cast<double>(simulation.fill_box()) / (size * size * size);
  constexpr int modes = 12;  // 3 wave vectors, 2 transverse directions, sine and cosine
  std::vector<std::array<double, modes>> history;
  double temperature = 0, pressure = 0;
  Displacements displacements(size);
  const double measure = measuring_time(how, 400, 30);
  double early = 0, early_time = 0;
  run(simulation, how.quick ? 5 : 30, measure, interval, [&] {
    const auto snapshot = simulation.observe({true, false, true});
    displacements.follow(snapshot->positions);
    if (early_time == 0 && static_cast<double>(history.size()) * interval > measure / 4) {
      early = displacements.mean_square();
      early_time = static_cast<double>(history.size()) * interval;
    }
    std::array<double, modes> wave{};
    for (std::size_t k = 0; k < snapshot->positions.size(); ++k)
      for (int axis = 0; axis < 3; ++axis) {
        const double phase = 2 * M_PI / size * snapshot->positions[k][axis];
        for (int t = 1; t < 3; ++t) {
          const double v = snapshot->velocities[k][(axis + t) % 3];
          wave[4 * axis + 2 * (t - 1)] += v * std::cos(phase);
          wave[4 * axis + 2 * (t - 1) + 1] += v * std::sin(phase);
        }
      }
    history.push_back(wave);
    temperature += snapshot->temperature;
    pressure += density * snapshot->temperature + snapshot->virial->trace() / 3 / (size * size * size);
  });
  const auto correlation = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t t = 0; t + lag < history.size(); ++t)
      for (int mode = 0; mode < modes; ++mode) sum += history[t][mode] * history[t + lag][mode];
    return sum / static_cast<double>(history.size() - lag);
  };
  // Least squares through ln C(t).
  const double start = correlation(0);
  double n = 0, sum_t = 0, sum_l = 0, sum_tt = 0, sum_tl = 0;
  for (std::size_t lag = 1; lag < history.size() / 4; ++lag) {
    const double relative = correlation(lag) / start;
    if (relative > 0.8) continue;
    if (relative < 0.3) break;
    const double t = static_cast<double>(lag) * interval, l = std::log(relative);
    n += 1, sum_t += t, sum_l += l, sum_tt += t * t, sum_tl += t * l;
  }
  const double slope = (n * sum_tl - sum_t * sum_l) / (n * sum_tt - sum_t * sum_t);
  const double wave_number = 2 * M_PI / size, looks = static_cast<double>(history.size());
  const double diffusivity =
      (displacements.mean_square() - early) / (6 * ((looks - 1) * interval - early_time));
  return {density, temperature / looks, pressure / looks, -slope * density / (wave_number * wave_number),
          diffusivity};
}

}  // namespace dmf::tools
