#pragma once
#include <cstdint>
#include <vector>

#include "engine/beads.h"
#include "engine/cell_grid.h"
#include "engine/kernels/kernels.h"
#include "engine/parameters.h"
#include "engine/walls/plane_wall.h"

namespace dmf::engine {

/// Which beads may feel each other: a full neighbour list (both i-j and j-i, so every bead sums its own
/// forces and the sum does not depend on threads) of all pairs within r_c + skin, for liquid and wall beads
/// apart. It stays valid until some bead has moved half the skin.
class Pairs {
 public:
  explicit Pairs(const Parameters& parameters);

  /// The list must be rebuilt before the next use: beads were added, removed or put elsewhere.
  void invalidate() { stale_ = true; }
  /// @param largest_displacement_squared  since the last build, r_c^2.
  bool stale(float largest_displacement_squared) const {
    return stale_ || largest_displacement_squared > squared_half_skin_;
  }
  /// Wraps beads into periodic sides, sorts them by cell and lists neighbours. Order and list are a function
  /// of positions and previous order only.
  void rebuild(Beads& beads, const PlaneWall& wall, const Kernels& kernels);

  /// Lists again from `beads.listed`, in the present order: restores the list of a saved state to the bit.
  void restore(Beads& beads, const PlaneWall& wall, const Kernels& kernels);

  std::vector<NeighbourBlock>& blocks() { return blocks_; }
  const std::vector<NeighbourBlock>& blocks() const { return blocks_; }
  std::uint64_t builds() const { return builds_; }
  double range() const { return range_; }
  std::size_t memory_bytes() const;

 private:
  void list_neighbours(Beads& beads, const PlaneWall& wall, const Kernels& kernels);

  Domain domain_;
  double range_;
  float squared_half_skin_;
  bool stale_ = true;
  std::uint64_t builds_ = 0;
  CellGrid grid_;
  AlignedVector<float> x_, y_, z_;  ///< positions at the build, sorted
  std::vector<std::uint32_t> order_;
  std::vector<NeighbourBlock> blocks_;
};

}  // namespace dmf::engine
