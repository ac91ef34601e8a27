#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/parameters.h"
#include "engine/walls/label_grid.h"

namespace dmf::engine {

/// Where a sphere touches the solid of a label grid.
struct SolidTouch {
  Vector3d normal;  ///< from there to the sphere's centre, of length 1
  double distance;  ///< between the two, r_c
};

/// The solid voxels of a label grid as moving beads meet them. A view: cheap to make and to copy.
class Solid {
 public:
  Solid() = default;  ///< none
  explicit Solid(const Parameters& parameters);

  bool empty() const { return !grid_; }

  /// Is this place in a solid voxel? Beyond a periodic side it is folded back.
  bool contains(const Eigen::Vector3f& at) const;
  /// The same, and all that is within `margin` r_c along the axes is solid, too.
  bool contains_deep(const Eigen::Vector3f& at, float margin) const;

  /// Fraction of `way` that a bead can go from `from` before it meets a solid voxel; 1 when it meets none.
  /// From a place in the solid, 1: out of it every way is free.
  float free_fraction(const Eigen::Vector3f& from, const Eigen::Vector3f& way) const;

  /// Appends where a sphere touches the solid: the places on its surface that are nearer to `centre` than all
  /// others around them, and nearer than `radius`. A face is one such place however many voxels it is made
  /// of, so that a sphere rolls over their seams; an edge or a corner is one where it sticks out. None of a
  /// centre in the solid.
  void append_touches(const Vector3d& centre, double radius, std::vector<SolidTouch>& touches) const;

  /// Unit normal of the surface near a place, out of the solid: down the gradient of the labels, smoothed
  /// over the voxels next to its own (Liu 3.2). Zero where no surface is near.
  Vector3d normal(const Vector3d& at) const;

 private:
  using Cell = std::array<int, 3>;
  Cell cell_of(const Eigen::Vector3f& at) const;
  bool is_solid(Cell cell) const;
  /// Is there fluid beyond the face, edge or corner of a voxel that points towards `beyond`, -1 to 1 each?
  bool sticks_out(const Cell& cell, const Cell& beyond) const;

  std::shared_ptr<const LabelGrid> grid_;
  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero(), inverse_size_ = Eigen::Vector3f::Ones();
  std::array<bool, 3> periodic_{false, false, false};
};

}  // namespace dmf::engine
