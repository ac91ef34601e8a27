#include "engine/pairs.h"

#include <algorithm>
#include <cmath>

namespace dmf::engine {
namespace {

/// Beads a block: small enough to balance threads, large enough to amortise its arrays.
constexpr std::uint32_t block_size = 256;
/// Slack behind x, y, z: the list build reads whole lanes.
constexpr std::size_t slack = 64;

float wrapped(float position, double lower, double period) {
  return static_cast<float>(position - period * std::floor((position - lower) / period));
}

}  // namespace

Pairs::Pairs(const Parameters& parameters)
    : domain_(parameters.domain),
      range_(parameters.liquid.cutoff_radius + parameters.list_skin),
      squared_half_skin_(static_cast<float>(0.25 * parameters.list_skin * parameters.list_skin)) {}

void Pairs::rebuild(Beads& beads, const PlaneWall& wall, const Kernels& kernels) {
  const std::size_t count = beads.size();
  Eigen::Vector3f lower = domain_.lower.cast<float>(), upper = domain_.upper.cast<float>();
  if (count > 0) lower.setConstant(1e30f), upper.setConstant(-1e30f);
  for (Record& p : beads.position) {
    if (domain_.periodic(0)) p.x = wrapped(p.x, domain_.lower.x(), domain_.size().x());
    if (domain_.periodic(1)) p.y = wrapped(p.y, domain_.lower.y(), domain_.size().y());
    if (domain_.periodic(2)) p.z = wrapped(p.z, domain_.lower.z(), domain_.size().z());
    const Eigen::Vector3f position(p.x, p.y, p.z);
    lower = lower.cwiseMin(position);
    upper = upper.cwiseMax(position);
  }
  grid_.lay(domain_, lower, upper, range_);
  grid_.sort(beads.position.data(), count, order_);
  beads.reorder(order_);
  beads.listed = beads.position;
  list_neighbours(beads, wall, kernels);
  ++builds_;
}

void Pairs::restore(Beads& beads, const PlaneWall& wall, const Kernels& kernels) {
  // `listed` is sorted already; sorting it again is the identity, and gives the grid back.
  Eigen::Vector3f lower = domain_.lower.cast<float>(), upper = domain_.upper.cast<float>();
  if (beads.size() > 0) lower.setConstant(1e30f), upper.setConstant(-1e30f);
  for (const Record& p : beads.listed) {
    lower = lower.cwiseMin(Eigen::Vector3f(p.x, p.y, p.z));
    upper = upper.cwiseMax(Eigen::Vector3f(p.x, p.y, p.z));
  }
  grid_.lay(domain_, lower, upper, range_);
  grid_.sort(beads.listed.data(), beads.size(), order_);
  list_neighbours(beads, wall, kernels);
}

void Pairs::list_neighbours(Beads& beads, const PlaneWall& wall, const Kernels& kernels) {
  const std::size_t count = beads.size();
  for (AlignedVector<float>* coordinate : {&x_, &y_, &z_}) coordinate->resize(count + slack);
  for (std::size_t i = 0; i < count; ++i) {
    x_[i] = beads.listed[i].x;
    y_[i] = beads.listed[i].y;
    z_[i] = beads.listed[i].z;
  }
  blocks_.resize((count + block_size - 1) / block_size);
  const float wall_reach =
      wall.size() > 0 ? static_cast<float>(wall.plane() + range_) : -std::numeric_limits<float>::infinity();
  const ListPass pass{x_.data(),       y_.data(),       z_.data(),    &grid_,   wall.x().data(),
                      wall.y().data(), wall.z().data(), &wall.grid(), &domain_, static_cast<float>(range_),
                      wall_reach};
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    blocks_[b].begin = static_cast<std::uint32_t>(b * block_size);
    blocks_[b].end = static_cast<std::uint32_t>(std::min(count, (b + 1) * block_size));
    kernels.list(pass, blocks_[b]);
  }
  stale_ = false;
}

std::size_t Pairs::memory_bytes() const {
  std::size_t bytes = (x_.capacity() + y_.capacity() + z_.capacity()) * sizeof(float) +
                      order_.capacity() * 4 + grid_.first.capacity() * 4;
  for (const NeighbourBlock& block : blocks_)
    bytes += block.rows.capacity() * sizeof(NeighbourRow) +
             (block.liquid.capacity() + block.in_range.capacity() + block.wall.capacity()) * 4;
  return bytes;
}

}  // namespace dmf::engine
