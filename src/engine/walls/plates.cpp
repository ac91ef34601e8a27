#include "engine/walls/plates.h"

#include <algorithm>
#include <cmath>

namespace dmf::engine {

Plate plate_at(const Domain& domain, const WallParameters& wall, double plane, int outward, int dimensions) {
  Plate plate{plane, domain.lower, domain.upper, {}};
  // Whole unit cells across the domain, so that the lattice closes on itself over a periodic side.
  const Vector3d size = domain.size();
  const int columns = std::max(1, static_cast<int>(std::lround(size.x() / wall.lattice_constant)));
  const bool flat = dimensions == 2;
  const int rows = flat ? 1 : std::max(1, static_cast<int>(std::lround(size.y() / wall.lattice_constant)));
  const double step_x = size.x() / columns, step_y = size.y() / rows;
  plate.beads.reserve(static_cast<std::size_t>(columns) * rows * 2 * wall.layers);
  for (int layer = 0; layer < wall.layers; ++layer) {
    const double z = plane + outward * 0.5 * layer * wall.lattice_constant;
    // Two points a unit square; odd layers sit over the hollows of even ones.
    const double first_offset = layer % 2 == 0 ? 0.25 : 0.75;
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column)
        for (int basis = 0; basis < (flat ? 1 : 2); ++basis) {
          const double x =
              domain.lower.x() + (column + (basis == 0 ? first_offset : 1.0 - first_offset)) * step_x;
          const double y = domain.lower.y() + (row + (flat ? 0.5 : basis == 0 ? 0.25 : 0.75)) * step_y;
          plate.beads.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 0.f});
        }
  }
  const double thickness = 0.5 * (wall.layers - 1) * wall.lattice_constant;
  (outward < 0 ? plate.lower : plate.upper).z() += outward * thickness;
  return plate;
}

}  // namespace dmf::engine
