#include "engine/walls/violations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dmf::engine {
namespace {

constexpr double rounding = 1e-6;  ///< of places, r_c

void check_shape(const LabelGrid& grid, const Domain& domain, std::vector<std::string>& found) {
  std::size_t voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const char name = "xyz"[axis];
    const int count = grid.voxels[axis];
    if (!(count >= 1 && count <= LabelGrid::most_along)) {
      found.push_back(
          fmt::format("label_grid.voxels.{}: {}, allowed: 1 to {}", name, count, LabelGrid::most_along));
      voxels = 0;
    }
    voxels *= static_cast<std::size_t>(std::max(count, 0));
    const double size = grid.voxel_size[axis];
    if (!(size >= LabelGrid::smallest && size <= LabelGrid::largest))
      found.push_back(fmt::format("label_grid.voxel_size.{}: {:g}, allowed: {} to {} (r_c)", name, size,
                                  LabelGrid::smallest, LabelGrid::largest));
    const double lower = grid.origin[axis], upper = grid.upper()[axis];
    if (!(lower >= domain.lower[axis] - rounding && upper <= domain.upper[axis] + rounding))
      found.push_back(
          fmt::format("label_grid: {:g} to {:g} along {}, allowed: in the domain, {:g} to {:g} "
                      "(r_c)",
                      lower, upper, name, domain.lower[axis], domain.upper[axis]));
    else if (domain.periodic(axis) &&
             !(lower <= domain.lower[axis] + rounding && upper >= domain.upper[axis] - rounding))
      found.push_back(
          fmt::format("label_grid: {:g} to {:g} along {}, allowed: all of the period, {:g} to "
                      "{:g} (r_c)",
                      lower, upper, name, domain.lower[axis], domain.upper[axis]));
  }
  if (voxels > LabelGrid::most)
    found.push_back(fmt::format("label_grid.voxels: {} in all, allowed: up to {}", voxels, LabelGrid::most));
  if (voxels > 0 && grid.labels.size() != voxels)
    found.push_back(fmt::format("label_grid.labels: {}, allowed: {} x {} x {} = {}", grid.labels.size(),
                                grid.voxels[0], grid.voxels[1], grid.voxels[2], voxels));
}

void check_labels(const LabelGrid& grid, std::vector<std::string>& found) {
  const auto other = std::find_if(grid.labels.begin(), grid.labels.end(), [](std::uint8_t label) {
    return label != LabelGrid::fluid && label != LabelGrid::solid;
  });
  if (other != grid.labels.end())
    found.push_back(fmt::format("label_grid.labels: {} for voxel {}, allowed: 0 (fluid) or 1 (solid)", *other,
                                other - grid.labels.begin()));
  if (std::find(grid.labels.begin(), grid.labels.end(), LabelGrid::fluid) == grid.labels.end())
    found.push_back("label_grid: no fluid voxel, allowed: one or more");
}

}  // namespace

std::vector<std::string> label_grid_violations(const Parameters& parameters) {
  std::vector<std::string> found;
  const LabelGridParameters& solid = parameters.label_grid;
  if (!solid.grid) return found;
  check_shape(*solid.grid, parameters.domain, found);
  if (found.empty()) check_labels(*solid.grid, found);
  if (!(solid.lattice_constant >= 0.5 && solid.lattice_constant <= 1.5))
    found.push_back(
        fmt::format("label_grid.lattice_constant: {:g}, allowed: 0.5 to 1.5 (r_c)", solid.lattice_constant));
  if (solid.attraction) {
    const bool plain = parameters.liquid.repulsion == 0;
    if (!(plain ? *solid.attraction >= 0 && *solid.attraction <= 200
                : *solid.attraction < 0 && *solid.attraction >= -200))
      found.push_back(fmt::format(
          "label_grid.attraction: {:g}, allowed: {}", *solid.attraction,
          plain ? "0 to 200 (plain DPD's repulsion a)" : "-200 up to below 0 (attraction is negative)"));
  } else if (!(solid.contact_angle > 0 && solid.contact_angle <= 180)) {
    found.push_back(
        fmt::format("label_grid.contact_angle: {:g}, allowed: above 0 up to 180 (degrees), within "
                    "the calibration",
                    solid.contact_angle));
  }
  return found;
}

}  // namespace dmf::engine
