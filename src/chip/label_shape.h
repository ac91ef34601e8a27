#pragma once
#include <Eigen/Core>
#include <cstddef>

#include "chip/polygon.h"
#include "engine/parameters.h"

namespace dmf::chip {

/// A body that labels the voxels whose middle it holds.
struct LabelShape {
  enum class Kind { box, ball, cylinder, prism };
  Kind kind = Kind::box;
  Eigen::Vector3d lower = Eigen::Vector3d::Zero(), upper = Eigen::Vector3d::Zero();  ///< of a box, r_c
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of a ball or cylinder, r_c
  double radius = 0;                                 ///< of a ball or cylinder, r_c
  int axis = 2;                                      ///< of a cylinder or prism, which go on for ever
  Polygon outline;  ///< of a prism, across its axis: along the other two, in their order; sound, r_c

  /// @param from  place from the shape's own, shortest over periodic sides.
  bool holds(const Eigen::Vector3d& at, const engine::Domain& domain) const;
};

/// Gives the voxels of a shape, moved by `shift`, a label. @returns how many voxels it holds.
std::size_t label(engine::LabelGrid& grid, const engine::Domain& domain, const LabelShape& shape,
                  const Eigen::Vector3d& shift, std::uint8_t label);

/// An unlabelled grid (all fluid) over all of a domain, of voxels as near to `voxel_size` as fits.
engine::LabelGrid grid_over(const engine::Domain& domain, const Eigen::Vector3d& voxel_size);

}  // namespace dmf::chip
