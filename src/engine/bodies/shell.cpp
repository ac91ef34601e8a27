#include "engine/bodies/shell.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace dmf::engine {
namespace {

using Eigen::Vector3d;

/// Faces and corners of an icosahedron, faces seen from outside counter-clockwise.
struct Icosahedron {
  std::array<Vector3d, 12> corners;
  std::vector<std::array<int, 3>> faces;

  Icosahedron() {
    const double golden = 0.5 * (1.0 + std::sqrt(5.0));
    int corner = 0;
    for (const double one : {-1.0, 1.0})
      for (const double phi : {-golden, golden}) {
        corners[corner++] = Vector3d(0, one, phi).normalized();
        corners[corner++] = Vector3d(one, phi, 0).normalized();
        corners[corner++] = Vector3d(phi, 0, one).normalized();
      }
    // Corners that share an edge are closest: 2 / sqrt(golden sqrt(5)) = 1.05 on the unit sphere.
    const auto adjacent = [this](int a, int b) { return (corners[a] - corners[b]).norm() < 1.2; };
    for (int a = 0; a < 12; ++a)
      for (int b = a + 1; b < 12; ++b)
        for (int c = b + 1; c < 12; ++c) {
          if (!adjacent(a, b) || !adjacent(b, c) || !adjacent(a, c)) continue;
          const bool outward = corners[a].dot(corners[b].cross(corners[c])) > 0;
          faces.push_back(outward ? std::array<int, 3>{a, b, c} : std::array<int, 3>{a, c, b});
        }
  }
};

/// h >= k with 10 (h^2 + h k + k^2) + 2 == beads; h < 0 when there are none.
std::array<int, 2> steps_of(std::uint32_t beads) {
  if (beads < 12 || (beads - 2) % 10 != 0) return {-1, -1};
  const int triangulation = static_cast<int>((beads - 2) / 10);
  for (int k = 0; 3 * k * k <= triangulation; ++k)
    for (int h = k; h * h + h * k + k * k <= triangulation; ++h)
      if (h * h + h * k + k * k == triangulation) return {h, k};
  return {-1, -1};
}

/// The triangular lattice laid over each face so that its corners are h steps and, after a left turn, k steps
/// apart.
std::vector<Vector3d> divided_icosahedron(int h, int k) {
  const Icosahedron solid;
  const int triangulation = h * h + h * k + k * k;
  std::vector<Vector3d> points;
  const double same = 1e-3 / std::sqrt(triangulation);
  for (const auto& face : solid.faces)
    // In the basis of the two steps the corners of a face are (0, 0), (h, k) and (-k, h + k).
    for (int i = -k; i <= h; ++i)
      for (int j = 0; j <= h + k; ++j) {
        const int towards_second = i * (h + k) + j * k, towards_third = j * h - i * k;
        const int towards_first = triangulation - towards_second - towards_third;
        if (towards_first < 0 || towards_second < 0 || towards_third < 0) continue;
        const Vector3d point =
            (towards_first * solid.corners[face[0]] + towards_second * solid.corners[face[1]] +
             towards_third * solid.corners[face[2]])
                .normalized();
        const bool on_edge = towards_first == 0 || towards_second == 0 || towards_third == 0;
        const bool known = on_edge && std::any_of(points.begin(), points.end(), [&](const Vector3d& other) {
                             return (other - point).squaredNorm() < same * same;
                           });
        if (!known) points.push_back(point);
      }
  return points;
}

/// Pushes points apart along the sphere with a repulsion that falls as 1 / r^4: faces of the icosahedron are
/// denser in the middle than at the corners.
void spread(std::vector<Vector3d>& points) {
  const double spacing = std::sqrt(4 * M_PI / static_cast<double>(points.size()));
  const double reach = 4 * spacing;
  std::vector<std::vector<std::uint32_t>> near(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    for (std::uint32_t j = 0; j < points.size(); ++j)
      if (i != j && (points[i] - points[j]).squaredNorm() < reach * reach) near[i].push_back(j);
  std::vector<Vector3d> moved(points.size());
  for (int round = 0; round < 200; ++round) {
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      Vector3d push = Vector3d::Zero();
      for (const std::uint32_t j : near[i]) {
        const Vector3d d = points[i] - points[j];
        const double inverse = spacing * spacing / d.squaredNorm();
        push += inverse * inverse * d;
      }
      push -= push.dot(points[i]) * points[i];
      moved[i] = (points[i] + 0.02 * push).normalized();
    }
    points.swap(moved);
  }
}

void bisect(std::vector<Vector3d>& points, std::uint32_t begin, std::uint32_t end, std::uint32_t largest,
            std::vector<std::uint32_t>& ends) {
  if (end - begin <= largest) {
    ends.push_back(end);
    return;
  }
  Vector3d lower = points[begin], upper = lower;
  for (std::uint32_t i = begin; i < end; ++i) {
    lower = lower.cwiseMin(points[i]);
    upper = upper.cwiseMax(points[i]);
  }
  int axis = 0;
  (upper - lower).maxCoeff(&axis);
  std::stable_sort(points.begin() + begin, points.begin() + end,
                   [axis](const Vector3d& a, const Vector3d& b) { return a[axis] < b[axis]; });
  const std::uint32_t middle = begin + (end - begin) / 2;
  bisect(points, begin, middle, largest, ends);
  bisect(points, middle, end, largest, ends);
}

}  // namespace

bool is_shell_count(std::uint32_t beads) { return steps_of(beads)[0] > 0; }

std::uint32_t nearest_shell_count(double beads) {
  const double from = std::max(beads, 12.0);
  for (std::uint32_t away = 0;; ++away) {
    const std::uint32_t rounded = static_cast<std::uint32_t>(std::lround(from));
    if (rounded >= away && is_shell_count(rounded - away)) return rounded - away;
    if (is_shell_count(rounded + away)) return rounded + away;
  }
}

std::vector<Vector3d> shell_points(std::uint32_t beads) {
  assert(is_shell_count(beads));
  const auto [h, k] = steps_of(beads);
  std::vector<Vector3d> points = divided_icosahedron(h, k);
  spread(points);
  return points;
}

std::vector<Vector3d> circle_points(std::uint32_t beads) {
  assert(beads >= 3);
  // A library's sine and cosine differ in the last bit from processor to processor.
  const double angle = 2 * M_PI / beads;
  double cosine = 0, sine = 0, term = 1;
  for (int k = 0; k < 40; k += 2) {
    cosine += term;
    term *= angle / (k + 1);
    sine += term;
    term *= -angle / (k + 2);
  }
  std::vector<Vector3d> points{Vector3d::UnitX()};
  while (points.size() < beads) {
    const Vector3d& last = points.back();
    points.push_back(
        Vector3d(cosine * last.x() - sine * last.z(), 0, sine * last.x() + cosine * last.z()).normalized());
  }
  return points;
}

std::vector<std::uint32_t> order_in_patches(std::vector<Vector3d>& points, std::uint32_t largest) {
  std::vector<std::uint32_t> ends;
  bisect(points, 0, static_cast<std::uint32_t>(points.size()), largest, ends);
  return ends;
}

}  // namespace dmf::engine
