#pragma once
#include <cstddef>
#include <vector>

#include "engine/beads.h"
#include "engine/cell_grid.h"
#include "engine/parameters.h"
#include "engine/wettability.h"

namespace dmf::engine {

/// Frozen layers of an fcc(100) lattice under the lower z side, the first layer on the bounce-back plane, and
/// their mirror image over the upper side when there is a top plate. That placement, with walls absent from
/// every density, is what shows Lan's contact angles (docs/physics.md).
///
/// Wall beads never move and are never looped over: liquid beads near a plane look up the few behind it.
class Plates {
 public:
  /// Empty when the domain has no wall. @param range  list range, r_c. @param dimensions  with 2, of each
  /// layer the beads of one row, half-way between the y sides: 2 / a^2 a r_c^2.
  Plates(const Domain& domain, const WallParameters& wall, double range, int dimensions = 3);

  std::size_t size() const { return beads_.size(); }
  /// x, y, z; w: A_lw. Those of the lower plate come first.
  const AlignedVector<Record>& beads() const { return beads_; }

  /// Appends the runs of wall beads that a box reaches into, none unless it reaches a plane. The box may
  /// reach over periodic sides by up to a period.
  void append_runs(const Eigen::Vector3f& lower, const Eigen::Vector3f& upper,
                   std::vector<BeadRun>& runs) const;

  std::vector<float> attraction() const;  ///< A_lw of every wall bead, in storage order
  /// @throws InvalidInput, unchanged, unless there is one value for each wall bead.
  void set_attraction(const std::vector<float>& attraction);

  /// Sets A_lw of every bead of the lower plate. @throws InvalidInput, unchanged, for an angle outside the
  /// curve.
  void set_wettability(const ContactAngleField& field, const ContactAngleCurve& curve);
  /// The same for the top plate, if there is one: all of it shows one angle, degrees.
  void set_top_wettability(double angle, const ContactAngleCurve& curve);

 private:
  struct Plate {
    double plane;         ///< z of the bounce-back plane
    std::uint32_t first;  ///< of its beads
    CellGrid grid;        ///< of its beads, numbered from 0
  };
  /// @param outward  -1: layers go down from the plane, +1: up.
  void add_plate(const WallParameters& wall, double plane, int outward, double range, int dimensions);

  Domain domain_;
  AlignedVector<Record> beads_;
  std::vector<Plate> plates_;  ///< the lower one, then the top one
};

}  // namespace dmf::engine
