#include "tools/infiltration.h"

#include <algorithm>
#include <cmath>

#include "chip/label_shape.h"
#include "engine/noise.h"
#include "engine/simulation.h"
#include "yaml/units.h"

namespace dmf::tools {
namespace {

constexpr double slab = 0.437 * 10;     ///< period along y, r_c
constexpr double voxel = 0.437;         ///< half the lattice constant of walls, r_c
constexpr double behind = 2;            ///< empty space behind the slug, r_c
constexpr double apart = 0.5;           ///< slug and pore space at the start, r_c
constexpr double sample_interval = 10;  ///< tau

chip::LabelShape box(double x_from, double x_to, double z_from, double z_to) {
  chip::LabelShape shape;
  shape.lower = {x_from, -slab, z_from};
  shape.upper = {x_to, 2 * slab, z_to};
  return shape;
}

/// Rows of grains 7 apart, two of them a width; every other row stands before the gaps of the last.
void add_grains(const InfiltrationRun& run, double entrance, const engine::Domain& domain,
                engine::LabelGrid& grid) {
  constexpr double rows_apart = 7;
  std::uint32_t number = 0;
  for (int row = 0; (row + 1) * rows_apart <= run.depth; ++row)
    for (int column = 0; column < 2; ++column) {
      chip::LabelShape grain;
      grain.kind = chip::LabelShape::Kind::cylinder;
      grain.axis = 1;
      grain.center = {entrance + (row + 0.5) * rows_apart, 0, (column + 0.5 * (row % 2)) * run.width / 2};
      // A twelfth of the width apart or more: throats of 3.2 to 5.6 at a width of 24.
      grain.radius = run.width / 24 * (3.2 + 1.2 * engine::mix32(++number) / 4294967296.0);
      chip::label(grid, domain, grain, engine::Vector3d::Zero(), engine::LabelGrid::solid);
    }
}

engine::Parameters parameters_of(const InfiltrationRun& run) {
  engine::Parameters parameters = run.parameters;
  parameters.seed = run.seed;
  parameters.watchdog.evaporation = 1;
  const double entrance = behind + run.slug + apart;
  engine::Domain& domain = parameters.domain;
  domain.lower = {0, 0, 0};
  domain.upper = {entrance + run.depth, slab, run.width};
  domain.lower_side =
      domain.upper_side = {engine::Side::reflecting, engine::Side::periodic, engine::Side::periodic};
  engine::LabelGrid grid = chip::grid_over(domain, engine::Vector3d::Constant(voxel));
  if (run.space == PoreSpace::grains) {
    add_grains(run, entrance, domain, grid);
  } else {
    const double wall = 0.5 * (run.width - run.gap);
    for (const auto& [from, to] : {std::pair{0.0, wall}, {run.width - wall, run.width}})
      chip::label(grid, domain, box(entrance, domain.upper.x(), from, to), engine::Vector3d::Zero(),
                  engine::LabelGrid::solid);
  }
  parameters.label_grid.grid = std::make_shared<const engine::LabelGrid>(std::move(grid));
  parameters.label_grid.contact_angle = run.contact_angle;
  return parameters;
}

/// Fluid voxels behind the entrance, r_c^3.
double pore_volume(const engine::LabelGrid& grid, double entrance) {
  double count = 0;
  for (int z = 0; z < grid.voxels[2]; ++z)
    for (int y = 0; y < grid.voxels[1]; ++y)
      for (int x = 0; x < grid.voxels[0]; ++x)
        count += (x + 0.5) * grid.voxel_size.x() > entrance &&
                 grid.labels[grid.index(x, y, z)] == engine::LabelGrid::fluid;
  return count * grid.voxel_size.prod();
}

}  // namespace

double entry_pressure(double surface_tension, double contact_angle, double gap) {
  return -2 * surface_tension * std::cos(contact_angle * degree) / gap;
}

double washburn_depth(double surface_tension, double viscosity, double contact_angle, double gap,
                      double time) {
  return std::sqrt(
      std::max(0.0, surface_tension * gap * std::cos(contact_angle * degree) * time / (3 * viscosity)));
}

double run_infiltration(const InfiltrationRun& run, const engine::ContactAngleCurve& curve,
                        const std::function<void(const InfiltrationSample&)>& sample) {
  const engine::Parameters parameters = parameters_of(run);
  const double entrance = behind + run.slug + apart;
  const double full = pore_volume(*parameters.label_grid.grid, entrance) * parameters.liquid.bulk_density;
  engine::Simulation simulation(parameters, curve, {1, "auto"});
  simulation.fill_slab({behind, 0, 0}, {behind + run.slug, slab, run.width});
  simulation.set_body_forces({{run.acceleration, 0, 0}, engine::Vector3d::Zero()});
  const auto steps_of = [&](double time) {
    return static_cast<int>(std::lround(time / parameters.time_step));
  };
  const auto share = [&] {
    const auto snapshot = simulation.observe({true, false});
    const auto inside = std::count_if(snapshot->positions.begin(), snapshot->positions.end(),
                                      [&](const Eigen::Vector3f& at) { return at.x() > entrance; });
    return static_cast<double>(inside) / full;
  };
  for (int step = 1; step <= steps_of(run.time); ++step) {
    simulation.step();
    if (sample && step % steps_of(sample_interval) == 0) sample({simulation.time(), share()});
  }
  return share();
}

}  // namespace dmf::tools
