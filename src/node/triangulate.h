#pragma once
#include <Eigen/Core>
#include <vector>

namespace dmf::node {

/// Cuts a simple polygon into triangles (ear clipping, cubic in the corners: pads have few).
/// @param outline  counter-clockwise, not closed, 3 corners or more, not crossing itself.
/// @returns the triangles' corners, three by three, counter-clockwise.
std::vector<Eigen::Vector2d> triangulate(const std::vector<Eigen::Vector2d>& outline);

}  // namespace dmf::node
