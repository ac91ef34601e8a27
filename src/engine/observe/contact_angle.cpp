#include "engine/observe/contact_angle.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "yaml/units.h"

namespace dmf::engine {
namespace {

/// Rows below this height are left out of the fit: the liquid is layered there.
constexpr double lowest_fitted = 1.5;
/// Samples, after forgetting, below which no angle is reported.
constexpr double fewest_samples = 10;
constexpr double reach = 24, reach_up = 32;  ///< of RunningAngles, r_c

}  // namespace

DensityProfile::DensityProfile(double lower_s, double upper_s, double height)
    : lower_s_(lower_s),
      columns_(static_cast<int>(std::ceil((upper_s - lower_s) / bin))),
      rows_(static_cast<int>(std::ceil(height / bin))),
      counts_(static_cast<std::size_t>(columns_) * rows_, 0.0) {}

void DensityProfile::clear() {
  std::fill(counts_.begin(), counts_.end(), 0.0);
  samples_ = 0;
}

void DensityProfile::fade(double factor) {
  for (double& count : counts_) count *= factor;
  samples_ *= factor;
}

void DensityProfile::add(double s, double z, double weight) {
  const int column = static_cast<int>(std::floor((s - lower_s_) / bin)),
            row = static_cast<int>(std::floor(z / bin));
  if (column < 0 || column >= columns_ || row < 0 || row >= rows_) return;
  counts_[static_cast<std::size_t>(row) * columns_ + column] += weight;
}

void DensityProfile::archive(Archive& archive) {
  archive(samples_);
  archive(counts_);
  if (counts_.size() != static_cast<std::size_t>(columns_) * rows_)
    throw InvalidInput("saved state: wrong profile size");
}

template <class Volume>
std::vector<Eigen::Vector2d> DensityProfile::surface(double half_density, Volume bin_volume) const {
  if (samples_ <= 0) return {};
  std::vector<double> density(counts_.size());
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      const double s = lower_s_ + (column + 0.5) * bin;
      density[static_cast<std::size_t>(row) * columns_ + column] =
          value(column, row) / (samples_ * bin_volume(s));
    }
  return half_density_contour(density, half_density);
}

std::vector<Eigen::Vector2d> DensityProfile::half_density_contour(const std::vector<double>& density,
                                                                  double half_density) const {
  std::vector<Eigen::Vector2d> points;
  const auto at = [&](int column, int row) {
    return density[static_cast<std::size_t>(row) * columns_ + column];
  };
  // Where the density falls through the half between two bin centres. Crossings along rows find the flanks,
  // along columns the top; a crossing counts where the surface is steep enough for that direction to be the
  // better one.
  const auto crossing = [&](int c0, int r0, int c1, int r1) {
    const double inside = at(c0, r0), outside = at(c1, r1);
    const double fraction = (inside - half_density) / (inside - outside);
    return Eigen::Vector2d(lower_s_ + (c0 + 0.5 + fraction * (c1 - c0)) * bin,
                           (r0 + 0.5 + fraction * (r1 - r0)) * bin);
  };
  const int first_row = static_cast<int>(lowest_fitted / bin);
  for (int row = first_row; row < rows_; ++row) {
    // Outermost crossings of the row: bubbles and stray beads inside do not count.
    for (int column = columns_ - 2; column >= 0; --column)
      if (at(column, row) >= half_density && at(column + 1, row) < half_density) {
        points.push_back(crossing(column, row, column + 1, row));
        break;
      }
    if (lower_s_ >= 0) continue;
    for (int column = 1; column < columns_; ++column)
      if (at(column, row) >= half_density && at(column - 1, row) < half_density) {
        points.push_back(crossing(column, row, column - 1, row));
        break;
      }
  }
  // Near the top the flanks' crossings thin out; those along columns take over.
  for (int column = 0; column < columns_; ++column)
    for (int row = rows_ - 2; row >= first_row; --row)
      if (at(column, row) >= half_density && at(column, row + 1) < half_density) {
        points.push_back(crossing(column, row, column, row + 1));
        break;
      }
  return points;
}

std::optional<Circle> fit_circle(const std::vector<Eigen::Vector2d>& points) {
  if (points.size() < 5) return std::nullopt;
  // Algebraic start (Kasa): s^2 + z^2 = a s + b z + c.
  Eigen::MatrixXd matrix(points.size(), 3);
  Eigen::VectorXd right(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    matrix.row(k) << points[k].x(), points[k].y(), 1.0;
    right[k] = points[k].squaredNorm();
  }
  const Eigen::Vector3d start = matrix.colPivHouseholderQr().solve(right);
  Eigen::Vector3d circle(start[0] / 2, start[1] / 2, 0);
  circle[2] = std::sqrt(std::max(1e-12, start[2] + circle.head<2>().squaredNorm()));
  for (int iteration = 0; iteration < 20; ++iteration) {
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Eigen::Vector2d arm = points[k] - circle.head<2>();
      const double distance = std::max(arm.norm(), 1e-9);
      matrix.row(k) << -arm.x() / distance, -arm.y() / distance, -1.0;
      right[k] = circle[2] - distance;
    }
    const Eigen::Vector3d change = matrix.colPivHouseholderQr().solve(right);
    circle += change;
    if (change.norm() < 1e-9 * (1 + circle.norm())) break;
  }
  if (!circle.allFinite() || circle[2] <= 0) return std::nullopt;
  return Circle{circle[0], circle[1], circle[2]};
}

double contact_angle_of(const Circle& circle) {
  return std::acos(std::clamp(-circle.z / circle.radius, -1.0, 1.0)) / degree;
}

void SessileAngle::add(const Eigen::Vector3f& from_axis_and_wall) {
  profile_.add(from_axis_and_wall.head<2>().norm(), from_axis_and_wall.z());
}

std::optional<Circle> SessileAngle::circle(double bulk_density) const {
  const double half_bin = DensityProfile::bin / 2;
  std::vector<Eigen::Vector2d> points = profile_.surface(0.5 * bulk_density, [&](double s) {
    const double inner = s - half_bin, outer = s + half_bin;
    return M_PI * (outer * outer - inner * inner) * DensityProfile::bin;
  });
  // The axis is the circle's own: mirror the points, and the fitted centre lies on it.
  const std::size_t count = points.size();
  for (std::size_t k = 0; k < count; ++k) points.emplace_back(-points[k].x(), points[k].y());
  return fit_circle(points);
}

std::optional<double> SessileAngle::angle(double bulk_density) const {
  const std::optional<Circle> fitted = circle(bulk_density);
  if (!fitted) return std::nullopt;
  return contact_angle_of(*fitted);
}

RunningAngles::RunningAngles(double thickness) : thickness_(thickness), profile_(-reach, reach, reach_up) {}

void RunningAngles::turn(const Eigen::Vector2d& way) {
  way_ = way;
  profile_.clear();
}

void RunningAngles::begin_sample(double elapsed, double window) {
  profile_.fade(window > 0 ? std::exp(-elapsed / window) : 0.0);
  profile_.count_sample();
}

void RunningAngles::add(const Eigen::Vector3d& from_centre) {
  const double across = -way_.y() * from_centre.x() + way_.x() * from_centre.y();
  if (std::abs(across) > 0.5 * thickness_) return;
  profile_.add(way_.dot(from_centre.head<2>()), from_centre.z());
}

std::optional<RunningAngles::Angles> RunningAngles::angles(double bulk_density) const {
  if (profile_.samples() < fewest_samples) return std::nullopt;
  const double volume = DensityProfile::bin * DensityProfile::bin * thickness_;
  const std::vector<Eigen::Vector2d> points =
      profile_.surface(0.5 * bulk_density, [volume](double) { return volume; });
  std::vector<Eigen::Vector2d> front, rear;
  for (const Eigen::Vector2d& point : points) (point.x() > 0 ? front : rear).push_back(point);
  const std::optional<Circle> front_circle = fit_circle(front), rear_circle = fit_circle(rear);
  if (!front_circle || !rear_circle) return std::nullopt;
  return Angles{contact_angle_of(*front_circle), contact_angle_of(*rear_circle)};
}

void RunningAngles::archive(Archive& archive) {
  double x = way_.x(), y = way_.y();
  archive(x);
  archive(y);
  way_ = {x, y};
  profile_.archive(archive);
}

}  // namespace dmf::engine
