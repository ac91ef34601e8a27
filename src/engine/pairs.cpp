#include "engine/pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace dmf::engine {
namespace {

/// Fewest beads a block: few enough to balance threads, many enough to amortise its arrays.
constexpr std::uint32_t block_size = 256;

/// A box around beads. What it holds does not depend on the order in which they came.
struct Bounds {
  Eigen::Vector3f lower = Eigen::Vector3f::Constant(1e30f), upper = -lower;

  void include(const Record& bead) {
    const Eigen::Vector3f at(bead.x, bead.y, bead.z);
    lower = lower.cwiseMin(at);
    upper = upper.cwiseMax(at);
  }
  void include(const Bounds& other) {
    lower = lower.cwiseMin(other.lower);
    upper = upper.cwiseMax(other.upper);
  }
};

Bounds bounds_of(const AlignedVector<Record>& beads, std::uint32_t begin, std::uint32_t end) {
  Bounds bounds;
  for (std::uint32_t i = begin; i < end; ++i) bounds.include(beads[i]);
  return bounds;
}

/// Throws when more beads are around a cell than slots can number.
void require_slots(std::uint32_t most) {
  if (most > NeighbourBlock::most_slots)
    throw std::length_error(fmt::format("{} beads around one cell, allowed: {}", most,
                                        std::uint32_t{NeighbourBlock::most_slots}));
}

float wrapped(float position, double lower, double period) {
  return static_cast<float>(position - period * std::floor((position - lower) / period));
}

}  // namespace

/// All patches of a microparticle or of an image of it: most cells are near none of them.
struct PatchedBody {
  std::vector<Ghosts::Patch> patches;
  Bounds bounds;

  explicit PatchedBody(std::vector<Ghosts::Patch> of) : patches(std::move(of)) {
    for (const Ghosts::Patch& patch : patches) bounds.include(Bounds{patch.lower, patch.upper});
  }
};

Pairs::Pairs(const Parameters& parameters)
    : ghosts_(parameters),
      domain_(ghosts_.search_domain()),
      range_(parameters.liquid.range() + parameters.list_skin),
      squared_half_skin_(static_cast<float>(0.25 * parameters.list_skin * parameters.list_skin)) {}

void Pairs::lay_grid(const AlignedVector<Record>& positions) {
  Bounds bounds;
#pragma omp parallel
  {
    Bounds of_thread;
#pragma omp for schedule(static)
    for (std::size_t i = 0; i < positions.size(); ++i) of_thread.include(positions[i]);
#pragma omp critical(dmf_bounds)
    bounds.include(of_thread);
  }
  if (positions.empty())
    grid_.lay(domain_, domain_.lower.cast<float>(), domain_.upper.cast<float>(), range_);
  else
    grid_.lay(domain_, bounds.lower, bounds.upper, range_);
}

void Pairs::rebuild(Beads& beads, const Walls& wall) {
  const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(beads.size());
  ghosts_.wrap(beads);
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
  ghosts_.list(beads.listed, range_, protrusion_, false);
  find_neighbourhoods(beads.listed, wall);
  ++builds_;
}

void Pairs::restore(const Beads& beads, const Walls& wall) {
  // `listed` is sorted already; sorting it again is the identity, and gives the grid back.
  lay_grid(beads.listed);
  grid_.sort(beads.listed.data(), beads.size(), order_);
  if (!std::is_sorted(order_.begin(), order_.end()))
    throw InvalidInput("saved state: its beads are sorted into other cells than these parameters make");
  ghosts_.list(beads.listed, range_, protrusion_, true);
  find_neighbourhoods(beads.listed, wall);
}

void Pairs::find_neighbourhoods(const AlignedVector<Record>& listed, const Walls& wall) {
  divide_into_blocks();
  std::uint32_t most = 0;
#pragma omp parallel for schedule(dynamic, 4) reduction(max : most)
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    blocks_[b].runs.reserve(10 * blocks_[b].cells.size());  // nine rows, and some in two pieces
    for (NeighbourCell& cell : blocks_[b].cells) find_runs(blocks_[b], cell, listed, wall);
    most = std::max({most, blocks_[b].slots, blocks_[b].wall_slots});
  }
  require_slots(most);
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
      block.slots = block.wall_slots = block.body_slots = 0;
      block.cells.clear();
      block.runs.clear();
      block.wall_runs.clear();
      block.body_runs.clear();
    }
    NeighbourCell whole{};
    whole.begin = cell_begin;
    whole.end = cell_end;
    blocks_[used - 1].cells.push_back(whole);
    end = blocks_[used - 1].end = cell_end;
  }
  blocks_.resize(used);
}

void Pairs::find_runs(NeighbourBlock& block, NeighbourCell& cell, const AlignedVector<Record>& listed,
                      const Walls& wall) const {
  Bounds around = bounds_of(listed, cell.begin, cell.end);
  around.lower.array() -= static_cast<float>(range_);
  around.upper.array() += static_cast<float>(range_);
  const auto note_new = [&](const std::vector<BeadRun>& runs, std::size_t before, std::uint32_t& slots) {
    std::uint32_t count = 0;
    for (std::size_t run = before; run < runs.size(); ++run) {
      count += runs[run].end - runs[run].begin;
      cell.across_periodic |= runs[run].image != PeriodicImages::here;
    }
    slots = std::max(slots, count);
  };
  cell.first_run = static_cast<std::uint32_t>(block.runs.size());
  append_runs(grid_, domain_, around.lower, around.upper, block.runs);
  ghosts_.append_runs(around.lower, around.upper, block.runs);
  cell.end_run = static_cast<std::uint32_t>(block.runs.size());
  note_new(block.runs, cell.first_run, block.slots);
  cell.first_wall_run = static_cast<std::uint32_t>(block.wall_runs.size());
  wall.append_runs(around.lower, around.upper, block.wall_runs);
  cell.end_wall_run = static_cast<std::uint32_t>(block.wall_runs.size());
  note_new(block.wall_runs, cell.first_wall_run, block.wall_slots);
  block.in_range_begin.resize(block.end - block.begin + 1);
}

void Pairs::find_bodies(const Microparticles& bodies, const Beads& beads, const Walls& wall) {
  forget_bodies();
  std::vector<PatchedBody> patched;
  std::uint32_t most = 0;
  for (std::size_t k = 0; k < bodies.all().size(); ++k) {
    const Microparticle& particle = bodies.all()[k];
    if (particle.placement.smooth) {
      const Eigen::Vector3f centre = particle.body.position.cast<float>();
      const float reach = static_cast<float>(particle.placement.radius + range_);
      smooth_neighbours_.push_back({k, {}, {}});
      append_runs(grid_, domain_, centre.array() - reach, centre.array() + reach,
                  smooth_neighbours_.back().liquid);
      ghosts_.append_runs(centre.array() - reach, centre.array() + reach, smooth_neighbours_.back().liquid);
      wall.append_runs(centre.array() - reach, centre.array() + reach, smooth_neighbours_.back().wall);
      continue;
    }
    std::vector<Ghosts::Patch> patches;
    std::uint32_t begin = particle.first_bead;
    for (const std::uint32_t patch_end : particle.patch_ends) {
      if (begin == particle.first_bead || begin - body_blocks_.back().begin >= block_size) {
        body_blocks_.emplace_back();
        body_blocks_.back().begin = begin;
      }
      NeighbourBlock& block = body_blocks_.back();
      NeighbourCell patch{};
      patch.begin = begin;
      patch.end = block.end = begin = particle.first_bead + patch_end;
      find_runs(block, patch, bodies.beads().listed, wall);
      most = std::max({most, block.slots, block.wall_slots});
      block.cells.push_back(patch);
      const Bounds bounds = bounds_of(bodies.beads().listed, patch.begin, patch.end);
      patches.push_back({patch.begin, patch.end, bounds.lower, bounds.upper});
    }
    for (std::vector<Ghosts::Patch>& image : ghosts_.list_body(patches, range_, bodies.beads().size()))
      patched.emplace_back(std::move(image));
    patched.emplace_back(std::move(patches));
  }
#pragma omp parallel for schedule(dynamic, 4) reduction(max : most)
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    blocks_[b].body_runs.clear();
    blocks_[b].body_slots = 0;
    for (NeighbourCell& cell : blocks_[b].cells) find_body_runs(blocks_[b], cell, beads.listed, patched);
    if (!blocks_[b].body_runs.empty()) blocks_[b].foreign_begin.resize(blocks_[b].end - blocks_[b].begin + 1);
    most = std::max(most, blocks_[b].body_slots);
  }
  for (NeighbourBlock& block : body_blocks_) block.foreign_begin.resize(block.end - block.begin + 1);
  require_slots(most);
}

void Pairs::find_body_runs(NeighbourBlock& block, NeighbourCell& cell, const AlignedVector<Record>& listed,
                           const std::vector<PatchedBody>& bodies) const {
  const Bounds of_cell = bounds_of(listed, cell.begin, cell.end);
  int image[3] = {0, 0, 0};  // of what was asked for last
  const auto in_reach = [&](const auto& other) {
    Eigen::Vector3f apart = 0.5f * (other.lower + other.upper - of_cell.lower - of_cell.upper);
    const Eigen::Vector3f reach = 0.5f * (other.upper - other.lower + of_cell.upper - of_cell.lower);
    for (int axis = 0; axis < 3; ++axis)
      if (domain_.periodic(axis)) {
        const float period = static_cast<float>(domain_.size()[axis]);
        image[axis] = -static_cast<int>(std::lround(apart[axis] / period));
        apart[axis] += static_cast<float>(image[axis]) * period;
      }
    return !((apart.cwiseAbs() - reach).array() > static_cast<float>(range_)).any();
  };
  cell.first_body_run = static_cast<std::uint32_t>(block.body_runs.size());
  std::uint32_t count = 0;
  for (const PatchedBody& body : bodies) {
    if (!in_reach(body.bounds)) continue;
    for (const Ghosts::Patch& patch : body.patches) {
      if (!in_reach(patch)) continue;
      block.body_runs.push_back(
          {patch.begin, patch.end, PeriodicImages::index(image[0], image[1], image[2])});
      count += patch.end - patch.begin;
    }
  }
  cell.end_body_run = static_cast<std::uint32_t>(block.body_runs.size());
  block.body_slots = std::max(block.body_slots, count);
}

std::size_t Pairs::memory_bytes() const {
  std::size_t bytes = order_.capacity() * 4 + grid_.memory_bytes();
  for (const NeighbourBlock& block : blocks_)
    bytes +=
        block.cells.capacity() * sizeof(NeighbourCell) +
        (block.runs.capacity() + block.wall_runs.capacity() + block.body_runs.capacity()) * sizeof(BeadRun) +
        block.in_range_begin.capacity() * 4 + block.in_range.capacity() * 2 +
        (block.foreign_begin.capacity() + block.foreign.capacity()) * 4;
  return bytes;
}

}  // namespace dmf::engine
