#pragma once
#include <cstdint>
#include <vector>

#include "engine/beads.h"
#include "engine/cell_grid.h"
#include "engine/neighbours.h"
#include "engine/parameters.h"
#include "engine/walls/plane_wall.h"

namespace dmf::engine {

/// Where to look for the beads in range of a bead: beads sorted into cells that are wider than r_c by the
/// skin, and for every cell the runs of beads around it. Holds until some bead has moved half the skin; who
/// is in range of whom is found anew in every step, by the density pass. Full: a pair is found from both
/// sides, so every bead sums its own forces and the sum does not depend on threads.
class Pairs {
 public:
  explicit Pairs(const Parameters& parameters);

  /// Cells must be sorted anew before the next use: beads were added, removed or put elsewhere.
  void invalidate() { stale_ = true; }
  /// @param largest_displacement_squared  since the last sort, r_c^2.
  bool stale(float largest_displacement_squared) const {
    return stale_ || largest_displacement_squared > squared_half_skin_;
  }
  /// Wraps beads into periodic sides and sorts them by cell. The order is a function of positions and
  /// previous order only. @throws std::length_error when more beads crowd around a cell than slots can
  /// number.
  void rebuild(Beads& beads, const PlaneWall& wall);

  /// Finds the cells again from `beads.listed`, in the present order: restores a saved state to the bit.
  /// @throws InvalidInput when that is not the order of these cells.
  void restore(const Beads& beads, const PlaneWall& wall);

  std::vector<NeighbourBlock>& blocks() { return blocks_; }
  const std::vector<NeighbourBlock>& blocks() const { return blocks_; }
  std::uint64_t builds() const { return builds_; }
  std::size_t memory_bytes() const;

 private:
  void lay_grid(const AlignedVector<Record>& positions);
  void find_neighbourhoods(const AlignedVector<Record>& listed, const PlaneWall& wall);
  void divide_into_blocks();
  void find_runs(NeighbourBlock& block, NeighbourCell& cell, const AlignedVector<Record>& listed,
                 const PlaneWall& wall) const;

  Domain domain_;
  double range_;  ///< r_c + skin
  float squared_half_skin_;
  bool stale_ = true;
  std::uint64_t builds_ = 0;
  CellGrid grid_;
  std::vector<std::uint32_t> order_;
  std::vector<NeighbourBlock> blocks_;
};

}  // namespace dmf::engine
