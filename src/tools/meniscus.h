#pragma once
#include <optional>
#include <vector>

namespace dmf::tools {

/// The surface between two liquids in a gap between parallel walls, as an arc that is symmetric to the middle
/// of the gap: s(h) = place - f(h), f = (1 - sqrt(1 - (curvature h)^2)) / curvature, with h the distance from
/// the middle. A straight one has no curvature, and no circle.
struct MeniscusArc {
  double place;      ///< s in the middle of the gap, r_c
  double curvature;  ///< 1 / r_c, positive where the inner liquid bulges out

  /// Angle in the inner liquid under which the arc meets walls that are 2 half_gap apart, degrees: cos theta
  /// = -curvature half_gap. 180 for what is too curved to reach them.
  double angle(double half_gap) const;
};

/// Least squares in s over points (s, h), by Gauss and Newton. Empty for fewer than 5 points.
struct MeniscusPoint {
  double s, h;
};
std::optional<MeniscusArc> fit_arc(const std::vector<MeniscusPoint>& points);

/// Where the inner liquid ends: collects beads of both liquids over (s, h) and finds in every row of equal h
/// the outermost place where the inner one's share of them falls through a half. Rows nearer than 1.5 r_c to
/// a wall are left out, as for droplets (engine/observe/contact_angle.h). The share and not the density of
/// one liquid: repelled by each other, both are thin where they meet, and the walls layer both.
class MeniscusProfile {
 public:
  /// @param reach  largest s; @param half_gap  of the walls, r_c.
  MeniscusProfile(double reach, double half_gap);
  void add(double s, double h, bool inner);
  std::vector<MeniscusPoint> points() const;
  std::optional<MeniscusArc> arc() const { return fit_arc(points()); }

 private:
  double half_gap_;
  int columns_, rows_;
  std::vector<double> inner_, all_;
};

}  // namespace dmf::tools
