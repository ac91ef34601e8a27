#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace dmf::engine {

/// A box of voxels, each fluid or solid: walls of any shape (Liu 3.2). What lies outside of the grid is
/// fluid.
struct LabelGrid {
  static constexpr std::uint8_t fluid = 0, solid = 1;
  static constexpr int most_along = 4000;                  ///< voxels along one axis
  static constexpr std::size_t most = 20'000'000;          ///< voxels in all
  static constexpr double smallest = 0.2, largest = 10.0;  ///< edges of a voxel, r_c

  Eigen::Vector3d origin = Eigen::Vector3d::Zero();               ///< lower corner of the first voxel, r_c
  Eigen::Vector3d voxel_size = Eigen::Vector3d::Constant(0.874);  ///< edges of a voxel, r_c
  std::array<int, 3> voxels{0, 0, 0};                             ///< along x, y, z
  std::vector<std::uint8_t> labels;                               ///< fluid or solid; x fastest, then y

  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * voxels[1] + y) * voxels[0] + x;
  }
  Eigen::Vector3d upper() const {
    return origin + voxel_size.cwiseProduct(Eigen::Vector3d(voxels[0], voxels[1], voxels[2]));
  }
};

/// The solid of a run, and what its frozen beads do to the liquid.
struct LabelGridParameters {
  /// Null: none. It lies in the domain, and spans all of the period along a periodic axis.
  std::shared_ptr<const LabelGrid> grid;
  /// Of the fcc lattice of its beads, r_c; [0.5, 1.5]. 0.874 is the plates': 6 beads per r_c^3.
  double lattice_constant = 0.874;
  double contact_angle = 110;        ///< that it shows, degrees; within the calibration
  std::optional<double> attraction;  ///< A_lw in place of the angle; of plain DPD a >= 0; [-200, 200]
};

}  // namespace dmf::engine
