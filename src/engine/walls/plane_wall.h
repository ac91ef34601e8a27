#pragma once
#include <cstddef>
#include <vector>

#include "engine/beads.h"
#include "engine/cell_grid.h"
#include "engine/parameters.h"
#include "engine/wettability.h"

namespace dmf::engine {

/// Frozen layers of an fcc(100) lattice under the lower z side, the first layer on the bounce-back plane.
/// That placement, with the wall absent from every density, is what shows Lan's contact angles
/// (docs/physics.md).
///
/// Wall beads never move and are never looped over: liquid beads near the plane look up the few below them.
class PlaneWall {
 public:
  /// Empty when the domain has no wall. @param range  list range, r_c.
  PlaneWall(const Domain& domain, const WallParameters& wall, double range);

  std::size_t size() const { return beads_.size(); }
  double plane() const { return plane_; }                        ///< z of the bounce-back plane
  const AlignedVector<Record>& beads() const { return beads_; }  ///< x, y, z; w: A_lw
  const CellGrid& grid() const { return grid_; }

  std::vector<float> attraction() const;  ///< A_lw of every wall bead, in storage order
  /// @throws InvalidInput, unchanged, unless there is one value for each wall bead.
  void set_attraction(const std::vector<float>& attraction);

  /// Sets A_lw of every wall bead. @throws InvalidInput, unchanged, for an angle outside the curve.
  void set_wettability(const ContactAngleField& field, const ContactAngleCurve& curve);

 private:
  double plane_ = 0;
  AlignedVector<Record> beads_;
  CellGrid grid_;
};

}  // namespace dmf::engine
