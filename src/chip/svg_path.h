#pragma once
#include <Eigen/Geometry>
#include <string_view>

#include "chip/polygon.h"

namespace dmf::chip {

/// One closed outline from the path data (`d`) of an SVG path, corners in the path's own units, not closed.
/// All commands of SVG 1.1, section 8.3, absolute and relative. Curves become chords that stay within a
/// thousandth of the curve's size.
/// @throws engine::InvalidInput for what is no path data, numbers that are not finite, a path that is neither
/// closed by `z` nor comes back to its start, several outlines in one path, more than kMaxCorners.
Polygon closed_path(std::string_view path_data);

/// The corners of an SVG polygon's `points`. @throws engine::InvalidInput as closed_path.
Polygon polygon_points(std::string_view points);

/// The `transform` of an SVG element, SVG 1.1, section 7.6: matrix, translate, scale, rotate, skewX, skewY in
/// any number, the last one acting first.
/// @throws engine::InvalidInput for anything else.
Eigen::Affine2d svg_transform(std::string_view transform);

}  // namespace dmf::chip
