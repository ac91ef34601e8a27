#include "tools/flat_cap.h"

#include <algorithm>
#include <cmath>

#include "yaml/units.h"

namespace dmf::tools {
namespace {

constexpr double ring_width = 0.5;  ///< r_c
constexpr double middle = 2;        ///< r_c

double cosine(double angle) { return std::cos(angle * degree); }

/// (1 - cos theta), without the loss of digits at small angles.
double versine(double angle) { return 2 * std::pow(std::sin(0.5 * angle * degree), 2); }

/// Where a function that rises with the angle crosses 0.
template <class Function>
double root(double lower, double upper, Function function) {
  for (int k = 0; k < 100; ++k) {
    const double angle = 0.5 * (lower + upper);
    (function(angle) < 0 ? lower : upper) = angle;
  }
  return 0.5 * (lower + upper);
}

}  // namespace

double cap_sphere_radius(double volume, double angle) {
  return std::cbrt(3 * volume / (M_PI * (2 + cosine(angle)) * std::pow(versine(angle), 2)));
}

std::optional<double> cap_angle_of_edge(double volume, double radius, double thickness) {
  if (thickness <= 0) {
    // t^3 + 3 t = 6 V / (pi r^3).
    const double t = 2 * std::sinh(std::asinh(3 * volume / (M_PI * std::pow(radius, 3))) / 3);
    return 2 * std::atan(t) / degree;
  }
  const auto height = [&](double angle) { return cap_sphere_radius(volume, angle) * versine(angle); };
  // Flatter caps than this one end nearer to the axis again.
  const double flattest = root(1e-6, 180, [&](double angle) { return height(angle) - 2 * thickness; });
  const auto beyond = [&](double angle) {  // edge is nearer to the axis than asked for
    const double sphere = cap_sphere_radius(volume, angle), up = sphere * cosine(angle) + thickness;
    return radius - std::sqrt(std::max(0.0, sphere * sphere - up * up));
  };
  if (beyond(flattest) > 0) return std::nullopt;
  // A sphere that hangs over its foot is as wide as its equator where it is that thick, or above.
  return root(flattest, 180, beyond);
}

double cap_angle_of_mean_height(double volume, double mean_height) {
  return root(1e-6, 180, [&](double angle) {
    const double c = cosine(angle);
    return cap_sphere_radius(volume, angle) * versine(angle) * (3 + c) / (4 * (2 + c)) - mean_height;
  });
}

CapMeter::CapMeter(double bulk_density, double reach)
    : density_(bulk_density), rings_(static_cast<std::size_t>(std::ceil(reach / ring_width))) {}

void CapMeter::add(const Eigen::Vector3f& from_axis_and_wall) {
  const auto ring = static_cast<std::size_t>(from_axis_and_wall.head<2>().norm() / ring_width);
  if (ring < rings_.size()) rings_[ring] += 1;
  beads_ += 1;
  heights_ += from_axis_and_wall.z();
}

double CapMeter::thickness(std::size_t ring) const {
  const double area = M_PI * ring_width * ring_width * (2 * static_cast<double>(ring) + 1);
  return rings_[ring] / (samples_ * density_ * area);
}

double CapMeter::volume() const { return beads_ / (samples_ * density_); }
double CapMeter::mean_height() const { return heights_ / beads_; }

double CapMeter::middle_thickness() const {
  double beads = 0;
  for (std::size_t ring = 0; ring * ring_width < middle && ring < rings_.size(); ++ring)
    beads += rings_[ring];
  return beads / (samples_ * density_ * M_PI * middle * middle);
}

double CapMeter::edge_radius() const {
  for (std::size_t ring = rings_.size(); ring-- > 0;) {
    const double inside = thickness(ring);
    if (!(inside >= edge_thickness)) continue;
    const double outside = ring + 1 < rings_.size() ? thickness(ring + 1) : 0;
    return (static_cast<double>(ring) + 0.5 + (inside - edge_thickness) / (inside - outside)) * ring_width;
  }
  return 0;
}

std::optional<double> CapMeter::angle_of_edge() const {
  return cap_angle_of_edge(volume(), edge_radius(), edge_thickness);
}

double CapMeter::angle_of_mean_height() const { return cap_angle_of_mean_height(volume(), mean_height()); }

}  // namespace dmf::tools
