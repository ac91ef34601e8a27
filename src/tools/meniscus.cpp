#include "tools/meniscus.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "yaml/units.h"

namespace dmf::tools {
namespace {

constexpr double bin = 0.5;               ///< both ways, r_c
constexpr double nearest_to_walls = 1.5;  ///< of the rows that are fitted, r_c
constexpr double steepest = 0.999;        ///< sine of the slope of an arc that is being fitted

}  // namespace

double MeniscusArc::angle(double half_gap) const {
  return std::acos(std::clamp(-curvature * half_gap, -1.0, 1.0)) / degree;
}

std::optional<MeniscusArc> fit_arc(const std::vector<MeniscusPoint>& points) {
  if (points.size() < 5) return std::nullopt;
  double farthest = 0;
  for (const MeniscusPoint& point : points) farthest = std::max(farthest, std::abs(point.h));
  const double most = steepest / std::max(farthest, 1e-9);
  MeniscusArc arc{0, 0};
  for (const MeniscusPoint& point : points) arc.place += point.s / static_cast<double>(points.size());
  for (int iteration = 0; iteration < 100; ++iteration) {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (const MeniscusPoint& point : points) {
      const double h2 = point.h * point.h, slope = std::sqrt(1 - arc.curvature * arc.curvature * h2);
      const Eigen::Vector2d gradient(1, -h2 / (slope * (1 + slope)));
      const double left = point.s - (arc.place - arc.curvature * h2 / (1 + slope));
      normal += gradient * gradient.transpose();
      right += gradient * left;
    }
    const Eigen::Vector2d change = normal.ldlt().solve(right);
    if (!change.allFinite()) return std::nullopt;
    const double curvature = std::clamp(arc.curvature + change[1], -most, most);
    const double moved = std::abs(curvature - arc.curvature) * farthest + std::abs(change[0]);
    arc = {arc.place + change[0], curvature};
    if (moved < 1e-10) break;
  }
  return arc;
}

MeniscusProfile::MeniscusProfile(double reach, double half_gap)
    : half_gap_(half_gap),
      columns_(static_cast<int>(std::ceil(reach / bin))),
      rows_(static_cast<int>(std::ceil(half_gap / bin))),
      inner_(static_cast<std::size_t>(columns_) * rows_),
      all_(inner_) {}

void MeniscusProfile::add(double s, double h, bool inner) {
  const int column = static_cast<int>(std::floor(s / bin)), row = static_cast<int>(std::abs(h) / bin);
  if (column < 0 || column >= columns_ || row >= rows_) return;
  const std::size_t cell = static_cast<std::size_t>(row) * columns_ + column;
  inner_[cell] += inner;
  all_[cell] += 1;
}

std::vector<MeniscusPoint> MeniscusProfile::points() const {
  std::vector<MeniscusPoint> points;
  for (int row = 0; (row + 1) * bin <= half_gap_ - nearest_to_walls; ++row) {
    const auto share = [&](int column) {
      const std::size_t cell = static_cast<std::size_t>(row) * columns_ + column;
      return all_[cell] > 0 ? inner_[cell] / all_[cell] : 0;
    };
    for (int column = columns_ - 2; column >= 0; --column) {
      const double inside = share(column), outside = share(column + 1);
      if (inside < 0.5 || outside >= 0.5) continue;
      points.push_back({(column + 0.5 + (inside - 0.5) / (inside - outside)) * bin, (row + 0.5) * bin});
      break;
    }
  }
  return points;
}

}  // namespace dmf::tools
