#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/beads.h"
#include "engine/cell_grid.h"
#include "engine/species.h"

namespace dmf::engine {

/// Neighbours of one bead inside its block's arrays.
struct NeighbourRow {
  std::uint32_t liquid_begin = 0, wall_begin = 0;  ///< into NeighbourBlock::liquid and ::wall
  std::uint16_t liquid_count = 0, wall_count = 0;
  std::uint16_t hits = 0;        ///< entries of NeighbourBlock::in_range, from liquid_begin
  bool across_periodic = false;  ///< some neighbour is nearest through a periodic side
};

/// Neighbours of beads [begin, end): the unit of work of a thread. Entries are byte offsets of 16-byte
/// records.
struct NeighbourBlock {
  std::uint32_t begin = 0, end = 0;
  std::vector<NeighbourRow> rows;
  std::vector<std::uint32_t> liquid;    ///< within r_c + skin
  std::vector<std::uint32_t> in_range;  ///< within r_c this step: left by the density pass for the force pass
  std::vector<std::uint32_t> wall;
  std::size_t liquid_used = 0, wall_used = 0;
};

/// What the two loops over pairs read and write.
struct PairPass {
  const Record* position;        ///< x, y, z, key
  Record* predicted;             ///< velocities; density pass writes w = rho
  Record* force;                 ///< force pass writes
  const Record* wall = nullptr;  ///< x, y, z, A_lw
  PairTable laws;
  double density_normalization = 0;
  Eigen::Vector3f period = Eigen::Vector3f::Zero();  ///< 0 along axes that are not periodic
  Eigen::Vector3f inverse_period = Eigen::Vector3f::Zero();
};

/// What the list build reads.
struct ListPass {
  const float *x, *y, *z;  ///< moving beads, sorted, with 64 floats of slack
  const CellGrid* grid;
  const float *wall_x, *wall_y, *wall_z;  ///< likewise
  const CellGrid* wall_grid;
  const Domain* domain;
  float range;       ///< r_c + skin
  float wall_reach;  ///< beads above this z see no wall
};

/// The loops that cost time, for one instruction set. The physics in them stands in pair_law-inl.h and
/// noise-inl.h.
struct Kernels {
  const char* name;
  std::size_t lanes;
  void (*list)(const ListPass&, NeighbourBlock&);     ///< fills rows, liquid, wall of a block
  void (*density)(const PairPass&, NeighbourBlock&);  ///< rho of the block's beads, and in_range
  /// By PairForce. `all` and `conservative` need the density of all beads.
  std::array<void (*)(const PairPass&, const NeighbourBlock&), 4> force;
};

/// Names that this processor can run, best first.
std::vector<std::string> vector_kernels();
/// The best, or the one named. @throws InvalidInput naming those there are.
Kernels select_kernels(const std::string& name);

}  // namespace dmf::engine
