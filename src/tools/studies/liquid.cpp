#include <fmt/format.h>

#include <array>
#include <cmath>

#include "engine/simulation.h"
#include "tools/study.h"

namespace dmf::tools {
namespace {

using engine::Parameters;
using engine::Side;
using engine::Simulation;
using engine::Snapshot;
using engine::Vector3d;

constexpr double pi = 3.14159265358979323846;

Parameters periodic_box(const StudyOptions& options, const Vector3d& size, int seed) {
  Parameters parameters;
  parameters.domain.lower = Vector3d::Zero();
  parameters.domain.upper = size;
  parameters.domain.lower_side =
      parameters.domain.upper_side = {Side::periodic, Side::periodic, Side::periodic};
  parameters.time_step = options.time_step;
  if (options.lambda > 0) parameters.integrator_lambda = options.lambda;
  parameters.seed = static_cast<std::uint64_t>(seed);
  return parameters;
}

engine::ContactAngleCurve no_wall() { return engine::ContactAngleCurve::lan2016(); }

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

/// A film across a periodic box: density of its middle, tension from the stress that it carries (mechanical
/// route): gamma = (P_zz - (P_xx + P_yy) / 2) L_z / 2 for two surfaces.
std::vector<double> film(const StudyOptions& options, int seed) {
  const double width = 10, thickness = 10, height = 22;
  Simulation simulation(periodic_box(options, {width, width, height}, seed), no_wall(), {1, "auto"});
  simulation.fill_slab({0, 0, 6}, {width, width, 6 + thickness});
  double tension = 0, density = 0, looks = 0;
  run(simulation, options.quick ? 10 : 50, options.quick ? 20 : 300, 0.2, [&] {
    const auto snapshot = simulation.observe({true, false, true});
    Eigen::Matrix3d stress = *snapshot->virial;
    double middle = 0;
    for (std::size_t k = 0; k < snapshot->positions.size(); ++k) {
      const Vector3d v = snapshot->velocities[k].cast<double>();
      stress += v * v.transpose();
      middle += snapshot->positions[k].z() / static_cast<double>(snapshot->positions.size());
    }
    tension += (stress(2, 2) - 0.5 * (stress(0, 0) + stress(1, 1))) / (2 * width * width);
    for (const Eigen::Vector3f& position : snapshot->positions)
      if (std::abs(position.z() - middle) < 2.5) density += 1.0 / (5 * width * width);
    looks += 1;
  });
  return {density / looks, tension / looks};
}

/// A free droplet: tension from the pressure inside it (Laplace), p = 2 gamma / R, and what momentum it
/// gathers.
std::vector<double> free_droplet(const StudyOptions& options, double radius, int seed) {
  const double size = 2 * radius + 6;
  Simulation simulation(periodic_box(options, Vector3d::Constant(size), seed), no_wall(), {1, "auto"});
  simulation.add_droplet({Vector3d::Constant(size / 2), radius});
  double pressure = 0, density = 0, looks = 0, beads = 0, temperature = 0;
  const double inner = radius - 2.5, volume = 4.0 / 3 * pi * inner * inner * inner;
  Vector3d momentum = Vector3d::Zero();
  run(simulation, options.quick ? 10 : 50, options.quick ? 20 : 300, 0.2, [&] {
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
  const double equimolar_radius = std::cbrt(3 * beads / looks / (4 * pi * density / looks));
  return {density / looks, pressure / looks, pressure / looks * equimolar_radius / 2, temperature / looks,
          momentum.norm()};
}

/// Bulk liquid at its own density: temperature, pressure, and viscosity from how fast transverse momentum
/// waves of the equilibrium decay, C(t) = exp(-mu k^2 t / rho) (Palmer 1994), between 0.8 and 0.3 of their
/// start.
std::vector<double> bulk(const StudyOptions& options, int seed) {
  // A whole number of lattice cells at the liquid's own density.
  const double size = 14 * std::cbrt(4 / Parameters{}.liquid.bulk_density), interval = 0.1;
  Parameters parameters = periodic_box(options, Vector3d::Constant(size), seed);
  Simulation simulation(parameters, no_wall(), {1, "auto"});
  const double density = static_cast<double>(simulation.fill_box()) / (size * size * size);
  constexpr int modes = 12;  // 3 wave vectors, 2 transverse directions, sine and cosine
  std::vector<std::array<double, modes>> history;
  double temperature = 0, pressure = 0;
  run(simulation, options.quick ? 5 : 30, options.quick ? 30 : 400, interval, [&] {
    const auto snapshot = simulation.observe({true, false, true});
    std::array<double, modes> wave{};
    for (std::size_t k = 0; k < snapshot->positions.size(); ++k)
      for (int axis = 0; axis < 3; ++axis) {
        const double phase = 2 * pi / size * snapshot->positions[k][axis];
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
  const double wave_number = 2 * pi / size, looks = static_cast<double>(history.size());
  return {density, temperature / looks, pressure / looks, -slope * density / (wave_number * wave_number)};
}

}  // namespace

void study_liquid(const StudyOptions& options) {
  const double radius = options.radius > 0 ? options.radius : 8;
  ResultTable films(options.output + "/liquid_film_runs.csv", {"density", "tension"});
  ResultTable droplets(options.output + "/liquid_droplet_runs.csv",
                       {"density", "pressure", "tension", "temperature", "momentum"});
  ResultTable bulks(options.output + "/liquid_bulk_runs.csv",
                    {"density", "temperature", "pressure", "viscosity"});
  const auto key = [&](const char* what, int seed) {
    return fmt::format("{} dt={} lambda={} seed={}", what, options.time_step,
                       options.lambda > 0 ? options.lambda : Parameters{}.integrator_lambda, seed);
  };
  const std::string droplet = fmt::format("droplet R={}", radius);
  std::vector<Job> film_jobs, droplet_jobs, bulk_jobs;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    film_jobs.push_back({key("film", seed), [=, &options] { return film(options, seed); }});
    droplet_jobs.push_back(
        {key(droplet.c_str(), seed), [=, &options] { return free_droplet(options, radius, seed); }});
    bulk_jobs.push_back({key("bulk", seed), [=, &options] { return bulk(options, seed); }});
  }
  run_jobs("film", film_jobs, options, films);
  run_jobs("free droplet", droplet_jobs, options, droplets);
  run_jobs("bulk", bulk_jobs, options, bulks);

  const auto print = [&](const char* what, const ResultTable& table, const std::vector<Job>& jobs,
                         std::size_t column) {
    std::vector<double> values;
    for (const Job& job : jobs) values.push_back(table.row(job.key).at(column));
    const MeanAndSpread result = mean_and_spread(values);
    fmt::print("{:<58} {:10.4g} +- {:.2g}\n", what, result.mean, result.deviation);
  };
  fmt::print("{} seeds, dt {}\n", options.seeds, options.time_step);
  print("bulk temperature (k_BT)", bulks, bulk_jobs, 1);
  print("bulk density of the box (1/r_c^3)", bulks, bulk_jobs, 0);
  print("bulk pressure at that density (k_BT/r_c^3)", bulks, bulk_jobs, 2);
  print("viscosity (m / (r_c tau))", bulks, bulk_jobs, 3);
  print("density inside the film", films, film_jobs, 0);
  print("surface tension, flat film (k_BT/r_c^2)", films, film_jobs, 1);
  print("density inside the free droplet", droplets, droplet_jobs, 0);
  print("surface tension, Laplace", droplets, droplet_jobs, 2);
  print("temperature of the free droplet", droplets, droplet_jobs, 3);
  print("momentum of the free droplet at the end (m r_c/tau)", droplets, droplet_jobs, 4);
}

}  // namespace dmf::tools
