#include "node/triangulate.h"

#include <algorithm>

namespace dmf::node {

namespace {

using Eigen::Vector2d;

/// Twice the area of a, b, c: positive when they turn to the left.
double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

bool inside(const Vector2d& p, const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

}  // namespace

std::vector<Vector2d> triangulate(const std::vector<Vector2d>& outline) {
  std::vector<Vector2d> left = outline;
  std::vector<Vector2d> triangles;
  const auto cut = [&](std::size_t ear) {
    const std::size_t n = left.size();
    for (const Vector2d& corner : {left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]}) {
      triangles.push_back(corner);
    }
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  };
  while (left.size() > 3) {
    const std::size_t n = left.size();
    std::size_t ear = 0;
    for (; ear < n; ++ear) {
      const Vector2d &a = left[(ear + n - 1) % n], &b = left[ear], &c = left[(ear + 1) % n];
      if (turn(a, b, c) <= 0) continue;
      const bool empty = std::none_of(left.begin(), left.end(), [&](const Vector2d& p) {
        return p != a && p != b && p != c && inside(p, a, b, c);
      });
      if (empty) break;
    }
    // Only corners on one line are left without an ear: any of them can go.
    cut(ear % n);
  }
  cut(1);
  return triangles;
}

}  // namespace dmf::node
