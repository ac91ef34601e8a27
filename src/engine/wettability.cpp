#include "engine/wettability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/parameters.h"
#include "engine/yaml_reader.h"

namespace dmf::engine {

ContactAngleCurve::ContactAngleCurve(std::vector<Point> points) : points_(std::move(points)) {
  if (points_.size() < 2)
    throw InvalidInput(fmt::format("calibration: {} points, allowed: 2 or more", points_.size()));
  for (std::size_t k = 1; k < points_.size(); ++k) {
    const Point &before = points_[k - 1], &after = points_[k];
    if (!(after.attraction > before.attraction && after.angle > before.angle))
      throw InvalidInput(fmt::format(
          "calibration: point {} ({}, {}) after ({}, {}), allowed: attraction and angle both rising", k,
          after.attraction, after.angle, before.attraction, before.angle));
  }
}

ContactAngleCurve ContactAngleCurve::lan2016() {
  std::vector<Point> points;
  for (int angle = 40; angle <= 150; ++angle)
    points.push_back({-1.211 - std::sqrt(552.125 - 3.30033 * angle), static_cast<double>(angle), 0.0});
  return ContactAngleCurve(std::move(points));
}

ContactAngleCurve ContactAngleCurve::load(const std::string& file) {
  return parse(YamlReader::text_of(file), file);
}

ContactAngleCurve ContactAngleCurve::parse(const std::string& text, const std::string& name) {
  const YamlReader reader = YamlReader::parse(text, name);
  reader.text("description");
  reader.text("command");
  const auto rows = reader.rows("points", Dimension::number, {}, {2}, {3, 3});
  reader.finish();
  std::vector<Point> points;
  for (const std::vector<double>& row : rows) points.push_back({row[0], row[1], row[2]});
  try {
    return ContactAngleCurve(std::move(points));
  } catch (const InvalidInput& problem) {
    throw InvalidInput(fmt::format("{}: {}", name, problem.what()));
  }
}

double ContactAngleCurve::attraction(double angle) const {
  if (!(angle >= min_angle() && angle <= max_angle()))
    throw InvalidInput(fmt::format("contact angle: {} degrees, allowed: {} to {} (the calibrated range)",
                                   angle, min_angle(), max_angle()));
  const auto after = std::lower_bound(points_.begin() + 1, points_.end() - 1, angle,
                                      [](const Point& p, double value) { return p.angle < value; });
  const auto before = after - 1;
  const double fraction = (angle - before->angle) / (after->angle - before->angle);
  return before->attraction + fraction * (after->attraction - before->attraction);
}

double ContactAngleCurve::angle(double attraction) const {
  const auto after = std::lower_bound(points_.begin() + 1, points_.end() - 1, attraction,
                                      [](const Point& p, double value) { return p.attraction < value; });
  const auto before = after - 1;
  const double fraction =
      std::clamp((attraction - before->attraction) / (after->attraction - before->attraction), 0.0, 1.0);
  return before->angle + fraction * (after->angle - before->angle);
}

}  // namespace dmf::engine
