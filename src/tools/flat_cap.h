#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace dmf::tools {

// Contact angles of droplets too flat for a circle through their surface, degrees: of the spherical cap that
// has a droplet's volume and one more length. Both measures take the liquid as a whole, layered or not.

/// Radius of the sphere that a cap of this volume and angle is cut from, V = pi R^3 (2 + cos) (1 - cos)^2
/// / 3.
double cap_sphere_radius(double volume, double angle);

/// From the radius at which the cap is so thick. With thickness 0 that of the footprint:
/// V = pi r^3 t (3 + t^2) / 6, t = tan(theta / 2). Empty when no cap of at least twice that thickness in its
/// middle reaches so far: the droplet is a film.
std::optional<double> cap_angle_of_edge(double volume, double radius, double thickness);

/// From the mean height of the liquid over the wall (Hautman and Klein 1991):
/// z = R (1 - cos) (3 + cos) / (4 (2 + cos)).
double cap_angle_of_mean_height(double volume, double mean_height);

/// Volume, thickness over the distance from the axis, and mean height of a droplet, averaged over looks.
/// The thickness is beads an area over the bulk's density.
class CapMeter {
 public:
  static constexpr double edge_thickness = 0.5;  ///< at which the edge is looked for, r_c

  /// @param reach  largest distance from the axis, r_c.
  CapMeter(double bulk_density, double reach);
  void add(const Eigen::Vector3f& from_axis_and_wall);
  void count_sample() { ++samples_; }

  double volume() const;            ///< r_c^3
  double mean_height() const;       ///< r_c
  double middle_thickness() const;  ///< within 2 r_c of the axis, r_c
  /// Outermost distance at which the droplet is as thick as edge_thickness. 0 without beads.
  double edge_radius() const;
  std::optional<double> angle_of_edge() const;
  double angle_of_mean_height() const;

 private:
  double thickness(std::size_t ring) const;

  double density_;
  std::vector<double> rings_;
  double beads_ = 0, heights_ = 0, samples_ = 0;
};

}  // namespace dmf::tools
