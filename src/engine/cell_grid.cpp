#include "engine/cell_grid.h"

namespace dmf::engine {

void CellGrid::lay(const Domain& domain, const Eigen::Vector3f& lower, const Eigen::Vector3f& upper,
                   double range) {
  for (int axis = 0; axis < 3; ++axis) {
    const double from = domain.periodic(axis) ? domain.lower[axis] : lower[axis];
    const double to = domain.periodic(axis) ? domain.upper[axis] : upper[axis];
    cells[axis] = std::max(1, static_cast<int>((to - from) / range));
    // The hair more than the range keeps float rounding from hiding a neighbour two cells away.
    const double edge = std::max((to - from) / cells[axis], range * (1 + 1e-5));
    origin[axis] = static_cast<float>(from);
    inverse_edge[axis] = static_cast<float>(1.0 / edge);
  }
}

void CellGrid::sort(const Record* positions, std::size_t count, std::vector<std::uint32_t>& order) {
  cell_of_bead_.resize(count);
  order.resize(count);
  first.assign(cell_count() + 1, 0);
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < count; ++i) {
    const Record& p = positions[i];
    cell_of_bead_[i] = static_cast<std::uint32_t>(cell_of(p.x, p.y, p.z));
  }
  for (std::size_t i = 0; i < count; ++i) ++first[cell_of_bead_[i] + 1];
  for (std::size_t cell = 0; cell < cell_count(); ++cell) first[cell + 1] += first[cell];
  // Placing from the back turns first[c + 1] (end of c) into the running place without a second array.
  for (std::size_t i = count; i-- > 0;) order[--first[cell_of_bead_[i] + 1]] = static_cast<std::uint32_t>(i);
  for (std::size_t cell = 0; cell < cell_count(); ++cell) first[cell] = first[cell + 1];
  first[cell_count()] = static_cast<std::uint32_t>(count);
}

PeriodicImages::PeriodicImages(const Eigen::Vector3f& period) {
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) shifts_[index(x, y, z)] = period.cwiseProduct(Eigen::Vector3f(x, y, z));
}

namespace {

/// Cells [begin, end) along one axis, seen `image` periods away.
struct AxisSpan {
  int begin, end, image;
};

/// The cells along an axis that meet lower..upper, folded into the grid: up to three spans.
int spans_between(const CellGrid& grid, const Domain& domain, int axis, float lower, float upper,
                  AxisSpan* spans) {
  if (!domain.periodic(axis)) {
    spans[0] = {grid.coordinate(axis, lower), grid.coordinate(axis, upper) + 1, 0};
    return 1;
  }
  const int n = grid.cells[axis];
  const int begin = grid.unbounded_coordinate(axis, lower), end = grid.unbounded_coordinate(axis, upper) + 1;
  int count = 0;
  for (int image = -1; image <= 1; ++image) {
    const AxisSpan span{std::max(begin - image * n, 0), std::min(end - image * n, n), image};
    if (span.begin < span.end) spans[count++] = span;
  }
  return count;
}

}  // namespace

void append_runs(const CellGrid& grid, const Domain& domain, const Eigen::Vector3f& lower,
                 const Eigen::Vector3f& upper, std::vector<BeadRun>& runs) {
  AxisSpan along_x[3], along_y[3], along_z[3];
  const int nx = spans_between(grid, domain, 0, lower.x(), upper.x(), along_x);
  const int ny = spans_between(grid, domain, 1, lower.y(), upper.y(), along_y);
  const int nz = spans_between(grid, domain, 2, lower.z(), upper.z(), along_z);
  for (int kz = 0; kz < nz; ++kz)
    for (int z = along_z[kz].begin; z < along_z[kz].end; ++z)
      for (int ky = 0; ky < ny; ++ky)
        for (int y = along_y[ky].begin; y < along_y[ky].end; ++y)
          for (int kx = 0; kx < nx; ++kx) {
            const std::size_t row = (static_cast<std::size_t>(z) * grid.cells[1] + y) * grid.cells[0];
            const std::uint32_t begin = grid.first[row + along_x[kx].begin];
            const std::uint32_t end = grid.first[row + along_x[kx].end];
            if (begin == end) continue;
            runs.push_back(
                {begin, end, PeriodicImages::index(along_x[kx].image, along_y[ky].image, along_z[kz].image)});
          }
}

}  // namespace dmf::engine
