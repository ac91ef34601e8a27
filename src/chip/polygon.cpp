#include "chip/polygon.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/multi_polygon.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
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

double area(const Polygon& polygon) { return std::abs(geometry::area(ring(polygon))); }

std::vector<Polygon> drawn_in(const Polygon& polygon, double width) {
  namespace buffer = geometry::strategy::buffer;
  using Piece = geometry::model::polygon<Point, kClockwise, kClosed>;
  geometry::model::multi_polygon<Piece> pieces;
  // Mitred: the corners of a square stay corners.
  geometry::buffer(Piece{ring(counter_clockwise(polygon))}, pieces,
                   buffer::distance_symmetric<double>(-width), buffer::side_straight(), buffer::join_miter(),
                   buffer::end_flat(), buffer::point_square());
  std::vector<Polygon> outlines;
  for (const Piece& piece : pieces) {
    Polygon& outline = outlines.emplace_back();
    for (const Point& corner : piece.outer()) outline.emplace_back(corner.x(), corner.y());
  }
  return outlines;
}

std::size_t crossings(const Polygon& a, const Polygon& b) {
  const auto side = [](const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Eigen::Vector2d& of) {
    return (to.x() - from.x()) * (of.y() - from.y()) - (to.y() - from.y()) * (of.x() - from.x());
  };
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector2d &from = a[i], &to = a[(i + 1) % a.size()];
    double last = side(from, to, b.back());
    for (std::size_t j = 0; j < b.size(); ++j) {
      const double now = side(from, to, b[j]);
      const Eigen::Vector2d& before = b[(j + b.size() - 1) % b.size()];
      if (last * now < 0 && side(before, b[j], from) * side(before, b[j], to) < 0) ++count;
      last = now;
    }
  }
  return count;
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
