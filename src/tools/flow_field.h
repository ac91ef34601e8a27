#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "engine/archive.h"

namespace dmf::tools {

/// Mean velocity of the liquid in cells of two upright planes through a moving centre: x-z along its way and
/// y-z across it. Velocities are relative to the wall. Reduced units.
class FlowField {
 public:
  static constexpr double cell = 0.5;            ///< r_c, edge in the plane
  static constexpr double half_thickness = 1.0;  ///< r_c, of the slabs that are looked at
  static constexpr double reach = 15.0;          ///< r_c, to both sides of the centre
  static constexpr double height = 16.0;         ///< r_c, above the wall

  FlowField();
  /// @param relative  place from the centre in x and y, from the wall plane in z.
  void add(const Eigen::Vector3d& relative, const Eigen::Vector3d& velocity);
  /// One more look has been added.
  void count_look() { looks_ += 1; }
  double looks() const { return looks_; }
  void archive(engine::Archive& archive);

  enum class Plane { along, across };
  /// Mean velocity, along s and z, of the beads in cells whose middles lie in `region`, s and z as in the CSV
  /// file; NaN where there was none.
  Eigen::Vector2d mean_velocity(Plane plane, const Eigen::AlignedBox2d& region) const;

  /// "plane,s,z,density,v_s,v_z", a line a cell with liquid: s is x or y of the cell's middle from the
  /// centre, density in beads per r_c^3.
  std::string as_csv() const;

 private:
  static constexpr int columns = static_cast<int>(2 * reach / cell), rows = static_cast<int>(height / cell);
  /// Sums over the beads of one plane's cell.
  struct Cell {
    double beads = 0, momentum_s = 0, momentum_z = 0;
  };
  void add(std::vector<Cell>& plane, double s, double z, double across, double v_s, double v_z);
  static Eigen::Vector2d middle(int row, int column) {
    return {(column + 0.5) * cell - reach, (row + 0.5) * cell};
  }

  double looks_ = 0;
  std::vector<Cell> along_, across_;
};

}  // namespace dmf::tools
