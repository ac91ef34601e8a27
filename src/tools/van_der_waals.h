#pragma once
#include <vector>

namespace dmf::tools {

/// p = rho k_BT / (1 - b rho) - a rho^2 (Liu eq. 25), reduced units.
struct VanDerWaals {
  double attraction;       ///< a, k_BT r_c^3
  double excluded_volume;  ///< b, r_c^3; [0, 1 / largest density)
  double residual;         ///< root mean square of what the fit leaves of the pressures, k_BT / r_c^3

  double pressure(double density, double temperature) const;
};

/// Least squares over measured pressures at several densities. @throws std::invalid_argument below three of
/// them, or when they differ in number.
VanDerWaals fit_van_der_waals(const std::vector<double>& densities, const std::vector<double>& pressures,
                              double temperature);

}  // namespace dmf::tools
