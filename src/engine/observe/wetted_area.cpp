#include "engine/observe/wetted_area.h"

#include <algorithm>
#include <cmath>

namespace dmf::engine {

namespace {

/// Liquid up to this height over the plate wets it, r_c; the tracker's footprint has the same.
constexpr double kWettingHeight = 1.0;
/// Of the bulk's density over a cell, from which it counts as wet: where the surface stands upright, that is
/// where it covers half of the cell.
constexpr double kWetShare = 0.5;

int cell_index(double position, double lower, double length, int count, bool periodic) {
  const int index = static_cast<int>(std::floor((position - lower) / length));
  // Between two sorts a bead may stand a little outside a periodic side.
  if (periodic) return (index % count + count) % count;
  return std::clamp(index, 0, count - 1);
}

}  // namespace

PlateCells::PlateCells(const Domain& domain) : lower_x(domain.lower.x()), lower_y(domain.lower.y()) {
  columns = std::max(1, static_cast<int>(std::lround(domain.size().x())));
  rows = std::max(1, static_cast<int>(std::lround(domain.size().y())));
  length_x = domain.size().x() / columns;
  length_y = domain.size().y() / rows;
}

bool WettedArea::at(int column, int row) const {
  const int i = column - first_column, j = row - first_row;
  return i >= 0 && j >= 0 && i < columns && j < rows && wet[j * columns + i];
}

WettedArea wetted_area(const Beads& beads, double plane, const Parameters& parameters) {
  const PlateCells cells(parameters.domain);
  std::vector<std::pair<int, int>> low;  // cells of the beads near the plate
  int lower_column = cells.columns, upper_column = -1, lower_row = cells.rows, upper_row = -1;
  for (std::size_t i = 0; i < beads.size(); ++i) {
    const Record& bead = beads.position[i];
    if (bead.z - plane >= kWettingHeight || beads.species_of(i) != 0) continue;
    const int column =
        cell_index(bead.x, cells.lower_x, cells.length_x, cells.columns, parameters.domain.periodic(0));
    const int row =
        cell_index(bead.y, cells.lower_y, cells.length_y, cells.rows, parameters.domain.periodic(1));
    low.emplace_back(column, row);
    lower_column = std::min(lower_column, column);
    upper_column = std::max(upper_column, column);
    lower_row = std::min(lower_row, row);
    upper_row = std::max(upper_row, row);
  }
  WettedArea area;
  if (low.empty()) return area;
  area.first_column = lower_column;
  area.first_row = lower_row;
  area.columns = upper_column - lower_column + 1;
  area.rows = upper_row - lower_row + 1;
  std::vector<std::uint32_t> counts(static_cast<std::size_t>(area.columns) * area.rows, 0);
  for (const auto& [column, row] : low) ++counts[(row - lower_row) * area.columns + column - lower_column];
  // A whole number: what lies between two of them would count as the larger one and shrink every droplet.
  const double wanted = std::max(1.0, std::round(kWetShare * parameters.liquid.bulk_density * cells.length_x *
                                                 cells.length_y * kWettingHeight));
  for (const std::uint32_t count : counts) area.wet.push_back(count >= wanted);
  return area;
}

}  // namespace dmf::engine
