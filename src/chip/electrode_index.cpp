#include "chip/electrode_index.h"

#include <algorithm>
#include <cmath>

namespace dmf::chip {

ElectrodeIndex::ElectrodeIndex(const std::vector<Eigen::AlignedBox2d>& boxes) {
  for (const auto& box : boxes) extent_.extend(box);
  if (boxes.empty()) return;
  // About four cells a box: few candidates a cell, and never more cells than a large chip can afford.
  constexpr int kMostCellsPerAxis = 512;
  const Eigen::Array2d size = extent_.sizes().array();
  const double edge = std::sqrt(size.prod() / (4.0 * static_cast<double>(boxes.size())));
  shape_ = (size / edge).ceil().min(kMostCellsPerAxis).max(1).cast<int>();
  cell_size_ = size / shape_.cast<double>();
  cells_.resize(static_cast<std::size_t>(shape_.prod()));
  for (std::uint32_t index = 0; index < boxes.size(); ++index) {
    const Eigen::Array2i first = cell_of(boxes[index].min());
    const Eigen::Array2i last = cell_of(boxes[index].max());
    for (int y = first.y(); y <= last.y(); ++y) {
      for (int x = first.x(); x <= last.x(); ++x) cells_[y * shape_.x() + x].push_back(index);
    }
  }
}

const std::vector<std::uint32_t>& ElectrodeIndex::candidates(const Eigen::Vector2d& point) const {
  if (!extent_.contains(point)) return none_;
  const Eigen::Array2i cell = cell_of(point);
  return cells_[cell.y() * shape_.x() + cell.x()];
}

Eigen::Array2i ElectrodeIndex::cell_of(const Eigen::Vector2d& point) const {
  const Eigen::Array2d scaled = (point - extent_.min()).array() / cell_size_;
  return scaled.floor().cast<int>().max(0).min(shape_ - 1);
}

}  // namespace dmf::chip
