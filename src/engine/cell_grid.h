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
  int coordinate(int axis, float position) const {
    return std::clamp(static_cast<int>(std::floor((position - origin[axis]) * inverse_edge[axis])), 0,
                      cells[axis] - 1);
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

 private:
  std::vector<std::uint32_t> cell_of_bead_;
};

/// Consecutive beads [begin, end) that may be in range, and the shift that brings them next to the asking
/// bead when they come from across a periodic side.
struct CandidateRun {
  std::uint32_t begin, end;
  float shift_x, shift_y, shift_z;
};

/// Candidates for a bead in cell (x, y, z) of `grid`; coordinates may lie outside the grid along axes that
/// are not periodic.
/// @returns whether a run is shifted.
bool candidate_runs(const CellGrid& grid, const Domain& domain, int x, int y, int z,
                    std::vector<CandidateRun>& runs);

}  // namespace dmf::engine
