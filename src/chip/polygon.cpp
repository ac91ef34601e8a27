#include "chip/polygon.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/ring.hpp>
#include <cmath>
#include <limits>

namespace dmf::chip {

namespace geometry = boost::geometry;

namespace {

using Point = geometry::model::d2::point_xy<double>;
constexpr bool kClockwise = false;
constexpr bool kClosed = false;
using Ring = geometry::model::ring<Point, kClockwise, kClosed>;

Ring ring(const Polygon& polygon) {
  Ring ring;
  for (const auto& corner : polygon) ring.emplace_back(corner.x(), corner.y());
  return ring;
}

}  // namespace

std::string polygon_fault(const Polygon& polygon) {
  if (polygon.size() < 3) return fmt::format("{} corners, allowed: 3 or more", polygon.size());
  for (const auto& corner : polygon) {
    if (!corner.allFinite()) return "a corner that is not finite";
  }
  std::string reason;
  if (!geometry::is_valid(ring(counter_clockwise(polygon)), reason)) {
    return fmt::format("not a simple polygon ({})", reason);
  }
  return "";
}

Polygon counter_clockwise(Polygon polygon) {
  // The area of a ring that is declared counter-clockwise is negative when it runs clockwise.
  if (geometry::area(ring(polygon)) < 0) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

double area(const Polygon& polygon) { return geometry::area(ring(polygon)); }

Eigen::Vector2d centroid(const Polygon& polygon) {
  Point centre(0, 0);
  geometry::centroid(ring(polygon), centre);
  return {centre.x(), centre.y()};
}

Eigen::AlignedBox2d bounding_box(const Polygon& polygon) {
  Eigen::AlignedBox2d box;
  for (const auto& corner : polygon) box.extend(corner);
  return box;
}

double shared_area(const Polygon& a, const Polygon& b) {
  if (!bounding_box(a).intersects(bounding_box(b))) return 0;
  std::vector<Ring> shared;
  geometry::intersection(ring(a), ring(b), shared);
  double area = 0;
  for (const Ring& part : shared) area += geometry::area(part);
  return area;
}

double distance(const Polygon& a, const Polygon& b) { return geometry::distance(ring(a), ring(b)); }

double distance(const Eigen::Vector2d& point, const Polygon& polygon) {
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = false;
  for (std::size_t i = 0, last = polygon.size() - 1; i < polygon.size(); last = i++) {
    const Eigen::Vector2d edge = polygon[i] - polygon[last];
    const Eigen::Vector2d from = point - polygon[last];
    const double along = std::clamp(from.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (from - along * edge).squaredNorm());
    // A ray to +x changes sides at every edge that it crosses.
    if ((polygon[i].y() > point.y()) != (polygon[last].y() > point.y())) {
      const double side = edge.x() * from.y() - edge.y() * from.x();
      if ((side > 0) == (edge.y() > 0)) inside = !inside;
    }
  }
  return inside ? 0 : std::sqrt(nearest);
}

}  // namespace dmf::chip
