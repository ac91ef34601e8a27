#include "engine/pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

namespace dmf::engine {
namespace {

/// Fewest beads a block: few enough to balance threads, many enough to amortise its arrays.
constexpr std::uint32_t block_size = 256;

float wrapped(float position, double lower, double period) {
  return static_cast<float>(position - period * std::floor((position - lower) / period));
}

}  // namespace

Pairs::Pairs(const Parameters& parameters)
    : domain_(parameters.domain),
      range_(parameters.liquid.cutoff_radius + parameters.list_skin),
      squared_half_skin_(static_cast<float>(0.25 * parameters.list_skin * parameters.list_skin)) {}

void Pairs::lay_grid(const AlignedVector<Record>& positions) {
  float lower_x = 1e30f, lower_y = 1e30f, lower_z = 1e30f, upper_x = -1e30f, upper_y = -1e30f,
        upper_z = -1e30f;
  const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(positions.size());
#pragma omp parallel for schedule(static) reduction(min                          \
                                                    : lower_x, lower_y, lower_z) \
    reduction(max                                                                \
              : upper_x, upper_y, upper_z)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Record& p = positions[i];
    lower_x = std::min(lower_x, p.x);
    lower_y = std::min(lower_y, p.y);
    lower_z = std::min(lower_z, p.z);
    upper_x = std::max(upper_x, p.x);
    upper_y = std::max(upper_y, p.y);
    upper_z = std::max(upper_z, p.z);
  }
  if (count == 0)
    grid_.lay(domain_, domain_.lower.cast<float>(), domain_.upper.cast<float>(), range_);
  else
    grid_.lay(domain_, {lower_x, lower_y, lower_z}, {upper_x, upper_y, upper_z}, range_);
}

void Pairs::rebuild(Beads& beads, const PlaneWall& wall) {
  const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(beads.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    Record& p = beads.position[i];
    if (domain_.periodic(0)) p.x = wrapped(p.x, domain_.lower.x(), domain_.size().x());
    if (domain_.periodic(1)) p.y = wrapped(p.y, domain_.lower.y(), domain_.size().y());
    if (domain_.periodic(2)) p.z = wrapped(p.z, domain_.lower.z(), domain_.size().z());
  }
  lay_grid(beads.position);
  grid_.sort(beads.position.data(), beads.size(), order_);
  beads.reorder(order_);
  beads.listed = beads.position;
  find_neighbourhoods(beads.listed, wall);
  ++builds_;
}

void Pairs::restore(const Beads& beads, const PlaneWall& wall) {
  // `listed` is sorted already; sorting it again is the identity, and gives the grid back.
  lay_grid(beads.listed);
  grid_.sort(beads.listed.data(), beads.size(), order_);
  if (!std::is_sorted(order_.begin(), order_.end()))
    throw InvalidInput("saved state: its beads are sorted into other cells than these parameters make");
  find_neighbourhoods(beads.listed, wall);
}

void Pairs::find_neighbourhoods(const AlignedVector<Record>& listed, const PlaneWall& wall) {
  divide_into_blocks();
  std::uint32_t most = 0;
#pragma omp parallel for schedule(dynamic, 4) reduction(max : most)
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    blocks_[b].runs.reserve(10 * blocks_[b].cells.size());  // nine rows, and some in two pieces
    for (NeighbourCell& cell : blocks_[b].cells) find_runs(blocks_[b], cell, listed, wall);
    most = std::max({most, blocks_[b].slots, blocks_[b].wall_slots});
  }
  if (most > NeighbourBlock::most_slots)
    throw std::length_error(fmt::format("{} beads around one cell, allowed: {}", most,
                                        std::uint32_t{NeighbourBlock::most_slots}));
  stale_ = false;
}

void Pairs::divide_into_blocks() {
  std::size_t used = 0;
  std::uint32_t end = 0;
  for (std::size_t cell = 0; cell < grid_.cell_count(); ++cell) {
    const std::uint32_t cell_begin = grid_.first[cell], cell_end = grid_.first[cell + 1];
    if (cell_begin == cell_end) continue;
    if (used == 0 || end - blocks_[used - 1].begin >= block_size) {
      if (used == blocks_.size()) blocks_.emplace_back();
      NeighbourBlock& block = blocks_[used++];
      block.begin = cell_begin;
      block.slots = block.wall_slots = 0;
      block.cells.clear();
      block.runs.clear();
      block.wall_runs.clear();
    }
    blocks_[used - 1].cells.push_back({cell_begin, cell_end, 0, 0, 0, 0, false});
    end = blocks_[used - 1].end = cell_end;
  }
  blocks_.resize(used);
}

void Pairs::find_runs(NeighbourBlock& block, NeighbourCell& cell, const AlignedVector<Record>& listed,
                      const PlaneWall& wall) const {
  Eigen::Vector3f lower = Eigen::Vector3f::Constant(1e30f), upper = -lower;
  for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
    const Eigen::Vector3f at(listed[i].x, listed[i].y, listed[i].z);
    lower = lower.cwiseMin(at);
    upper = upper.cwiseMax(at);
  }
  lower.array() -= static_cast<float>(range_);
  upper.array() += static_cast<float>(range_);
  const auto append = [&](const CellGrid& grid, std::vector<BeadRun>& runs, std::uint32_t& slots) {
    const std::size_t before = runs.size();
    append_runs(grid, domain_, lower, upper, runs);
    std::uint32_t count = 0;
    for (std::size_t run = before; run < runs.size(); ++run) {
      count += runs[run].end - runs[run].begin;
      cell.across_periodic |= runs[run].image != PeriodicImages::here;
    }
    slots = std::max(slots, count);
    return std::make_pair(static_cast<std::uint32_t>(before), static_cast<std::uint32_t>(runs.size()));
  };
  std::tie(cell.first_run, cell.end_run) = append(grid_, block.runs, block.slots);
  if (wall.size() > 0 && lower.z() <= wall.plane())
    std::tie(cell.first_wall_run, cell.end_wall_run) = append(wall.grid(), block.wall_runs, block.wall_slots);
  block.in_range_begin.resize(block.end - block.begin + 1);
}

std::size_t Pairs::memory_bytes() const {
  std::size_t bytes = order_.capacity() * 4 + grid_.memory_bytes();
  for (const NeighbourBlock& block : blocks_)
    bytes += block.cells.capacity() * sizeof(NeighbourCell) +
             (block.runs.capacity() + block.wall_runs.capacity()) * sizeof(BeadRun) +
             block.in_range_begin.capacity() * 4 + block.in_range.capacity() * 2;
  return bytes;
}

}  // namespace dmf::engine
