#pragma once
#include <cstdint>
#include <vector>

#include "engine/beads.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// The plate in square cells of about 1 r_c^2, whole ones across the domain. They never move, so that who
/// asks for the wetted area of a place can keep which cells it consists of.
struct PlateCells {
  explicit PlateCells(const Domain& domain);

  double lower_x, lower_y;    ///< corner of cell (0, 0), r_c
  double length_x, length_y;  ///< of a cell, r_c
  int columns, rows;
};

/// Which cells of the lower plate liquid covers. Holds the cells over which there are beads at all; all
/// others are dry.
struct WettedArea {
  int first_column = 0, first_row = 0;  ///< of PlateCells
  int columns = 0, rows = 0;
  std::vector<bool> wet;  ///< row by row

  bool at(int column, int row) const;  ///< of PlateCells
};

/// Of a mixture only the first liquid wets: it is the one that conducts, and what others cover counts as the
/// filler around it. A cell is wet when the beads within 1 r_c of the plate over it are at least half as many
/// as in the bulk.
/// @param plane  z of the plate, r_c.
WettedArea wetted_area(const Beads& beads, double plane, const Parameters& parameters);

}  // namespace dmf::engine
