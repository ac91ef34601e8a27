#include "engine/walls/solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dmf::engine {

Solid::Solid(const Parameters& parameters) : grid_(parameters.label_grid.grid) {
  if (!grid_) return;
  origin_ = grid_->origin.cast<float>();
  inverse_size_ = grid_->voxel_size.cwiseInverse().cast<float>();
  for (int axis = 0; axis < 3; ++axis) periodic_[axis] = parameters.domain.periodic(axis);
}

Solid::Cell Solid::cell_of(const Eigen::Vector3f& at) const {
  Cell cell;
  for (int axis = 0; axis < 3; ++axis)
    cell[axis] = static_cast<int>(std::floor((at[axis] - origin_[axis]) * inverse_size_[axis]));
  return cell;
}

bool Solid::is_solid(Cell cell) const {
  for (int axis = 0; axis < 3; ++axis) {
    const int count = grid_->voxels[axis];
    if (cell[axis] >= 0 && cell[axis] < count) continue;
    if (!periodic_[axis]) return false;
    cell[axis] = (cell[axis] % count + count) % count;
  }
  return grid_->labels[grid_->index(cell[0], cell[1], cell[2])] == LabelGrid::solid;
}

bool Solid::contains(const Eigen::Vector3f& at) const { return grid_ && is_solid(cell_of(at)); }

bool Solid::contains_deep(const Eigen::Vector3f& at, float margin) const {
  if (!contains(at)) return false;
  for (int axis = 0; axis < 3; ++axis)
    for (const float shift : {-margin, margin})
      if (!contains(at + shift * Eigen::Vector3f::Unit(axis))) return false;
  return true;
}

float Solid::free_fraction(const Eigen::Vector3f& from, const Eigen::Vector3f& way) const {
  Cell cell = cell_of(from);
  const Cell end = cell_of(from + way);
  if (cell == end || is_solid(cell)) return 1.f;
  // From face to face along the way (Amanatides and Woo 1987).
  std::array<float, 3> next, step;  // fractions of the way: to the next face, and from face to face
  std::array<int, 3> turn;
  for (int axis = 0; axis < 3; ++axis) {
    const float in_voxels = way[axis] * inverse_size_[axis];
    const float place = (from[axis] - origin_[axis]) * inverse_size_[axis] - static_cast<float>(cell[axis]);
    turn[axis] = in_voxels > 0 ? 1 : -1;
    const bool still = in_voxels == 0;
    step[axis] = still ? std::numeric_limits<float>::infinity() : std::abs(1.f / in_voxels);
    next[axis] =
        still ? std::numeric_limits<float>::infinity() : step[axis] * (in_voxels > 0 ? 1.f - place : place);
  }
  for (;;) {
    const int axis = static_cast<int>(std::min_element(next.begin(), next.end()) - next.begin());
    if (!(next[axis] <= 1.f)) return 1.f;
    cell[axis] += turn[axis];
    if (is_solid(cell)) return std::clamp(next[axis], 0.f, 1.f);
    next[axis] += step[axis];
  }
}

void Solid::append_touches(const Vector3d& centre, double radius, std::vector<SolidTouch>& touches) const {
  if (!grid_ || contains(centre.cast<float>())) return;
  const Vector3d &origin = grid_->origin, &size = grid_->voxel_size;
  Cell first, last;
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = static_cast<int>(std::floor((centre[axis] - radius - origin[axis]) / size[axis]));
    last[axis] = static_cast<int>(std::floor((centre[axis] + radius - origin[axis]) / size[axis]));
  }
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x) {
        const Cell cell{x, y, z};
        if (!is_solid(cell)) continue;
        // Not lower + size: the upper side of one voxel is the lower one of the next to the last bit.
        const Vector3d lower = origin + size.cwiseProduct(Vector3d(x, y, z)),
                       upper = origin + size.cwiseProduct(Vector3d(x + 1, y + 1, z + 1));
        const Vector3d way = centre - centre.cwiseMax(lower).cwiseMin(upper);
        const double distance = way.norm();
        if (!(distance < radius) || distance == 0) continue;
        // Whose sides the centre is beyond; on the side itself beyond the upper one, so that of two voxels
        // with a common side only one is below it.
        Cell beyond;
        for (int axis = 0; axis < 3; ++axis)
          beyond[axis] = centre[axis] < lower[axis] ? -1 : centre[axis] >= upper[axis] ? 1 : 0;
        if (sticks_out(cell, beyond)) touches.push_back({way / distance, distance});
      }
}

bool Solid::sticks_out(const Cell& cell, const Cell& beyond) const {
  for (int z = 0; z <= std::abs(beyond[2]); ++z)
    for (int y = 0; y <= std::abs(beyond[1]); ++y)
      for (int x = 0; x <= std::abs(beyond[0]); ++x) {
        if (x + y + z == 0) continue;
        if (is_solid({cell[0] + x * beyond[0], cell[1] + y * beyond[1], cell[2] + z * beyond[2]}))
          return false;
      }
  return true;
}

Vector3d Solid::normal(const Vector3d& at) const {
  if (!grid_) return Vector3d::Zero();
  const Cell middle = cell_of(at.cast<float>());
  // Central differences with the weights 1, 2, 1 across each axis (Sobel).
  Vector3d gradient = Vector3d::Zero();
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        if (!is_solid({middle[0] + x, middle[1] + y, middle[2] + z})) continue;
        const int weight = (2 - std::abs(x)) * (2 - std::abs(y)) * (2 - std::abs(z));
        gradient += weight * Vector3d(x, y, z);
      }
  gradient = gradient.cwiseQuotient(grid_->voxel_size);
  const double length = gradient.norm();
  return length > 0 ? Vector3d(-gradient / length) : Vector3d::Zero();
}

}  // namespace dmf::engine
