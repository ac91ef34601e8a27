// Noise of a pair, written once for scalars and for lanes. Compiled per instruction set, hence no `#pragma
// once`.
#if defined(DMF_ENGINE_NOISE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DMF_ENGINE_NOISE_INL_H
#undef DMF_ENGINE_NOISE_INL_H
#else
#define DMF_ENGINE_NOISE_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace dmf::engine::HWY_NAMESPACE {

/// mix32 of noise.h for any unsigned type.
template <class Unsigned>
HWY_INLINE Unsigned mix(Unsigned x) {
  x = x ^ (x >> 16);
  x = x * Unsigned(0x21f0aaadu);
  x = x ^ (x >> 15);
  x = x * Unsigned(0xd35a2d97u);
  return x ^ (x >> 15);
}

/// zeta_ij = zeta_ji: uniform, zero mean, unit variance (Groot and Warren 1997 found no difference to
/// Gaussian).
/// @param key_i, key_j  `bead_key` of both; for a wall bead `wall_key` of its index, which no step changes.
template <class Real, class Unsigned>
HWY_INLINE Real pair_noise(Unsigned key_i, Unsigned key_j) {
  constexpr float sqrt3_over_2_31 = 1.7320508075688772f / 2147483648.0f;
  return from_signed_bits<Real>(mix(key_i ^ key_j)) * Real(sqrt3_over_2_31);
}

/// Fixed key of a wall bead. The liquid bead's key carries seed and step.
template <class Unsigned>
HWY_INLINE Unsigned wall_key(Unsigned index) {
  return index * Unsigned(0x9e3779b9u) + Unsigned(0x7f4a7c15u);
}

/// Fixed key of a bead of a microparticle: as if wall beads were numbered on, from 2^31.
template <class Unsigned>
HWY_INLINE Unsigned body_key(Unsigned index) {
  return wall_key(index + Unsigned(0x80000000u));
}

/// Fixed key of a frozen particle's force on a bead: as if those of microparticles were numbered on, from
/// 3 x 2^30. @param index  3 x side + component.
template <class Unsigned>
HWY_INLINE Unsigned frozen_key(Unsigned index) {
  return wall_key(index + Unsigned(0xc0000000u));
}

}  // namespace dmf::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
