#include "engine/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/walls/solid_beads.h"

namespace dmf::engine {
namespace {

// Bytes, measured as docs/performance.md says.
constexpr double of_program = 10e6;
constexpr double of_wall_bead = 48;
constexpr double of_cell = 4;
constexpr double of_moving_bead = 230;
constexpr double of_baoab = 24;          ///< more, of a moving bead
constexpr double of_species = 2;         ///< more, of a moving bead of a mixture
constexpr double of_body_bead = 300;     ///< in liquid
constexpr double of_bonded_bead = 1000;  ///< of a membrane, while it is placed; of a chain less
constexpr double of_ghost = 100;         ///< its records, whose it is, and its cell

/// Images (walls/ghosts.h) of a bead, in the mean of a full box.
double ghosts_of_bead(const Parameters& parameters) {
  const double range = parameters.liquid.range() + parameters.list_skin;
  const BoundaryParameters& boundaries = parameters.boundaries;
  double images = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double share = range / parameters.domain.size()[axis];
    if (axis == 2 && boundaries.shear_rate != 0) images *= 1 + 2 * share;
    for (const auto& sides : {boundaries.lower_reflection, boundaries.upper_reflection})
      if (sides[axis] == Reflection::symmetric) images *= 1 + share;
  }
  return images - 1;
}

}  // namespace

double wall_beads(const Parameters& parameters) {
  const Domain& domain = parameters.domain;
  const Vector3d size = domain.size();
  const double plates = domain.has_top_plate() ? 2 : domain.has_wall() ? 1 : 0;
  const auto cells_along = [&](int axis) {
    return std::max(1.0, std::round(size[axis] / parameters.wall.lattice_constant));
  };
  if (parameters.dimensions == 2) return plates * parameters.wall.layers * cells_along(0);
  return plates * 2 * parameters.wall.layers * cells_along(0) * cells_along(1) +
         static_cast<double>(count_solid_beads(parameters));
}

MemoryNeed memory_need(const Parameters& parameters, double moving_beads, double body_beads,
                       double bonded_beads) {
  const double edge = parameters.liquid.cutoff_radius + parameters.list_skin;
  const bool baoab = parameters.integrator == Integrator::baoab;
  MemoryNeed need;
  need.program = of_program;
  need.wall = wall_beads(parameters) * of_wall_bead;
  if (const LabelGrid* grid = parameters.label_grid.grid.get()) {
    const Vector3d size = grid->upper() - grid->origin;
    need.wall += static_cast<double>(grid->labels.size()) + (size / edge).array().max(1.0).prod() * of_cell;
  }
  need.cells = (parameters.domain.size() / edge).array().max(1.0).prod() * of_cell;
  need.liquid = moving_beads * (of_moving_bead + (baoab ? of_baoab : 0) +
                                (parameters.mixture.liquids.empty() ? 0 : of_species) +
                                of_ghost * ghosts_of_bead(parameters));
  need.bodies = body_beads * of_body_bead;
  need.bonds = bonded_beads * of_bonded_bead;
  return need;
}

std::uint64_t most_moving_beads(const Parameters& parameters, double body_beads, double bonded_beads) {
  const double without = memory_need(parameters, 0, body_beads, bonded_beads).total();
  const double of_one = memory_need(parameters, 1, body_beads, bonded_beads).total() - without;
  const double fit = std::max(0.0, (parameters.max_memory * bytes_per_megabyte - without) / of_one);
  return std::min(parameters.max_beads, static_cast<std::uint64_t>(fit));
}

void require_memory(const Parameters& parameters, double moving_beads, double body_beads,
                    double bonded_beads) {
  const std::uint64_t most = most_moving_beads(parameters, body_beads, bonded_beads);
  const double needed =
      memory_need(parameters, moving_beads, body_beads, bonded_beads).total() / bytes_per_megabyte;
  if (moving_beads <= static_cast<double>(most) && needed <= parameters.max_memory) return;
  throw InvalidInput(
      fmt::format("{:.0f} moving beads in all and {:.0f} of microparticles take {:.0f} MB, allowed: {} "
                  "moving beads (max_beads "
                  "{}, max_memory {:.0f} MB)",
                  moving_beads, body_beads, needed, most, parameters.max_beads, parameters.max_memory));
}

Vector3d largest_domain(const Parameters& parameters) {
  // Memory grows with the scale, so halving finds it.
  double fits = 0, too_large = 1;
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (fits + too_large);
    Parameters scaled = parameters;
    scaled.domain.upper = scaled.domain.lower + middle * parameters.domain.size();
    const bool fit = memory_need(scaled, 0, 0).total() <= parameters.max_memory * bytes_per_megabyte;
    (fit ? fits : too_large) = middle;
  }
  return fits * parameters.domain.size();
}

}  // namespace dmf::engine
