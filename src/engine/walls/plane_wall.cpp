#include "engine/walls/plane_wall.h"

#include <fmt/format.h>

#include <cmath>

namespace dmf::engine {

PlaneWall::PlaneWall(const Domain& domain, const WallParameters& wall, double range)
    : plane_(domain.lower.z()) {
  if (!domain.has_wall()) return;
  // Whole unit cells across the domain, so that the lattice closes on itself over a periodic side.
  const Vector3d size = domain.size();
  const int columns = std::max(1, static_cast<int>(std::lround(size.x() / wall.lattice_constant)));
  const int rows = std::max(1, static_cast<int>(std::lround(size.y() / wall.lattice_constant)));
  const double step_x = size.x() / columns, step_y = size.y() / rows;
  AlignedVector<Record> unsorted;
  unsorted.reserve(static_cast<std::size_t>(columns) * rows * 2 * wall.layers);
  for (int layer = 0; layer < wall.layers; ++layer) {
    const double z = plane_ - 0.5 * layer * wall.lattice_constant;
    // Two points a unit square; odd layers sit over the hollows of even ones.
    const double first_offset = layer % 2 == 0 ? 0.25 : 0.75;
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column)
        for (int basis = 0; basis < 2; ++basis) {
          const double x =
              domain.lower.x() + (column + (basis == 0 ? first_offset : 1.0 - first_offset)) * step_x;
          const double y = domain.lower.y() + (row + (basis == 0 ? 0.25 : 0.75)) * step_y;
          unsorted.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 0.f});
        }
  }
  const double thickness = 0.5 * (wall.layers - 1) * wall.lattice_constant;
  grid_.lay(domain, domain.lower.cast<float>() - Eigen::Vector3f(0, 0, static_cast<float>(thickness)),
            domain.upper.cast<float>(), range);
  // One cell across the layers: a run along x then holds a whole strip of wall below a bead.
  grid_.cells[2] = 1;
  std::vector<std::uint32_t> order;
  grid_.sort(unsorted.data(), unsorted.size(), order);
  for (const std::uint32_t k : order) beads_.push_back(unsorted[k]);
}

std::vector<float> PlaneWall::attraction() const {
  std::vector<float> values;
  for (const Record& bead : beads_) values.push_back(bead.w);
  return values;
}

void PlaneWall::set_attraction(const std::vector<float>& attraction) {
  if (attraction.size() != beads_.size())
    throw InvalidInput(fmt::format("wall: {} values, allowed: {}", attraction.size(), beads_.size()));
  for (std::size_t i = 0; i < beads_.size(); ++i) beads_[i].w = attraction[i];
}

void PlaneWall::set_wettability(const ContactAngleField& field, const ContactAngleCurve& curve) {
  std::vector<float> values;
  for (const Record& bead : beads_)
    values.push_back(static_cast<float>(curve.attraction(field(bead.x, bead.y))));
  set_attraction(values);
}

}  // namespace dmf::engine
