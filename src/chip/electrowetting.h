#pragma once
#include <string>
#include <vector>

namespace dmf::chip {

/// Contact angle under voltage (Young and Lippmann) with what a real plate adds to it. With c the
/// dielectric's capacitance an area (F/m^2) and gamma the surface tension,
///
///     cos theta(V) = cos theta_0 + eta(V),   eta(V) = c (V_a^2 - V_T^2) / (2 gamma) above V_T, else 0
///     V_a^2 = V^2 / (1 + (f / f_c)^2)
///
/// and theta never falls below the saturation angle. c / (2 gamma) follows from one known point of the curve
/// at DC, or is that of a dielectric (with_dielectric()). V_T is what contact angle hysteresis costs on a
/// real plate: the simulated wall has none. f_c is where the liquid or the board no longer follows the rail's
/// frequency: a first-order roll-off of what acts. Degrees, V rms, Hz.
struct Electrowetting {
  double rest_angle = 150.0;        ///< theta_0 at 0 V, degrees; 0 < saturation_angle < rest_angle < 180
  double reference_voltage = 63.0;  ///< V rms at which the angle is reference_angle; > V_T. Lan: 63 V
  double reference_angle = 40.0;    ///< degrees; >= saturation_angle, < rest_angle. Lan: 40 degrees
  double saturation_angle = 40.0;   ///< the angle that more voltage does not lower, degrees
  double max_voltage = 80.0;        ///< the board refuses more, V rms; > 0
  double threshold_voltage = 0.0;   ///< V_T, up to which the angle stays at rest, V rms; >= 0
  double cutoff_frequency = 0.0;    ///< f_c, Hz; 0: no roll-off
  double breakdown_voltage = 0.0;   ///< a pad with more fails, V rms; 0: none does
  double charging_time = 0.0;       ///< in which eta goes 63 % of its way, tau; 0: at once

  /// Electrowetting number eta: what V adds to cos theta before saturation.
  /// @param voltage V rms, any sign (only its square acts). @param frequency Hz, 0 is DC.
  double number(double voltage, double frequency = 0) const;
  /// The number from which on more voltage does nothing.
  double saturation_number() const;
  /// At rest under the voltage, degrees.
  double contact_angle(double voltage, double frequency = 0) const;
  /// Degrees, for a number from 0 to saturation_number().
  double contact_angle_of_number(double number) const;
  /// The lowest voltage at which the number is reached, V rms.
  double voltage_of_number(double number, double frequency = 0) const;

  /// Capacitance of the dielectric under liquid, F/m^2: c = 2 gamma (cos theta_ref - cos theta_0) /
  /// (V_ref^2 - V_T^2), the law above solved for it at the reference point.
  /// @param surface_tension gamma, N/m.
  double dielectric_capacitance(double surface_tension) const;
};

/// The insulating layer on the electrodes.
struct Dielectric {
  double relative_permittivity = 0;  ///< eps_r; >= 1
  double thickness = 0;              ///< d, m; > 0

  double capacitance() const;  ///< eps_0 eps_r / d, F/m^2
};

/// Vacuum permittivity eps_0, F/m.
constexpr double kVacuumPermittivity = 8.8541878128e-12;

/// The law of a dielectric: reference_voltage is where the angle saturates, or max_voltage when that comes
/// first, and reference_angle the angle there. All else as in `law`, which must be sound and have a
/// max_voltage above its threshold_voltage.
Electrowetting with_dielectric(Electrowetting law, const Dielectric& dielectric, double surface_tension);

/// Every member that is out of its range, each as "member: value, allowed: range". Empty when the law is
/// sound.
std::vector<std::string> violations(const Electrowetting& law);

}  // namespace dmf::chip
