#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace dmf::chip {

/// Which boxes a point may lie in, looked up in constant time: a grid of cells, each with the boxes that
/// reach it. The plate's wettability is asked for at some hundred thousand wall beads whenever a command
/// changes it.
class ElectrodeIndex {
 public:
  ElectrodeIndex() = default;
  explicit ElectrodeIndex(const std::vector<Eigen::AlignedBox2d>& boxes);

  /// Indices of the boxes that reach the point's cell, rising; every box that contains the point is among
  /// them.
  const std::vector<std::uint32_t>& candidates(const Eigen::Vector2d& point) const;

 private:
  Eigen::Array2i cell_of(const Eigen::Vector2d& point) const;

  Eigen::AlignedBox2d extent_;  ///< empty without boxes
  Eigen::Array2i shape_{0, 0};
  Eigen::Array2d cell_size_{1, 1};
  std::vector<std::vector<std::uint32_t>> cells_;
  std::vector<std::uint32_t> none_;
};

}  // namespace dmf::chip
