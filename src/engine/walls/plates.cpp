#include "engine/walls/plates.h"

#include <fmt/format.h>

#include <cmath>

namespace dmf::engine {

Plates::Plates(const Domain& domain, const WallParameters& wall, double range, int dimensions)
    : domain_(domain) {
  if (domain.has_wall()) add_plate(wall, domain.lower.z(), -1, range, dimensions);
  if (domain.has_top_plate()) add_plate(wall, domain.upper.z(), +1, range, dimensions);
}

void Plates::add_plate(const WallParameters& wall, double plane, int outward, double range, int dimensions) {
  // Whole unit cells across the domain, so that the lattice closes on itself over a periodic side.
  const Vector3d size = domain_.size();
  const int columns = std::max(1, static_cast<int>(std::lround(size.x() / wall.lattice_constant)));
  const bool flat = dimensions == 2;
  const int rows = flat ? 1 : std::max(1, static_cast<int>(std::lround(size.y() / wall.lattice_constant)));
  const double step_x = size.x() / columns, step_y = size.y() / rows;
  AlignedVector<Record> unsorted;
  unsorted.reserve(static_cast<std::size_t>(columns) * rows * 2 * wall.layers);
  for (int layer = 0; layer < wall.layers; ++layer) {
    const double z = plane + outward * 0.5 * layer * wall.lattice_constant;
    // Two points a unit square; odd layers sit over the hollows of even ones.
    const double first_offset = layer % 2 == 0 ? 0.25 : 0.75;
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column)
        for (int basis = 0; basis < (flat ? 1 : 2); ++basis) {
          const double x =
              domain_.lower.x() + (column + (basis == 0 ? first_offset : 1.0 - first_offset)) * step_x;
          const double y = domain_.lower.y() + (row + (flat ? 0.5 : basis == 0 ? 0.25 : 0.75)) * step_y;
          unsorted.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 0.f});
        }
  }
  Plate plate{plane, static_cast<std::uint32_t>(beads_.size()), {}};
  const double thickness = 0.5 * (wall.layers - 1) * wall.lattice_constant;
  Eigen::Vector3f lower = domain_.lower.cast<float>(), upper = domain_.upper.cast<float>();
  if (outward < 0)
    lower.z() -= static_cast<float>(thickness);
  else
    upper.z() += static_cast<float>(thickness);
  plate.grid.lay(domain_, lower, upper, range);
  // One cell across the layers: a run along x then holds a whole strip of wall behind a bead.
  plate.grid.cells[2] = 1;
  std::vector<std::uint32_t> order;
  plate.grid.sort(unsorted.data(), unsorted.size(), order);
  beads_.reserve(beads_.size() + order.size());
  for (const std::uint32_t k : order) beads_.push_back(unsorted[k]);
  plates_.push_back(std::move(plate));
}

void Plates::append_runs(const Eigen::Vector3f& lower, const Eigen::Vector3f& upper,
                         std::vector<BeadRun>& runs) const {
  for (const Plate& plate : plates_) {
    if (lower.z() > plate.plane || upper.z() < plate.plane) continue;
    const std::size_t before = runs.size();
    engine::append_runs(plate.grid, domain_, lower, upper, runs);
    for (std::size_t run = before; run < runs.size(); ++run) {
      runs[run].begin += plate.first;
      runs[run].end += plate.first;
    }
  }
}

std::vector<float> Plates::attraction() const {
  std::vector<float> values;
  values.reserve(beads_.size());
  for (const Record& bead : beads_) values.push_back(bead.w);
  return values;
}

void Plates::set_attraction(const std::vector<float>& attraction) {
  if (attraction.size() != beads_.size())
    throw InvalidInput(fmt::format("wall: {} values, allowed: {}", attraction.size(), beads_.size()));
  for (std::size_t i = 0; i < beads_.size(); ++i) beads_[i].w = attraction[i];
}

void Plates::set_wettability(const ContactAngleField& field, const ContactAngleCurve& curve) {
  std::vector<float> values = attraction();
  const std::size_t count = plates_.size() > 1 ? plates_[1].first : beads_.size();
  for (std::size_t i = 0; i < count; ++i)
    values[i] = static_cast<float>(curve.attraction(field(beads_[i].x, beads_[i].y)));
  set_attraction(values);
}

void Plates::set_top_wettability(double angle, const ContactAngleCurve& curve) {
  if (plates_.size() < 2) return;
  const float attraction = static_cast<float>(curve.attraction(angle));
  for (std::size_t i = plates_[1].first; i < beads_.size(); ++i) beads_[i].w = attraction;
}

}  // namespace dmf::engine
