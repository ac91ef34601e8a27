#include "chip/label_shape.h"

#include <algorithm>
#include <cmath>

namespace dmf::chip {

using engine::LabelGrid;
using engine::Vector3d;

bool LabelShape::holds(const Vector3d& at, const engine::Domain& domain) const {
  if (kind == Kind::box) {
    // Over a periodic side, too.
    const Vector3d from_middle = domain.nearest_image(at - 0.5 * (lower + upper));
    return (from_middle.cwiseAbs().array() <= 0.5 * (upper - lower).array()).all();
  }
  if (kind == Kind::prism) {
    const int first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
    const Eigen::Vector2d middle = bounding_box(outline).center();
    Vector3d from_middle = at;
    from_middle[first] -= middle.x();
    from_middle[second] -= middle.y();
    from_middle = domain.nearest_image(from_middle);
    return distance(middle + Eigen::Vector2d(from_middle[first], from_middle[second]), outline) == 0;
  }
  Vector3d from = domain.nearest_image(at - center);
  if (kind == Kind::cylinder) from[axis] = 0;
  return from.norm() <= radius;
}

std::size_t label(LabelGrid& grid, const engine::Domain& domain, const LabelShape& shape,
                  const Vector3d& shift, std::uint8_t label) {
  std::size_t count = 0;
  for (int z = 0; z < grid.voxels[2]; ++z)
    for (int y = 0; y < grid.voxels[1]; ++y)
      for (int x = 0; x < grid.voxels[0]; ++x) {
        const Vector3d middle =
            grid.origin + grid.voxel_size.cwiseProduct(Vector3d(x + 0.5, y + 0.5, z + 0.5));
        if (!shape.holds(middle - shift, domain)) continue;
        grid.labels[grid.index(x, y, z)] = label;
        ++count;
      }
  return count;
}

LabelGrid grid_over(const engine::Domain& domain, const Vector3d& voxel_size) {
  LabelGrid grid;
  grid.origin = domain.lower;
  for (int axis = 0; axis < 3; ++axis)
    grid.voxels[axis] = std::max(1, static_cast<int>(std::lround(domain.size()[axis] / voxel_size[axis])));
  const Vector3d count(grid.voxels[0], grid.voxels[1], grid.voxels[2]);
  grid.voxel_size = domain.size().cwiseQuotient(count);
  grid.labels.assign(static_cast<std::size_t>(count.prod()), LabelGrid::fluid);
  return grid;
}

}  // namespace dmf::chip
