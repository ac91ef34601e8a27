#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "engine/archive.h"

namespace dmf::engine {

/// Bead density over (s, z): s along the plate, z above the wall plane, in r_c. Two ways to fill it: around
/// the axis of a sessile droplet (s is the distance from it), or in an upright slab through a droplet (s is
/// signed).
///
/// The contact angle is measured as Lan does (2.4.2): the surface is where the density is half of the bulk's;
/// the rows next to the wall are left out, since layering bends the surface there; a circle is fitted to the
/// rest, and its slope at the wall plane is the angle.
class DensityProfile {
 public:
  static constexpr double bin = 0.5;  ///< r_c, both ways

  /// @param lower_s, upper_s, height  extent, r_c.
  DensityProfile(double lower_s, double upper_s, double height);

  void clear();
  /// Multiplies what was collected so far: exponential forgetting.
  void fade(double factor);
  void add(double s, double z, double weight = 1.0);
  /// One more look at the droplet has been added.
  void count_sample() { samples_ += 1.0; }
  double samples() const { return samples_; }

  /// Points (s, z) on the surface. @param bin_volume  r_c^3 of a bin whose centre is at s. @param
  /// half_density  beads per r_c^3.
  template <class Volume>
  std::vector<Eigen::Vector2d> surface(double half_density, Volume bin_volume) const;

  void archive(Archive& archive);

 private:
  double value(int column, int row) const {
    return counts_[static_cast<std::size_t>(row) * columns_ + column];
  }
  std::vector<Eigen::Vector2d> half_density_contour(const std::vector<double>& density,
                                                    double half_density) const;

  double lower_s_;
  int columns_, rows_;
  double samples_ = 0;
  std::vector<double> counts_;
};

struct Circle {
  double s, z, radius;
};

/// Least-squares circle: the algebraic fit refined by Gauss-Newton on the distances. Empty for fewer than 5
/// points or points without a finite circle.
std::optional<Circle> fit_circle(const std::vector<Eigen::Vector2d>& points);

/// Angle under which a circle meets z = 0, in the liquid, degrees.
double contact_angle_of(const Circle& circle);

/// Contact angle of a droplet at rest, from its profile around its own axis. Averages over directions and
/// time: this is what calibration uses.
class SessileAngle {
 public:
  /// @param radius  largest distance from the axis to look at; @param height  above the wall, r_c.
  SessileAngle(double radius, double height) : profile_(0.0, radius, height) {}
  void add(const Eigen::Vector3f& from_axis_and_wall);
  void count_sample() { profile_.count_sample(); }
  /// Degrees. Empty while there is too little to fit.
  std::optional<double> angle(double bulk_density) const;
  std::optional<Circle> circle(double bulk_density) const;

 private:
  DensityProfile profile_;
};

/// Advancing and receding angle of a droplet, with a memory of `window` tau, from an upright slab through its
/// centre along its way.
class RunningAngles {
 public:
  /// @param thickness  of the slab, r_c. The default is thick enough to collect beads, and thin enough that
  /// the surface does not curve away across it (2 % of the radius of an R = 5 droplet's footprint).
  explicit RunningAngles(double thickness = 2.0);
  /// Turns the slab to a new way; what was collected is forgotten. @param way  horizontal unit vector.
  void turn(const Eigen::Vector2d& way);
  const Eigen::Vector2d& way() const { return way_; }
  /// Forgets by exp(-elapsed/window), then counts a sample; call before the sample's beads are added.
  void begin_sample(double elapsed, double window);
  /// @param from_centre  bead relative to the droplet's centre in x and y, to the wall plane in z, r_c.
  void add(const Eigen::Vector3d& from_centre);

  struct Angles {
    double advancing, receding;  ///< degrees
  };
  std::optional<Angles> angles(double bulk_density) const;

  void archive(Archive& archive);

 private:
  double thickness_;
  Eigen::Vector2d way_{1, 0};
  DensityProfile profile_;
};

}  // namespace dmf::engine
