#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/beads.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// A box of cells with edges of at least the list range, so that all neighbours of a bead lie in its cell and
/// the cells around it. Along periodic axes the cells tile the period; along others they cover the beads'
/// bounding box, so that cost follows the beads, not the chip. Cells are numbered x fastest: three cells in a
/// row along x hold consecutive beads.
struct CellGrid {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  Eigen::Vector3f inverse_edge = Eigen::Vector3f::Ones();
  std::array<int, 3> cells{1, 1, 1};
  std::vector<std::uint32_t> first;  ///< first bead of each cell; one more entry than cells

  std::size_t cell_count() const { return static_cast<std::size_t>(cells[0]) * cells[1] * cells[2]; }
  /// Of the cell that holds the position if cells went on for ever.
  int unbounded_coordinate(int axis, float position) const {
    return static_cast<int>(std::floor((position - origin[axis]) * inverse_edge[axis]));
  }
  int coordinate(int axis, float position) const {
    return std::clamp(unbounded_coordinate(axis, position), 0, cells[axis] - 1);
  }
  std::size_t cell_of(float x, float y, float z) const {
    return (static_cast<std::size_t>(coordinate(2, z)) * cells[1] + coordinate(1, y)) * cells[0] +
           coordinate(0, x);
  }

  /// Lays the grid around `lower`..`upper` (bounding box of the beads), or the whole period where periodic.
  void lay(const Domain& domain, const Eigen::Vector3f& lower, const Eigen::Vector3f& upper, double range);

  /// Counting sort of `count` beads by cell, stable. Fills `first`, returns the order: bead order[k] comes
  /// k-th.
  void sort(const Record* positions, std::size_t count, std::vector<std::uint32_t>& order);

  std::size_t memory_bytes() const { return (first.capacity() + cell_of_bead_.capacity()) * 4; }

 private:
  std::vector<std::uint32_t> cell_of_bead_;
};

/// Consecutive beads [begin, end) of a grid, and the image of them that is meant.
struct BeadRun {
  std::uint32_t begin, end;
  std::uint32_t image;  ///< index into PeriodicImages
};

/// The shifts by -1, 0 or +1 period along each axis.
class PeriodicImages {
 public:
  static constexpr std::uint32_t here = 13;  ///< not shifted
  PeriodicImages() : PeriodicImages(Eigen::Vector3f::Zero()) {}
  /// @param period  r_c; along axes that are not periodic, any.
  explicit PeriodicImages(const Eigen::Vector3f& period);

  static std::uint32_t index(int x, int y, int z) {
    return static_cast<std::uint32_t>((z + 1) * 9 + (y + 1) * 3 + x + 1);
  }
  /// What to add to a bead's position to find it in that image.
  const Eigen::Vector3f& shift(std::uint32_t image) const { return shifts_[image]; }

 private:
  std::array<Eigen::Vector3f, 27> shifts_;
};

/// Appends the runs of all beads of `grid` in cells that meet the box lower..upper, which may reach over
/// periodic sides by up to a period. Rows in order of z, y, x.
void append_runs(const CellGrid& grid, const Domain& domain, const Eigen::Vector3f& lower,
                 const Eigen::Vector3f& upper, std::vector<BeadRun>& runs);

}  // namespace dmf::engine
