#pragma once
#include <cmath>

namespace dmf {

/// One degree in radians. Angles are given and published in degrees and computed with in radians.
inline constexpr double degree = M_PI / 180;

/// What one reduced unit is in SI. The only place where the two meet.
///
/// The reduced units of the engine are r_c (length), m (mass of one bead) and k_BT (energy), which fixes the
/// time unit tau = r_c sqrt(m / k_BT). A mesoscopic liquid is not water bead by bead: `tau` is chosen so that
/// the liquid's surface tension is the real one, and the energy unit follows from it.
struct Units {
  double length_m;  ///< r_c, m
  double mass_kg;   ///< mass of a bead, kg
  double time_s;    ///< tau, s

  double velocity_m_per_s() const { return length_m / time_s; }
  double acceleration_m_per_s2() const { return velocity_m_per_s() / time_s; }
  double energy_J() const { return mass_kg * velocity_m_per_s() * velocity_m_per_s(); }
  double force_N() const { return energy_J() / length_m; }
  double area_m2() const { return length_m * length_m; }
  double volume_m3() const { return length_m * length_m * length_m; }
  double surface_tension_N_per_m() const { return mass_kg / (time_s * time_s); }

  /// Units in which a liquid of the given reduced bead density and reduced surface tension has the given mass
  /// density (kg/m^3) and surface tension (N/m): m = rho r_c^3 / rho_bead, tau = sqrt(gamma_reduced m /
  /// gamma).
  static Units matching(double length_m, double density_kg_per_m3, double surface_tension_N_per_m,
                        double bead_density, double reduced_surface_tension) {
    const double mass = density_kg_per_m3 * length_m * length_m * length_m / bead_density;
    return {length_m, mass, std::sqrt(reduced_surface_tension * mass / surface_tension_N_per_m)};
  }

  /// The scaling printed in Lan's table 2.3. Its bead mass is about 4 pi / 3 too heavy for water; kept so
  /// that his SI figures can be compared with.
  static Units lan2016() { return {1.0e-5, 7.0e-13, 8.5e-6}; }
};

}  // namespace dmf
