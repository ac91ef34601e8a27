#pragma once
#include <string>
#include <vector>

namespace dmf::chip {

/// Contact angle under voltage (Young and Lippmann): cos theta(V) = cos theta_0 + (V / V_1)^2, where V_1
/// follows from one known point of the curve, and theta never falls below the saturation angle. Degrees and V
/// rms.
struct Electrowetting {
  double rest_angle = 150.0;        ///< theta_0 at 0 V, degrees; 0 < saturation_angle < rest_angle < 180
  double reference_voltage = 63.0;  ///< V rms at which the angle is reference_angle; > 0. Lan: 63 V
  double reference_angle = 40.0;    ///< degrees; >= saturation_angle, < rest_angle. Lan: 40 degrees
  double saturation_angle = 40.0;   ///< the angle that more voltage does not lower, degrees
  double max_voltage = 80.0;        ///< the board refuses more, V rms; > 0

  /// Electrowetting number eta = eps_0 eps_r V^2 / (2 gamma d): what V adds to cos theta.
  double number(double voltage) const;
  /// @param voltage V rms, any sign (only its square acts).
  double contact_angle(double voltage) const;
};

/// Every member that is out of its range, each as "member: value, allowed: range". Empty when the law is
/// sound.
std::vector<std::string> violations(const Electrowetting& law);

}  // namespace dmf::chip
