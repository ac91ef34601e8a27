#pragma once
#include <cstddef>
#include <vector>

#include "engine/beads.h"
#include "engine/cell_grid.h"
#include "engine/parameters.h"
#include "engine/walls/solid.h"
#include "engine/wettability.h"

namespace dmf::engine {

/// Every frozen bead of a run, in one array: those of the lower plate, then of the top plate (plates.h), then
/// of the solid of a label grid (solid_beads.h). Noise goes by the index of a wall bead.
///
/// Wall beads never move and are never looped over: liquid beads near a wall look up the few behind it.
class Walls {
 public:
  explicit Walls(const Parameters& parameters);

  std::size_t size() const { return beads_.size(); }
  /// x, y, z; w: A_lw.
  const AlignedVector<Record>& beads() const { return beads_; }
  /// What beads bounce off besides the sides of the domain.
  const Solid& solid() const { return solid_; }

  /// Appends the runs of wall beads that a box reaches into, of a plate none unless it reaches its plane. The
  /// box may reach over periodic sides by up to a period.
  void append_runs(const Eigen::Vector3f& lower, const Eigen::Vector3f& upper,
                   std::vector<BeadRun>& runs) const;

  std::vector<float> attraction() const;  ///< A_lw of every wall bead, in storage order
  /// @throws InvalidInput, unchanged, unless there is one value for each wall bead.
  void set_attraction(const std::vector<float>& attraction);

  /// Sets A_lw of every bead of the lower plate. @throws InvalidInput, unchanged, for an angle outside the
  /// curve.
  void set_wettability(const ContactAngleField& field, const ContactAngleCurve& curve);
  /// Shows what stays: the angle of the top plate and that of the label grid's solid, or the attractions that
  /// are given for it and for all walls (fixed_wall_attraction()).
  /// @throws InvalidInput for an angle outside the curve.
  void set_fixed_wettability(const Parameters& parameters, const ContactAngleCurve& curve);

 private:
  /// Beads that are looked up together.
  struct Group {
    std::uint32_t first, end;  ///< of its beads
    /// Who reaches this box along every axis that is closed may reach them.
    Eigen::Vector3f lower, upper;
    CellGrid grid;  ///< of its beads, numbered from 0
  };
  /// @param flat  one cell across z.
  Group add(const AlignedVector<Record>& unsorted, const Vector3d& lower, const Vector3d& upper, double range,
            bool flat);
  void add_plate(const Parameters& parameters, double plane, int outward, double range);
  bool reaches(const Group& group, const Eigen::Vector3f& lower, const Eigen::Vector3f& upper) const;
  void set_attraction_of(const Group& group, double attraction);

  Domain domain_;
  AlignedVector<Record> beads_;
  std::vector<Group> groups_;  ///< the lower plate, the top plate, the solid, as far as there are any
  Solid solid_;
};

}  // namespace dmf::engine
