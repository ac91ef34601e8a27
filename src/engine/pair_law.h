#pragma once
#include <algorithm>
#include <cmath>

#include "engine/parameters.h"

namespace dmf::engine {

/// Which of the forces of a pair a pass computes. Groot and Warren's integrator takes them all at once, BAOAB
/// each by itself.
enum class PairForce { all, conservative, random, friction };

/// How friction and noise fade with distance: w_D = w_R^2 = (1 - r/r_D)^s (Liu eq. 8).
enum class DissipativeWeight {
  shared,  ///< s = 2 and r_D = r_c: w_R is the weight of the attraction, and costs nothing
  power
};

/// Coefficients of the many-body DPD law between two species, reduced units, as the kernels use them.
/// `Real` is double, float, or lanes. B must be the same for all pairs that share a density, otherwise the
/// force has no potential (Warren 2013).
template <class Real>
struct MdpdLaw {
  Real attraction;                  ///< A, < 0; of plain DPD a >= 0
  Real repulsion;                   ///< B, >= 0
  Real inverse_cutoff_radius;       ///< 1 / r_c
  Real inverse_repulsion_radius;    ///< 1 / r_d
  Real friction;                    ///< gamma = phi^2 / (2 k_BT)
  Real random_amplitude;            ///< phi / sqrt(dt)
  Real inverse_dissipation_radius;  ///< 1 / r_D
  int twice_dissipation_exponent;   ///< 2 s

  /// How far one bead feels another, r_c.
  double range() const {
    return 1.0 / std::min(double(inverse_cutoff_radius), double(inverse_dissipation_radius));
  }
  DissipativeWeight weight() const {
    return twice_dissipation_exponent == 4 && inverse_dissipation_radius == inverse_cutoff_radius
               ? DissipativeWeight::shared
               : DissipativeWeight::power;
  }
};

/// Liu's two cubic splines (spline.h) as the kernels use them: each one's coefficient and 2 / radius.
template <class Real>
struct SplineShape {
  Real repulsion;       ///< 2 A / r_c1
  Real repulsion_rate;  ///< 2 / r_c1
  Real attraction;      ///< 2 B / r_c2
  Real attraction_rate;
};

/// The law with Liu's force in the place of the conservative one; `attraction` is its strength a_ij.
template <class Real>
struct SplineLaw : MdpdLaw<Real> {
  SplineShape<Real> shape;
};

inline SplineShape<double> spline_shape(const SplineParameters& spline) {
  const double repulsion_rate = 2.0 / spline.repulsion_radius,
               attraction_rate = 2.0 / spline.attraction_radius;
  return {spline.repulsion * repulsion_rate, repulsion_rate, spline.attraction * attraction_rate,
          attraction_rate};
}

/// The liquid's law; walls share it but for their own attraction.
inline MdpdLaw<double> liquid_law(const LiquidParameters& liquid, double time_step) {
  return {liquid.attraction,
          liquid.repulsion,
          1.0 / liquid.cutoff_radius,
          1.0 / liquid.repulsion_radius,
          liquid.random_amplitude * liquid.random_amplitude / (2.0 * liquid.temperature),
          liquid.random_amplitude / std::sqrt(time_step),
          1.0 / liquid.dissipation_radius,
          static_cast<int>(std::lround(2 * liquid.dissipation_exponent))};
}

/// Turns a sum of density_weight into a density: 15 / (2 pi r_d^3) in space (Lan 2.38), 6 / (pi r_d^2) in a
/// plane.
inline double density_normalization(double repulsion_radius, int dimensions = 3) {
  if (dimensions == 2) return 6.0 / (M_PI * repulsion_radius * repulsion_radius);
  return 15.0 / (2.0 * M_PI * repulsion_radius * repulsion_radius * repulsion_radius);
}

}  // namespace dmf::engine
