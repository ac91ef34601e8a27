#include "tools/duct.h"

#include <algorithm>
#include <cmath>

#include "engine/simulation.h"

namespace dmf::tools {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int terms = 200;       ///< of the series: the n-th counts 1 / n^3
constexpr double voxel = 0.5;    ///< r_c: half the lattice constant of walls of four beads per r_c^3
constexpr double thickness = 1;  ///< of the walls, r_c

engine::Parameters parameters_of(const DuctRun& run) {
  engine::Parameters parameters;
  parameters.seed = run.seed;
  parameters.time_step = run.time_step;
  parameters.observe_interval = 1000;
  parameters.watchdog.highest_temperature = 100;  // the flow counts as heat there
  parameters.liquid.attraction = 18.75;
  parameters.liquid.repulsion = 0;
  parameters.liquid.random_amplitude = 3;  // gamma 4.5
  parameters.liquid.dissipation_exponent = 0.5;
  parameters.liquid.initial_density = parameters.liquid.bulk_density = 4;
  lay_duct(run, parameters);
  if (!run.wall_friction) parameters.mixture.pairs = {{"liquid", "wall", {run.wall_repulsion, 0, 0}}};
  return parameters;
}

/// Sums over the beads of a cell of the section.
struct Cell {
  double beads = 0, momentum = 0, across = 0;
};

/// Gradient over viscosity, and the square sum that is left, when the duct is so wide.
struct Fit {
  double strength, left;
};

Fit fit_of(const DuctResult& result, const DuctRun& run, double width) {
  double theory_theory = 0, theory_measured = 0, measured_measured = 0;
  for (int z = 0; z < result.cells; ++z)
    for (int y = 0; y < result.cells; ++y) {
      const double theory =
          duct_velocity(result.middle(y, run.half_width), result.middle(z, run.half_width), width, width);
      const double measured = result.velocity[static_cast<std::size_t>(z) * result.cells + y];
      theory_theory += theory * theory;
      theory_measured += theory * measured;
      measured_measured += measured * measured;
    }
  const double strength = theory_measured / theory_theory;
  return {strength, measured_measured - strength * theory_measured};
}

void fit(const DuctRun& run, DuctResult& result) {
  double best = 1e300, strength = 0;
  for (double width = 0.9 * run.half_width; width <= 1.1 * run.half_width; width += 0.002 * run.half_width) {
    const Fit found = fit_of(result, run, width);
    if (found.left >= best) continue;
    best = found.left;
    strength = found.strength;
    result.fitted_width = width;
  }
  result.viscosity = 4 * run.acceleration / strength;
  result.deviation = std::sqrt(std::max(0.0, best) / (result.cells * result.cells)) /
                     (strength * duct_velocity(0, 0, result.fitted_width, result.fitted_width));
}

}  // namespace

double duct_velocity(double y, double z, double half_y, double half_z) {
  if (std::abs(y) >= half_y || std::abs(z) >= half_z) return 0;
  double sum = 0;
  for (int n = 1; n < 2 * terms; n += 2) {
    const double k = n * pi / (2 * half_y);
    // cosh(k z) / cosh(k half_z) without overflow.
    const double ratio = (std::exp(k * (std::abs(z) - half_z)) + std::exp(-k * (std::abs(z) + half_z))) /
                         (1 + std::exp(-2 * k * half_z));
    sum += (n % 4 == 1 ? 1 : -1) * (1 - ratio) * std::cos(k * y) / (1.0 * n * n * n);
  }
  return 16 * half_y * half_y / (pi * pi * pi) * sum;
}

void lay_duct(const DuctRun& run, engine::Parameters& parameters) {
  const double out = run.half_width + thickness;
  engine::Domain& domain = parameters.domain;
  domain.lower = {0, -out, -out};
  domain.upper = {run.length, out, out};
  domain.lower_side =
      domain.upper_side = {engine::Side::periodic, engine::Side::reflecting, engine::Side::reflecting};
  auto grid = std::make_shared<engine::LabelGrid>();
  grid->origin = domain.lower;
  grid->voxel_size.setConstant(voxel);
  for (int axis = 0; axis < 3; ++axis)
    grid->voxels[axis] = static_cast<int>(std::lround(domain.size()[axis] / voxel));
  for (int z = 0; z < grid->voxels[2]; ++z)
    for (int y = 0; y < grid->voxels[1]; ++y)
      for (int x = 0; x < grid->voxels[0]; ++x) {
        const double reach = std::max(std::abs((y + 0.5) * voxel - out), std::abs((z + 0.5) * voxel - out));
        grid->labels.push_back(reach > run.half_width ? engine::LabelGrid::solid : engine::LabelGrid::fluid);
      }
  parameters.label_grid.grid = grid;
  parameters.label_grid.lattice_constant = 2 * voxel;
  parameters.label_grid.attraction = run.wall_repulsion;
}

double mean_duct_velocity(double half_y, double half_z) {
  double sum = 0;
  for (int n = 1; n < 2 * terms; n += 2) sum += std::tanh(n * pi * half_z / (2 * half_y)) / std::pow(n, 5);
  return half_y * half_y / 3 * (1 - 192 * half_y / (std::pow(pi, 5) * half_z) * sum);
}

DuctResult run_duct(const DuctRun& run) {
  engine::Simulation simulation(parameters_of(run), engine::ContactAngleCurve::lan2016(), {1, "auto"});
  const double half = run.half_width;
  simulation.fill_slab({0, -half, -half}, {run.length, half, half});
  simulation.set_body_forces({{run.acceleration, 0, 0}, engine::Vector3d::Zero()});
  const auto steps_of = [&](double time) { return static_cast<int>(std::lround(time / run.time_step)); };
  for (int k = 0; k < steps_of(run.settle); ++k) simulation.step();

  DuctResult result;
  result.cells = static_cast<int>(std::lround(2 * half / voxel));
  std::vector<Cell> cells(static_cast<std::size_t>(result.cells) * result.cells);
  constexpr int interval = 10;
  const int looks = std::max(1, steps_of(run.measure) / interval);
  for (int look = 0; look < looks; ++look) {
    for (int k = 0; k < interval; ++k) simulation.step();
    const auto snapshot = simulation.observe({true, false});
    for (std::size_t k = 0; k < snapshot->positions.size(); ++k) {
      const auto cell_along = [&](float place) {
        return std::clamp(static_cast<int>((place + half) / voxel), 0, result.cells - 1);
      };
      const int y = cell_along(snapshot->positions[k].y()), z = cell_along(snapshot->positions[k].z());
      Cell& cell = cells[static_cast<std::size_t>(z) * result.cells + y];
      const Eigen::Vector3f& v = snapshot->velocities[k];
      cell.beads += 1;
      cell.momentum += v.x();
      cell.across += v.y() * v.y() + v.z() * v.z();
    }
  }
  const double volume = voxel * voxel * run.length * looks;
  double beads = 0, momentum = 0, across = 0, at_walls = 0, cells_at_walls = 0;
  for (int z = 0; z < result.cells; ++z)
    for (int y = 0; y < result.cells; ++y) {
      const Cell& cell = cells[static_cast<std::size_t>(z) * result.cells + y];
      result.velocity.push_back(cell.beads > 0 ? cell.momentum / cell.beads : 0);
      result.density.push_back(cell.beads / volume);
      beads += cell.beads;
      momentum += cell.momentum;
      across += cell.across;
      const bool wall = std::min(y, z) == 0 || std::max(y, z) == result.cells - 1;
      at_walls += wall ? result.density.back() : 0;
      cells_at_walls += wall;
    }
  result.mass_flow = momentum / (run.length * looks);
  result.temperature = across / (2 * beads);
  result.densest = at_walls / cells_at_walls / (beads / (volume * cells.size()));
  fit(run, result);
  return result;
}

}  // namespace dmf::tools
