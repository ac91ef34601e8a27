#pragma once
#include <cstdint>

#include "engine/parameters.h"

namespace dmf::engine {

constexpr double bytes_per_megabyte = 1e6;

/// Peak memory of a run, bytes, told before anything is allocated. What a bead or a cell takes was measured
/// (docs/performance.md).
struct MemoryNeed {
  double program = 0;  ///< that takes no liquid
  double wall = 0;     ///< frozen beads of the plates and their cells
  double cells = 0;    ///< of the sorting grid, once vapour is everywhere
  double liquid = 0;   ///< moving beads with all that goes with them
  double bodies = 0;   ///< beads of microparticles
  double bonds = 0;    ///< of chains and membranes

  double total() const { return program + wall + cells + liquid + bodies + bonds; }
};
/// @param bonded_beads  those of the moving beads that belong to chains and membranes.
MemoryNeed memory_need(const Parameters& parameters, double moving_beads, double body_beads,
                       double bonded_beads = 0);

/// Frozen beads of all plates.
double wall_beads(const Parameters& parameters);

/// The moving beads that max_beads and max_memory allow in all.
/// @param body_beads  of microparticles, that are there too.
std::uint64_t most_moving_beads(const Parameters& parameters, double body_beads, double bonded_beads = 0);

/// @throws InvalidInput when a run with so many beads in all would take more than max_beads or max_memory,
/// with the number of moving beads that would fit.
void require_memory(const Parameters& parameters, double moving_beads, double body_beads,
                    double bonded_beads = 0);

/// Size of the largest domain of the same shape whose walls and cells max_memory allows, r_c.
Vector3d largest_domain(const Parameters& parameters);

}  // namespace dmf::engine
