#include "tools/chain_run.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/simulation.h"

namespace dmf::tools {
namespace {

using engine::Side;
using engine::Vector3d;

engine::Parameters parameters_of(const ChainRun& how) {
  engine::Parameters parameters;
  engine::Domain& domain = parameters.domain;
  Vector3d size = how.size;
  if (size.isZero()) size.setConstant(std::cbrt(how.beads * how.chains / how.density));
  domain.lower = Vector3d::Zero();
  domain.upper = size;
  domain.lower_side =
      domain.upper_side = {Side::periodic, Side::periodic, how.channel ? Side::reflecting : Side::periodic};
  parameters.liquid.attraction = how.repulsion;
  parameters.liquid.repulsion = 0;
  parameters.liquid.random_amplitude = 3;
  parameters.liquid.initial_density = parameters.liquid.bulk_density = how.density;
  parameters.time_step = how.time_step;
  parameters.integrator = how.integrator;
  parameters.seed = how.seed;
  parameters.watchdog.evaporation = 1;
  // Until the chains are stretched the pull heats the box, and the energy of a flow counts as heat.
  if (how.stretching_force != 0 || how.gravity != 0) parameters.watchdog.highest_temperature = 100;
  return parameters;
}

/// Mean of g(r) over r^2 w(r) exp(-U / k_BT).
template <class Weight, class Value>
double thermal_mean(const engine::SpringLaw& law, double temperature, Weight weight, Value value) {
  constexpr int n = 100'000;
  const double longest = std::isfinite(law.max_length()) ? law.max_length() : law.reach(60 * temperature) + 1;
  double sum = 0, all = 0;
  for (int k = 0; k < n; ++k) {
    const double r = (k + 0.5) * longest / n;
    const double w = weight(r) * r * r * std::exp(-law.energy(r) / temperature);
    sum += value(r) * w;
    all += w;
  }
  return sum / all;
}

/// When the mean of R(t) R(0) over chains and starts falls to 1/e, linear between looks.
double relaxation_time(const std::vector<std::vector<Vector3d>>& history, double interval) {
  double start = 0, before = 1;
  for (std::size_t lag = 0; lag < history.size() / 2; ++lag) {
    double sum = 0, count = 0;
    for (std::size_t t = 0; t + lag < history.size(); ++t)
      for (std::size_t k = 0; k < history[t].size(); ++k) {
        sum += history[t][k].dot(history[t + lag][k]);
        ++count;
      }
    if (lag == 0) start = sum / count;
    const double now = sum / count / start, level = std::exp(-1.0);
    if (now < level) return interval * (static_cast<double>(lag) - 1 + (before - level) / (before - now));
    before = now;
  }
  return 0;
}

}  // namespace

double thermal_extension(const engine::SpringLaw& law, double temperature, double force) {
  const double f = force / temperature;
  return thermal_mean(
      law, temperature, [f](double r) { return std::sinh(f * r) / (f * r); },
      [f](double r) { return r * (1 / std::tanh(f * r) - 1 / (f * r)); });
}

double thermal_square(const engine::SpringLaw& law, double temperature) {
  return thermal_mean(
      law, temperature, [](double) { return 1.0; }, [](double r) { return r * r; });
}

double rouse_time(std::uint32_t beads, double bond_square, double gamma, double density, double temperature) {
  const double friction = 4 * M_PI * gamma * density / 90;
  return friction * beads * beads * bond_square / (3 * M_PI * M_PI * temperature);
}

ChainResult run_chains(const ChainRun& how) {
  const engine::Parameters parameters = parameters_of(how);
  engine::Simulation simulation(parameters, engine::ContactAngleCurve::lan2016(), {1, "auto"});
  if (!how.size.isZero()) simulation.fill_box();
  engine::ChainPlacement placement;
  placement.spring = how.spring;
  placement.count = how.chains;
  placement.beads = how.beads;
  placement.bond_length = engine::usual_bond_length(how.spring);
  placement.lower = parameters.domain.lower;
  placement.upper = parameters.domain.upper;
  placement.stretching_force = {how.stretching_force, 0, 0};
  simulation.add_chains(placement);
  if (how.gravity != 0) simulation.set_body_forces({{how.gravity, 0, 0}, Vector3d::Zero()});

  const auto steps_of = [&](double time) {
    return static_cast<std::uint64_t>(std::llround(time / how.time_step));
  };
  for (std::uint64_t k = 0; k < steps_of(how.settle); ++k) simulation.step();
  ChainResult result;
  std::vector<std::vector<Vector3d>> history;
  double samples = 0, looks = 0;
  for (std::uint64_t k = 1; k <= steps_of(how.measure); ++k) {
    simulation.step();
    if (k % steps_of(how.interval) != 0) continue;
    const auto snapshot = simulation.observe({true});
    auto& ends = history.emplace_back();
    for (const engine::ChainObservation& chain : snapshot->chains) {
      ends.push_back(chain.end_to_end);
      result.end_to_end_square += chain.end_to_end.squaredNorm();
      result.gyration_square += chain.radius_of_gyration * chain.radius_of_gyration;
      result.extension += chain.end_to_end.x();
      result.stretch_square += chain.end_to_end.x() * chain.end_to_end.x();
      const double middle = 0.5 * parameters.domain.size().z();
      result.off_centre += std::abs(chain.centroid.z() - middle) / middle;
      double bonds = 0;
      for (std::size_t b = 0; b + 1 < chain.positions.size(); ++b)
        bonds += (chain.positions[b + 1] - chain.positions[b]).squaredNorm();
      result.bond_square += bonds / static_cast<double>(chain.positions.size() - 1);
      ++samples;
    }
    for (const Eigen::Vector3f& v : snapshot->velocities) {
      const double share = 1.0 / static_cast<double>(snapshot->velocities.size());
      result.temperature += share * 0.5 * (v.y() * v.y() + v.z() * v.z());
      result.speed += share * v.x();
    }
    ++looks;
  }
  for (double* mean : {&result.end_to_end_square, &result.gyration_square, &result.bond_square,
                       &result.extension, &result.stretch_square, &result.off_centre})
    *mean /= samples;
  result.temperature /= looks;
  result.speed /= looks;
  result.relaxation = relaxation_time(history, how.interval);
  return result;
}

}  // namespace dmf::tools
