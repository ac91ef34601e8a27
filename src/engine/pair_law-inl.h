// Force laws of a pair, written once for double, float and lanes. Compiled per instruction set, hence no
// `#pragma once`.
#if defined(DMF_ENGINE_PAIR_LAW_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DMF_ENGINE_PAIR_LAW_INL_H
#undef DMF_ENGINE_PAIR_LAW_INL_H
#else
#define DMF_ENGINE_PAIR_LAW_INL_H
#endif

#include <hwy/highway.h>

#include "engine/kernels/lanes-inl.h"
#include "engine/pair_law.h"

HWY_BEFORE_NAMESPACE();
namespace dmf::engine::HWY_NAMESPACE {

/// Shape of the density weight, Lan (2.38) with the exponent corrected to 2 (only then its integral is 1;
/// Warren 2003): omega(r) = 15 / (2 pi r_d^3) (1 - r/r_d)^2 for r < r_d. The prefactor is applied once per
/// bead, to the sum.
template <class Real>
HWY_INLINE Real density_weight(Real r, Real inverse_repulsion_radius) {
  const Real w = maximum(Real(1) - r * inverse_repulsion_radius, Real(0));
  return w * w;
}

/// Conservative part of mdpd_force, Lan (2.36): A w_c + B (rho_i + rho_j) w_d, for r < r_c.
template <class Real>
HWY_INLINE Real conservative_force(const MdpdLaw<Real>& law, Real attraction, Real r, Real density_sum) {
  const Real w_c = Real(1) - r * law.inverse_cutoff_radius;
  const Real w_d = maximum(Real(1) - r * law.inverse_repulsion_radius, Real(0));
  return w_c * attraction + law.repulsion * density_sum * w_d;
}

/// Force on bead i along e = (r_i - r_j)/r, for r < r_c. Lan (2.36) conservative, (2.5), (2.6) dissipative
/// and random with s = 2:
///
///   A w_c + B (rho_i + rho_j) w_d  -  gamma w_c^2 (e . v_ij)  +  phi w_c zeta_ij / sqrt(dt)
///   w_c = 1 - r/r_c,   w_d = max(0, 1 - r/r_d),   A < 0 attracts, B > 0 repels
///
/// Friction and noise share the factor w_c with the attraction: they stand as additions to it.
///
/// @param attraction    A_ij
/// @param density_sum   rho_i + rho_j (walls count nothing and are not counted: rho_wall = 0)
/// @param approach      e . v_ij, positive while the beads part
/// @param zeta          pair noise, zero mean, unit variance
template <class Real>
HWY_INLINE Real mdpd_force(const MdpdLaw<Real>& law, Real attraction, Real r, Real density_sum, Real approach,
                           Real zeta) {
  const Real w_c = Real(1) - r * law.inverse_cutoff_radius;
  const Real random = law.random_amplitude * zeta;
  const Real dissipative = law.friction * w_c * approach;
  return conservative_force(law, attraction + random - dissipative, r, density_sum);
}

/// Conservative force at any r: the attraction ends at r_c, the friction may not.
template <class Real>
HWY_INLINE Real conservative_force_anywhere(const MdpdLaw<Real>& law, Real attraction, Real r,
                                            Real density_sum) {
  const Real w_c = maximum(Real(1) - r * law.inverse_cutoff_radius, Real(0));
  const Real w_d = maximum(Real(1) - r * law.inverse_repulsion_radius, Real(0));
  return w_c * attraction + law.repulsion * density_sum * w_d;
}

/// -dW/du of the cubic spline of Liu (18) with u = 2 r / r_c. Both of its pieces in one:
///
///   W = (2 - u)^3 / 4 - (1 - u)^3,   a bracket that is negative counts as 0
///
/// which for u < 1 is his 1 - 3/2 u^2 + 3/4 u^3.
template <class Real>
HWY_INLINE Real spline_slope(Real u) {
  const Real outer = maximum(Real(2) - u, Real(0));
  const Real inner = maximum(Real(1) - u, Real(0));
  return Real(0.75f) * (outer * outer) - Real(3) * (inner * inner);
}

/// Liu (19), (20): a_ij (A W'(r, r_c1) - B W'(r, r_c2)), at any r. No density enters.
template <class Real>
HWY_INLINE Real conservative_force_anywhere(const SplineLaw<Real>& law, Real strength, Real r,
                                            Real /*density_sum*/) {
  const SplineShape<Real>& shape = law.shape;
  return strength * (shape.repulsion * spline_slope(r * shape.repulsion_rate) -
                     shape.attraction * spline_slope(r * shape.attraction_rate));
}

/// w_R = (1 - r/r_D)^(s/2), 0 beyond r_D. Powers of fourth roots: exact roots and products are the same bits
/// on every processor, a library's pow is not.
template <class Real>
HWY_INLINE Real random_weight(const MdpdLaw<Real>& law, Real r) {
  const Real root = square_root(square_root(maximum(Real(1) - r * law.inverse_dissipation_radius, Real(0))));
  Real weight = root;
  for (int k = 1; k < law.twice_dissipation_exponent; ++k) weight = weight * root;
  return weight;
}

/// pair_force() with a weight of friction and noise of its own; for any r.
template <PairForce part, class Law, class Real>
HWY_INLINE Real weighted_force(const Law& law, Real attraction, Real r, Real density_sum, Real approach,
                               Real zeta) {
  if constexpr (part == PairForce::conservative) {
    return conservative_force_anywhere(law, attraction, r, density_sum);
  } else {
    const Real w_r = random_weight(law, r);
    const Real random = w_r * (law.random_amplitude * zeta);
    const Real friction = Real(0) - w_r * w_r * (law.friction * approach);
    if constexpr (part == PairForce::random)
      return random;
    else if constexpr (part == PairForce::friction)
      return friction;
    else
      return conservative_force_anywhere(law, attraction, r, density_sum) + random + friction;
  }
}

/// One part of mdpd_force, or all of it. What a part does not use costs nothing: the compiler leaves it out.
template <PairForce part, DissipativeWeight weight, class Real>
HWY_INLINE Real pair_force(const MdpdLaw<Real>& law, Real attraction, Real r, Real density_sum, Real approach,
                           Real zeta) {
  if constexpr (weight == DissipativeWeight::power)
    return weighted_force<part>(law, attraction, r, density_sum, approach, zeta);
  const Real w_c = Real(1) - r * law.inverse_cutoff_radius;
  if constexpr (part == PairForce::conservative)
    return conservative_force(law, attraction, r, density_sum);
  else if constexpr (part == PairForce::random)
    return w_c * (law.random_amplitude * zeta);
  else if constexpr (part == PairForce::friction)
    return w_c * (Real(0) - law.friction * w_c * approach);
  else
    return mdpd_force(law, attraction, r, density_sum, approach, zeta);
}

/// The same with Liu's conservative force.
template <PairForce part, DissipativeWeight weight, class Real>
HWY_INLINE Real pair_force(const SplineLaw<Real>& law, Real strength, Real r, Real density_sum, Real approach,
                           Real zeta) {
  return weighted_force<part>(law, strength, r, density_sum, approach, zeta);
}

}  // namespace dmf::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
