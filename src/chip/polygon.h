#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace dmf::chip {

/// A simple polygon in the plane: corners, not closed.
using Polygon = std::vector<Eigen::Vector2d>;

/// What is wrong with a polygon's corners, empty when nothing is: fewer than 3, not finite, no area, crossing
/// itself.
std::string polygon_fault(const Polygon& polygon);
/// The same corners counter-clockwise.
Polygon counter_clockwise(Polygon polygon);
Eigen::Vector2d centroid(const Polygon& polygon);
Eigen::AlignedBox2d bounding_box(const Polygon& polygon);
/// Of a sound polygon, either way round.
double area(const Polygon& polygon);
/// What is left of a sound polygon when its edge moves inwards by a width > 0: several pieces where it is
/// narrow, none where it is narrower than twice the width.
std::vector<Polygon> drawn_in(const Polygon& polygon, double width);
/// How often the edges of two polygons cross, touching not counted.
std::size_t crossings(const Polygon& a, const Polygon& b);
/// Area that two sound polygons, both counter-clockwise, share.
double shared_area(const Polygon& a, const Polygon& b);
/// Between two sound polygons, 0 when they touch or overlap.
double distance(const Polygon& a, const Polygon& b);
/// From a point to a sound polygon, 0 inside. Once per wall bead and electrode: written for speed.
double distance(const Eigen::Vector2d& point, const Polygon& polygon);

}  // namespace dmf::chip
