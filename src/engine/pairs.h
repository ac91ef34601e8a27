#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/beads.h"
#include "engine/bodies/microparticles.h"
#include "engine/cell_grid.h"
#include "engine/neighbours.h"
#include "engine/parameters.h"
#include "engine/walls/ghosts.h"
#include "engine/walls/walls.h"

namespace dmf::engine {

struct PatchedBody;

/// What is near a smooth sphere.
struct SmoothNeighbours {
  std::size_t microparticle;  ///< index into Microparticles::all()
  std::vector<BeadRun> liquid, wall;
};

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
    if (stale_ || largest_displacement_squared > squared_half_skin_) return true;
    if (ghosts_.moved() == 0) return false;
    return std::sqrt(largest_displacement_squared) + 0.5f * ghosts_.moved() > std::sqrt(squared_half_skin_);
  }
  /// Wraps beads into periodic sides and sorts them by cell. The order is a function of positions and
  /// previous order only. @throws std::length_error when more beads crowd around a cell than slots can
  /// number.
  void rebuild(Beads& beads, const Walls& wall);
  /// From the next rebuild() on: how far microparticles whose centres are in the box reach beyond sheared
  /// sides, r_c.
  void set_protrusion(double protrusion) { protrusion_ = protrusion; }

  /// Finds the cells again from `beads.listed`, in the present order: restores a saved state to the bit.
  /// @throws InvalidInput when that is not the order of these cells.
  void restore(const Beads& beads, const Walls& wall);

  /// Notes which patches of microparticles are near which cells, and what liquid and wall are near which
  /// patches, from where they are now. After each rebuild() or restore(), when there are microparticles.
  /// @throws std::length_error as rebuild().
  void find_bodies(const Microparticles& bodies, const Beads& beads, const Walls& wall);

  void forget_bodies() {
    ghosts_.forget_bodies();
    body_blocks_.clear();
    smooth_neighbours_.clear();
  }

  std::vector<NeighbourBlock>& blocks() { return blocks_; }
  const std::vector<NeighbourBlock>& blocks() const { return blocks_; }
  /// Blocks of beads of microparticles, none of two: their cells are patches, their runs liquid and wall.
  std::vector<NeighbourBlock>& body_blocks() { return body_blocks_; }
  const std::vector<NeighbourBlock>& body_blocks() const { return body_blocks_; }
  const std::vector<SmoothNeighbours>& smooth_neighbours() const { return smooth_neighbours_; }
  Ghosts& ghosts() { return ghosts_; }
  const Ghosts& ghosts() const { return ghosts_; }
  std::uint64_t builds() const { return builds_; }
  std::size_t memory_bytes() const;

 private:
  void lay_grid(const AlignedVector<Record>& positions);
  void find_neighbourhoods(const AlignedVector<Record>& listed, const Walls& wall);
  void divide_into_blocks();
  /// `listed` is where the beads of the cell were when they were sorted.
  void find_runs(NeighbourBlock& block, NeighbourCell& cell, const AlignedVector<Record>& listed,
                 const Walls& wall) const;
  void find_body_runs(NeighbourBlock& block, NeighbourCell& cell, const AlignedVector<Record>& listed,
                      const std::vector<PatchedBody>& bodies) const;

  Ghosts ghosts_;
  Domain domain_;  ///< as ghosts_ want it searched
  double range_;   ///< r_c + skin
  double protrusion_ = 0;
  float squared_half_skin_;
  bool stale_ = true;
  std::uint64_t builds_ = 0;
  CellGrid grid_;
  std::vector<std::uint32_t> order_;
  std::vector<NeighbourBlock> blocks_, body_blocks_;
  std::vector<SmoothNeighbours> smooth_neighbours_;
};

}  // namespace dmf::engine
