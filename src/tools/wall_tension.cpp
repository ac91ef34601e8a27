#include "tools/wall_tension.h"

#include <cmath>

#include "engine/simulation.h"
#include "engine/walls/plates.h"
#include "tools/plug.h"

namespace dmf::tools {
namespace {

constexpr double slab = 0.25;       ///< r_c
constexpr double reach = 1;         ///< of the wall, r_c
constexpr double disturbed = 3;     ///< of the liquid next to it, r_c
constexpr double look_every = 0.4;  ///< tau

/// Potential of all beads of the plates at a place, over a_w: the sum of (1 - r)^2 / 2.
double wall_potential(const Eigen::Vector3f& at, const std::vector<engine::Plate>& plates,
                      const engine::Domain& domain) {
  double sum = 0;
  for (const engine::Plate& plate : plates) {
    if (std::abs(at.z() - plate.plane) >= reach) continue;
    for (const engine::Record& bead : plate.beads) {
      const double r = domain.nearest_image({at.x() - bead.x, at.y() - bead.y, at.z() - bead.z}).norm();
      if (r < 1) sum += 0.5 * (1 - r) * (1 - r);
    }
  }
  return sum;
}

}  // namespace

double young_cosine(const WallTensionResult& plug, const WallTensionResult& carrier, double tension,
                    double half_gap, double share) {
  const double pressure = share * plug.pressure + (1 - share) * carrier.pressure;
  const double at_one_pressure = carrier.tension + carrier.lacking * (pressure - carrier.pressure) -
                                 plug.tension - plug.lacking * (pressure - plug.pressure);
  // What Laplace's difference adds is in proportion to the cosine itself.
  return at_one_pressure /
         (tension * (1 - (carrier.lacking * share + plug.lacking * (1 - share)) / half_gap));
}

WallTensionResult run_wall_tension(const WallTensionRun& run) {
  using engine::Side;
  engine::Parameters parameters = immiscible_liquids(0);
  parameters.mixture = {};
  parameters.seed = run.seed;
  parameters.time_step = run.time_step;
  parameters.observe_interval = 1000;
  parameters.domain.lower = {0, 0, 0};
  parameters.domain.upper = {run.width, run.width, run.gap};
  parameters.domain.lower_side = parameters.domain.upper_side = {Side::periodic, Side::periodic, Side::wall};
  parameters.boundaries.lower_reflection[2] = parameters.boundaries.upper_reflection[2] = run.reflection;
  parameters.wall.attraction = run.wall_repulsion;
  const std::vector<engine::Plate> plates{
      engine::plate_at(parameters.domain, parameters.wall, 0, -1, parameters.dimensions),
      engine::plate_at(parameters.domain, parameters.wall, run.gap, +1, parameters.dimensions)};
  engine::Simulation simulation(parameters, engine::ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill_box();
  const auto steps = [&](double time) { return std::max(1L, std::lround(time / run.time_step)); };
  for (long k = 0; k < steps(run.settle); ++k) simulation.step();

  const auto slabs = static_cast<std::size_t>(std::lround(run.gap / slab));
  const double thickness = run.gap / static_cast<double>(slabs);
  std::vector<double> normal(slabs), along(slabs), density(slabs);
  WallTensionResult result;
  const long looks = std::max(1L, std::lround(run.measure / look_every));
  const double share = 1 / static_cast<double>(looks);
  for (long look = 0; look < looks; ++look) {
    for (long k = 0; k < steps(look_every); ++k) simulation.step();
    engine::ObserveRequest request{true};
    request.stress = engine::StressSlabs{2, slabs};
    const auto snapshot = simulation.observe(request);
    result.temperature += share * snapshot->temperature;
    for (std::size_t k = 0; k < slabs; ++k) {
      const engine::SlabStress& stress = snapshot->stress[k];
      normal[k] += share * stress.pressure(2, 2);
      along[k] += share * 0.5 * (stress.pressure(0, 0) + stress.pressure(1, 1));
      density[k] += share * stress.density;
    }
    for (const Eigen::Vector3f& at : snapshot->positions)
      result.slope += share * wall_potential(at, plates, parameters.domain) / (2 * run.width * run.width);
  }
  double middle_density = 0, middle_slabs = 0, content = 0;
  const auto height_of = [&](std::size_t k) {
    const double z = (static_cast<double>(k) + 0.5) * thickness;
    return std::min(z, run.gap - z);
  };
  for (std::size_t k = 0; k < slabs; ++k) {
    content += density[k] * thickness;
    if (height_of(k) < disturbed) continue;
    result.pressure += (normal[k] + 2 * along[k]) / 3;
    middle_density += density[k];
    ++middle_slabs;
  }
  result.pressure /= middle_slabs;
  middle_density /= middle_slabs;
  // Where the wall reaches, it carries a part of the normal pressure, which is that of the middle everywhere.
  for (std::size_t k = 0; k < slabs; ++k)
    result.tension += 0.5 * thickness * ((height_of(k) < reach ? result.pressure : normal[k]) - along[k]);
  result.lacking = 0.5 * (run.gap - content / middle_density);
  return result;
}

}  // namespace dmf::tools
