#include "tools/duct.h"

#include <algorithm>
#include <cmath>

#include "chip/experiment.h"
#include "chip/label_shape.h"

namespace dmf::tools {
namespace {

constexpr int terms = 200;       ///< of the series: the n-th counts 1 / n^3
constexpr double voxel = 0.5;    ///< r_c: half the lattice constant of walls of four beads per r_c^3
constexpr double thickness = 1;  ///< of the walls, r_c

/// Sums over the beads of a cell of the section.
struct Cell {
  double beads = 0, momentum = 0, across = 0;
};

/// Gradient over viscosity, and the square sum that is left, when the duct is so wide.
struct Fit {
  double strength, left;
};

Fit fit_of(const DuctResult& result, double width) {
  double theory_theory = 0, theory_measured = 0, measured_measured = 0;
  for (int z = 0; z < result.cells; ++z)
    for (int y = 0; y < result.cells; ++y) {
      const double theory = duct_velocity(result.middle(y), result.middle(z), width, width);
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
  for (double width = 0.9 * result.half_width; width <= 1.1 * result.half_width;
       width += 0.002 * result.half_width) {
    const Fit found = fit_of(result, width);
    if (found.left >= best) continue;
    best = found.left;
    strength = found.strength;
    result.fitted_width = width;
  }
  result.viscosity = 4 * run.acceleration() / strength;
  result.deviation = std::sqrt(std::max(0.0, best) / (result.cells * result.cells)) /
                     (strength * duct_velocity(0, 0, result.fitted_width, result.fitted_width));
}

}  // namespace

double duct_velocity(double y, double z, double half_y, double half_z) {
  if (std::abs(y) >= half_y || std::abs(z) >= half_z) return 0;
  double sum = 0;
  for (int n = 1; n < 2 * terms; n += 2) {
    const double k = n * M_PI / (2 * half_y);
    // cosh(k z) / cosh(k half_z) without overflow.
    const double ratio = (std::exp(k * (std::abs(z) - half_z)) + std::exp(-k * (std::abs(z) + half_z))) /
                         (1 + std::exp(-2 * k * half_z));
    sum += (n % 4 == 1 ? 1 : -1) * (1 - ratio) * std::cos(k * y) / (1.0 * n * n * n);
  }
  return 16 * half_y * half_y / (M_PI * M_PI * M_PI) * sum;
}

void lay_duct(double length, double half_width, engine::Parameters& parameters) {
  const double out = half_width + thickness;
  engine::Domain& domain = parameters.domain;
  domain.lower = {0, -out, -out};
  domain.upper = {length, out, out};
  domain.lower_side =
      domain.upper_side = {engine::Side::periodic, engine::Side::reflecting, engine::Side::reflecting};
  engine::LabelGrid grid = chip::grid_over(domain, engine::Vector3d::Constant(voxel));
  std::fill(grid.labels.begin(), grid.labels.end(), engine::LabelGrid::solid);
  chip::LabelShape inside;
  inside.lower = {0, -half_width, -half_width};
  inside.upper = {length, half_width, half_width};
  chip::label(grid, domain, inside, engine::Vector3d::Zero(), engine::LabelGrid::fluid);
  parameters.label_grid.grid = std::make_shared<const engine::LabelGrid>(std::move(grid));
  parameters.label_grid.lattice_constant = 2 * voxel;
}

void lay_duct(double length, double half_width, chip::Scene& scene) {
  lay_duct(length, half_width, scene.parameters);
  engine::FillPlacement all;
  all.lower = {0, -half_width, -half_width};
  all.upper = {length, half_width, half_width};
  scene.fills = {all};
}

double DuctRun::half_width() const {
  const engine::LabelGrid& grid = *scene.parameters.label_grid.grid;
  int fluid = 0;
  for (int y = 0; y < grid.voxels[1]; ++y)
    fluid += grid.labels[grid.index(0, y, grid.voxels[2] / 2)] == engine::LabelGrid::fluid;
  return 0.5 * fluid * grid.voxel_size.y();
}

double mean_duct_velocity(double half_y, double half_z) {
  double sum = 0;
  for (int n = 1; n < 2 * terms; n += 2) sum += std::tanh(n * M_PI * half_z / (2 * half_y)) / std::pow(n, 5);
  return half_y * half_y / 3 * (1 - 192 * half_y / (std::pow(M_PI, 5) * half_z) * sum);
}

DuctResult run_duct(const DuctRun& run) {
  chip::Experiment experiment(run.scene, {1, "auto"}, run.seed);
  const double half = run.half_width(), length = run.scene.parameters.domain.size().x();
  const auto steps_of = [&](double time) {
    return static_cast<int>(std::lround(time / run.scene.parameters.time_step));
  };
  for (int k = 0; k < steps_of(run.settle); ++k) experiment.step();

  DuctResult result;
  result.half_width = half;
  result.cells = static_cast<int>(std::lround(2 * half / voxel));
  std::vector<Cell> cells(static_cast<std::size_t>(result.cells) * result.cells);
  constexpr int interval = 10;
  const int looks = std::max(1, steps_of(run.measure) / interval);
  for (int look = 0; look < looks; ++look) {
    for (int k = 0; k < interval; ++k) experiment.step();
    const auto snapshot = experiment.observe({true, false});
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
  const double volume = voxel * voxel * length * looks;
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
  result.mass_flow = momentum / (length * looks);
  result.temperature = across / (2 * beads);
  result.densest = at_walls / cells_at_walls / (beads / (volume * cells.size()));
  fit(run, result);
  return result;
}

}  // namespace dmf::tools
