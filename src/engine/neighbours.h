#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/cell_grid.h"

namespace dmf::engine {

/// The beads of one cell and where to look for what may be in their range. The beads of `runs`, one run after
/// the other, are numbered: a bead's number among them is its *slot*, and 16 bits hold it.
struct NeighbourCell {
  std::uint32_t begin, end;          ///< beads of the cell
  std::uint32_t first_run, end_run;  ///< liquid, into NeighbourBlock::runs
  std::uint32_t first_wall_run, end_wall_run;
  std::uint32_t first_body_run, end_body_run;  ///< beads of microparticles
  bool across_periodic;                        ///< some run is an image from beyond a periodic side
};

/// Some hundred consecutive beads in whole cells: the unit of work of a thread.
struct NeighbourBlock {
  static constexpr std::uint32_t most_slots = 65536;  ///< that 16 bits can number

  std::uint32_t begin = 0, end = 0;
  std::uint32_t slots = 0, wall_slots = 0, body_slots = 0;  ///< most of any cell
  std::vector<NeighbourCell> cells;                         ///< those with beads
  std::vector<BeadRun> runs, wall_runs, body_runs;

  /// Who is in range (r_c) in this step, found by the density pass: slots of bead `begin + k` stand from
  /// in_range_begin[k] to in_range_begin[k + 1]. Full: a pair stands in the rows of both its beads.
  std::vector<std::uint32_t> in_range_begin;
  std::vector<std::uint16_t> in_range;
  /// Likewise who of another kind, by index: beads of microparticles around a block of liquid, liquid around
  /// one of a microparticle. Without rows where no microparticle is near.
  std::vector<std::uint32_t> foreign_begin, foreign;

  std::uint32_t in_range_count(std::uint32_t bead) const {
    return in_range_begin[bead - begin + 1] - in_range_begin[bead - begin];
  }
  /// From the first to behind the last of a bead's row of `foreign`.
  std::pair<const std::uint32_t*, const std::uint32_t*> foreign_in_range(std::uint32_t bead) const {
    return {foreign.data() + foreign_begin[bead - begin], foreign.data() + foreign_begin[bead - begin + 1]};
  }
};

/// Calls visit(i, j) for every bead i of the block and every bead j in its range.
template <class Visit>
void for_each_pair_in_range(const NeighbourBlock& block, Visit visit) {
  std::vector<std::uint32_t> bead_in_slot;
  for (const NeighbourCell& cell : block.cells) {
    bead_in_slot.clear();
    for (std::uint32_t run = cell.first_run; run < cell.end_run; ++run)
      for (std::uint32_t j = block.runs[run].begin; j < block.runs[run].end; ++j) bead_in_slot.push_back(j);
    for (std::uint32_t i = cell.begin; i < cell.end; ++i)
      for (std::uint32_t k = block.in_range_begin[i - block.begin];
           k < block.in_range_begin[i - block.begin + 1]; ++k)
        visit(i, bead_in_slot[block.in_range[k]]);
  }
}

/// The block that holds a bead. Blocks stand in the order of their beads.
inline const NeighbourBlock& block_of(const std::vector<NeighbourBlock>& blocks, std::uint32_t bead) {
  return *(std::upper_bound(blocks.begin(), blocks.end(), bead,
                            [](std::uint32_t b, const NeighbourBlock& block) { return b < block.begin; }) -
           1);
}

}  // namespace dmf::engine
