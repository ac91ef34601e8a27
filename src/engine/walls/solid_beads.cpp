#include "engine/walls/solid_beads.h"

#include <algorithm>
#include <cmath>

namespace dmf::engine {
namespace {

/// How far a layer may be stretched to lie on the faces of voxels.
constexpr double largest_stretch = 0.15;
constexpr double rounding = 1e-6;  ///< of places, in voxels or r_c

/// The label grid in its domain, by voxels that may lie outside of it.
class Voxels {
 public:
  Voxels(const LabelGrid& grid, const Domain& domain) : grid_(grid), domain_(domain) {}

  bool is_fluid(std::array<int, 3> cell) const {
    return inside(cell) ? grid_.labels[grid_.index(cell[0], cell[1], cell[2])] == LabelGrid::fluid
                        : domain_.contains(middle(cell));
  }
  bool is_solid(std::array<int, 3> cell) const {
    return inside(cell) && grid_.labels[grid_.index(cell[0], cell[1], cell[2])] == LabelGrid::solid;
  }

 private:
  Vector3d middle(const std::array<int, 3>& cell) const {
    return grid_.origin + grid_.voxel_size.cwiseProduct(Vector3d(cell[0] + .5, cell[1] + .5, cell[2] + .5));
  }
  /// Folds a cell into the grid along periodic axes.
  bool inside(std::array<int, 3>& cell) const {
    bool within = true;
    for (int axis = 0; axis < 3; ++axis) {
      const int count = grid_.voxels[axis];
      if (domain_.periodic(axis)) cell[axis] = (cell[axis] % count + count) % count;
      within &= cell[axis] >= 0 && cell[axis] < count;
    }
    return within;
  }

  const LabelGrid& grid_;
  const Domain& domain_;
};

/// Voxels along an axis that a place touches: two when it lies on a face.
struct Touched {
  int first, last;
  Touched(double place, double size)
      : first(static_cast<int>(std::floor(place / size - rounding))),
        last(static_cast<int>(std::floor(place / size + rounding))) {}
};

bool touches_solid(const Voxels& voxels, const Vector3d& place, const Vector3d& size) {
  const Touched x(place.x(), size.x()), y(place.y(), size.y()), z(place.z(), size.z());
  for (int k = z.first; k <= z.last; ++k)
    for (int j = y.first; j <= y.last; ++j)
      for (int i = x.first; i <= x.last; ++i)
        if (voxels.is_solid({i, j, k})) return true;
  return false;
}

/// Is a fluid voxel nearer than `range` to a place, counted from the grid's origin?
bool near_fluid(const Voxels& voxels, const Vector3d& place, const Vector3d& size, double range) {
  std::array<int, 3> first, last;
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = static_cast<int>(std::floor((place[axis] - range) / size[axis]));
    last[axis] = static_cast<int>(std::floor((place[axis] + range) / size[axis]));
  }
  const auto apart = [&](int axis, int cell) {
    return std::max({cell * size[axis] - place[axis], place[axis] - (cell + 1) * size[axis], 0.0});
  };
  for (int k = first[2]; k <= last[2]; ++k)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i) {
        const Vector3d away(apart(0, i), apart(1, j), apart(2, k));
        if (away.squaredNorm() < range * range - rounding && voxels.is_fluid({i, j, k})) return true;
      }
  return false;
}

/// Voxels that a fluid one, or the outside of the grid, is within so many voxels of along every axis: all
/// others lie too deep in the solid to look for fluid around each of their sites.
std::vector<std::uint8_t> voxels_near_fluid(const LabelGrid& grid, const Domain& domain, double range) {
  std::vector<std::uint8_t> near(grid.labels.size());
  for (std::size_t k = 0; k < near.size(); ++k) near[k] = grid.labels[k] == LabelGrid::fluid;
  std::vector<std::uint8_t> spread;
  for (int axis = 0; axis < 3; ++axis) {
    const int reach = static_cast<int>(std::ceil(range / grid.voxel_size[axis])) + 1;
    const int count = grid.voxels[axis];
    const bool periodic = domain.periodic(axis);
    const std::size_t stride = axis == 0 ? 1 : axis == 1 ? grid.voxels[0] : grid.index(0, 0, 1);
    spread = near;
    // Along a line, there and back: how many voxels ago was the last one?
    const auto sweep = [&](std::size_t line, bool back) {
      int ago = periodic ? reach + 1 : 0;
      for (int step = periodic ? -reach : 0; step < count; ++step) {
        const int at = ((back ? count - 1 - step : step) + count * (1 + reach / count)) % count;
        const std::size_t voxel = line + static_cast<std::size_t>(at) * stride;
        ago = near[voxel] ? 0 : ago + 1;
        if (step >= 0 && ago <= reach) spread[voxel] = 1;
      }
    };
    for (std::size_t k = 0; k < near.size(); ++k)
      if (k / stride % count == 0) sweep(k, false), sweep(k, true);
    near.swap(spread);
  }
  return near;
}

/// Calls visit(site) for every bead.
template <class Visit>
void for_each_bead(const Parameters& parameters, Visit visit) {
  if (!parameters.label_grid.grid) return;
  const LabelGrid& grid = *parameters.label_grid.grid;
  const Domain& domain = parameters.domain;
  const Voxels voxels(grid, domain);
  const Vector3d size = grid.voxel_size, apart = layer_distance(parameters);
  const double range = parameters.liquid.range();
  const std::vector<std::uint8_t> near = voxels_near_fluid(grid, domain, range);
  std::array<int, 3> layers;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = grid.voxels[axis] * size[axis];
    // Both ends, but of a period only one.
    layers[axis] = domain.periodic(axis) ? static_cast<int>(std::lround(length / apart[axis]))
                                         : static_cast<int>(std::floor(length / apart[axis] + rounding)) + 1;
  }
  const double above = domain.has_wall() ? domain.lower.z() + rounding : -1e30;
  const double below = domain.has_top_plate() ? domain.upper.z() - rounding : 1e30;
  for (int k = 0; k < layers[2]; ++k)
    for (int j = 0; j < layers[1]; ++j)
      // Sites of an fcc lattice: those of a cubic one whose three numbers have an even sum.
      for (int i = (j + k) % 2; i < layers[0]; i += 2) {
        const Vector3d place = apart.cwiseProduct(Vector3d(i, j, k));
        const Vector3d site = grid.origin + place;
        if (site.z() < above || site.z() > below) continue;
        std::array<int, 3> own;
        for (int axis = 0; axis < 3; ++axis)
          own[axis] = std::min(static_cast<int>(place[axis] / size[axis]), grid.voxels[axis] - 1);
        if (!near[grid.index(own[0], own[1], own[2])]) continue;
        if (touches_solid(voxels, place, size) && near_fluid(voxels, place, size, range)) visit(site);
      }
}

}  // namespace

Vector3d layer_distance(const Parameters& parameters) {
  const LabelGrid& grid = *parameters.label_grid.grid;
  const double usual = 0.5 * parameters.label_grid.lattice_constant;
  Vector3d apart;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = grid.voxel_size[axis];
    if (parameters.domain.periodic(axis)) {
      // An even number of layers, so that the lattice closes on itself.
      const double period = grid.voxels[axis] * size;
      apart[axis] = 0.5 * period / std::max(1.0, std::round(0.5 * period / usual));
      continue;
    }
    const double fitting = size / std::max(1.0, std::round(size / usual));
    apart[axis] = std::abs(fitting / usual - 1) <= largest_stretch ? fitting : usual;
  }
  return apart;
}

AlignedVector<Record> solid_beads(const Parameters& parameters) {
  AlignedVector<Record> beads;
  beads.reserve(count_solid_beads(parameters));
  for_each_bead(parameters, [&](const Vector3d& site) {
    beads.push_back(
        {static_cast<float>(site.x()), static_cast<float>(site.y()), static_cast<float>(site.z()), 0.f});
  });
  return beads;
}

std::size_t count_solid_beads(const Parameters& parameters) {
  std::size_t count = 0;
  for_each_bead(parameters, [&](const Vector3d&) { ++count; });
  return count;
}

}  // namespace dmf::engine
