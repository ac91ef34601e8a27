#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace dmf::engine {

/// Contact angle in degrees wanted at a point (x, y) of the wall plane, in r_c.
using ContactAngleField = std::function<double(double x, double y)>;

/// The measured relation between wall attraction A_lw and static contact angle: monotone, piecewise linear
/// between measured points. Made by `dmf_study contact_angle`, shipped in config/calibration.
class ContactAngleCurve {
 public:
  struct Point {
    double attraction;   ///< A_lw < 0
    double angle;        ///< measured static contact angle, degrees
    double uncertainty;  ///< standard error over seeds, degrees
  };

  /// @throws InvalidInput unless there are two or more points, attraction and angle both strictly increasing.
  explicit ContactAngleCurve(std::vector<Point> points);

  /// Lan's fit (2.39) with its signs corrected, sampled every degree from 40 to 150: the paper's own curve,
  /// for comparison. A(theta) = -1.211 - sqrt(552.125 - 3.30033 theta).
  static ContactAngleCurve lan2016();

  /// Reads a calibration file: YAML with `points: [[attraction, angle, uncertainty], ...]`.
  /// @throws InvalidInput with file and line.
  static ContactAngleCurve load(const std::string& file);
  /// Same from text; `name` stands for the file in messages.
  static ContactAngleCurve parse(const std::string& text, const std::string& name);

  /// A_lw that shows `angle` degrees. @throws InvalidInput outside [min_angle, max_angle].
  double attraction(double angle) const;
  /// Angle that A_lw shows, clamped to the measured range.
  double angle(double attraction) const;
  double min_angle() const { return points_.front().angle; }
  double max_angle() const { return points_.back().angle; }
  const std::vector<Point>& points() const { return points_; }

 private:
  std::vector<Point> points_;  ///< by rising angle, so by rising attraction (towards 0)
};

}  // namespace dmf::engine
