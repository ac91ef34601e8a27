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
  for (std::size_t i = 0; i < count; ++i) {
    const Record& p = positions[i];
    cell_of_bead_[i] = static_cast<std::uint32_t>(cell_of(p.x, p.y, p.z));
    ++first[cell_of_bead_[i] + 1];
  }
  for (std::size_t cell = 0; cell < cell_count(); ++cell) first[cell + 1] += first[cell];
  // Placing from the back turns first[c + 1] (end of c) into the running place without a second array.
  for (std::size_t i = count; i-- > 0;) order[--first[cell_of_bead_[i] + 1]] = static_cast<std::uint32_t>(i);
  for (std::size_t cell = 0; cell < cell_count(); ++cell) first[cell] = first[cell + 1];
  first[cell_count()] = static_cast<std::uint32_t>(count);
}

namespace {

struct AxisSpan {
  int begin, end;  ///< cells [begin, end)
  float shift;
};

/// Cells begin-1 .. begin+1 along one axis, folded into the grid: up to three spans.
int spans_around(const CellGrid& grid, const Domain& domain, int axis, int cell, AxisSpan* spans) {
  const int n = grid.cells[axis];
  int count = 0;
  const int begin = std::max(cell - 1, 0), end = std::min(cell + 2, n);
  if (begin < end) spans[count++] = {begin, end, 0.f};
  if (domain.periodic(axis)) {
    const float period = static_cast<float>(domain.size()[axis]);
    if (cell - 1 < 0) spans[count++] = {n - 1, n, -period};
    if (cell + 1 >= n) spans[count++] = {0, 1, period};
  }
  return count;
}

}  // namespace

bool candidate_runs(const CellGrid& grid, const Domain& domain, int x, int y, int z,
                    std::vector<CandidateRun>& runs) {
  runs.clear();
  bool shifted = false;
  AxisSpan along_x[3], along_y[3], along_z[3];
  const int nx = spans_around(grid, domain, 0, x, along_x);
  const int ny = spans_around(grid, domain, 1, y, along_y);
  const int nz = spans_around(grid, domain, 2, z, along_z);
  for (int kz = 0; kz < nz; ++kz)
    for (int iz = along_z[kz].begin; iz < along_z[kz].end; ++iz)
      for (int ky = 0; ky < ny; ++ky)
        for (int iy = along_y[ky].begin; iy < along_y[ky].end; ++iy)
          for (int kx = 0; kx < nx; ++kx) {
            const std::size_t row = (static_cast<std::size_t>(iz) * grid.cells[1] + iy) * grid.cells[0];
            const std::uint32_t begin = grid.first[row + along_x[kx].begin];
            const std::uint32_t end = grid.first[row + along_x[kx].end];
            if (begin == end) continue;
            runs.push_back({begin, end, along_x[kx].shift, along_y[ky].shift, along_z[kz].shift});
            shifted |= along_x[kx].shift != 0 || along_y[ky].shift != 0 || along_z[kz].shift != 0;
          }
  return shifted;
}

}  // namespace dmf::engine
