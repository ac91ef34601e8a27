#include "engine/walls/reflection.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dmf::engine {
namespace {

/// Natural logarithm to 1e-15 from exactly rounded operations alone: a library's last bit differs between
/// processors.
double logarithm(double x) {
  int exponent;
  double mantissa = std::frexp(x, &exponent);  // [0.5, 1)
  if (mantissa < 0.70710678118654752) mantissa *= 2, --exponent;
  const double s = (mantissa - 1) / (mantissa + 1), squared = s * s;  // ln m = 2 artanh s
  double series = 0;
  for (int k = 21; k >= 1; k -= 2) series = series * squared + 1.0 / k;
  return 2 * s * series + 0.69314718055994531 * exponent;
}

/// Random numbers of one draw: a function of key, bead and draw.
class Draws {
 public:
  Draws(StepKey key, std::uint32_t id, std::uint32_t draw)
      : state_(mix64((static_cast<std::uint64_t>(key.first) << 32 | key.second) ^
                     (static_cast<std::uint64_t>(draw) << 32 | id))) {}

  /// Two of zero mean and unit variance (polar method, Marsaglia and Bray 1964).
  std::array<double, 2> gaussian_pair() {
    double x, y, squared;
    do {
      x = 2 * uniform() - 1;
      y = 2 * uniform() - 1;
      squared = x * x + y * y;
    } while (squared >= 1);
    const double scale = std::sqrt(-2 * logarithm(squared) / squared);
    return {scale * x, scale * y};
  }

 private:
  double uniform() {
    state_ += 0x9e3779b97f4a7c15ull;  // SplitMix64
    return (static_cast<double>(mix64(state_) >> 11) + 0.5) * 0x1p-53;
  }

  std::uint64_t state_;
};

/// Fraction of `way` to the plane, if it is crossed; else above 1.
float fraction_to_plane(float plane, float from, float way, bool upper) {
  const float to = from + way;
  return (upper ? to > plane : to < plane) ? (plane - from) / way : 2.f;
}

}  // namespace

Planes::Planes(const Domain& domain) {
  for (int axis = 0; axis < 3; ++axis) {
    const bool open = domain.periodic(axis);
    lower[axis] = open ? -std::numeric_limits<float>::infinity() : static_cast<float>(domain.lower[axis]);
    upper[axis] = open ? std::numeric_limits<float>::infinity() : static_cast<float>(domain.upper[axis]);
  }
}

float Planes::fraction_to(const float* from, const float* way) const {
  float fraction = 1.f;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool above : {false, true})
      fraction =
          std::min(fraction, fraction_to_plane((above ? upper : lower)[axis], from[axis], way[axis], above));
  return std::max(fraction, 0.f);
}

void BounceBack::send_back(const Flight& flight, Triple& at, Triple& moving, Triple& seen) const {
  const float travelled = 2.f * planes_.fraction_to(flight.from, flight.way) - 1.f;
  for (int axis = 0; axis < 3; ++axis) {
    at[axis] = std::clamp(flight.from[axis] + flight.way[axis] * travelled, planes_.lower[axis],
                          planes_.upper[axis]);
    moving[axis] = -moving[axis];
    seen[axis] = -seen[axis];
  }
}

Reflections::Reflections(const Parameters& parameters, std::uint64_t drift)
    : planes_(parameters.domain),
      layers_(planes_),
      temperature_(parameters.liquid.temperature),
      flat_(parameters.dimensions == 2),
      key_(step_key(parameters.seed, drift, Stream::reflection)) {
  const BoundaryParameters& boundaries = parameters.boundaries;
  const float thickness = static_cast<float>(boundaries.layer_thickness);
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      Side& side = sides_[2 * axis + upper];
      side = {(upper ? boundaries.upper_reflection : boundaries.lower_reflection)[axis], {0, 0, 0}};
      if (axis == 2) {
        const Eigen::Vector2d& velocity = upper ? boundaries.upper_velocity : boundaries.lower_velocity;
        side.velocity[0] = static_cast<float>(velocity.x());
        side.velocity[1] = static_cast<float>(velocity.y());
      }
      if (side.reflection == Reflection::thin_layer)
        (upper ? layers_.upper : layers_.lower)[axis] += upper ? -thickness : thickness;
    }
}

/// A velocity of a gas at k_BT, relative to the side. Its normal component is that of what effuses through a
/// plane, p(v) ~ v exp(-v^2 / 2 k_BT), the length of two Gaussian numbers; for beads in a thin layer, which
/// do not come through a plane, |n . v_R| (Chen eq. 12).
void Reflections::emit(std::uint32_t id, std::uint32_t draw, int axis, bool upper, Triple& velocity) const {
  Draws draws(key_, id, draw);
  const double thermal = std::sqrt(temperature_);
  const auto [a, b] = draws.gaussian_pair();
  const auto [along, across] = draws.gaussian_pair();
  const bool in_layer = side(axis, upper).reflection == Reflection::thin_layer;
  const double normal = in_layer ? std::abs(a) : std::sqrt(a * a + b * b);
  velocity[axis] = static_cast<float>(thermal * (upper ? -normal : normal));
  velocity[(axis + 1) % 3] = static_cast<float>(thermal * along);
  velocity[(axis + 2) % 3] = static_cast<float>(thermal * across);
  if (flat_) velocity[1] = 0;
  for (int k = 0; k < 3; ++k) velocity[k] += side(axis, upper).velocity[k];
}

void Reflections::send_back(const Flight& flight, Triple& at, Triple& moving, Triple& seen) const {
  constexpr std::uint32_t most_met = 6;  // sides in one drift: more than in any corner
  float from[3], way[3];
  std::copy_n(flight.from, 3, from);
  std::copy_n(flight.way, 3, way);
  float time = flight.travel;  // that the way takes
  for (std::uint32_t met = 0; met < most_met; ++met) {
    float fraction = 2.f;
    int axis = 0;
    bool upper = false;
    for (int k = 0; k < 3; ++k)
      for (const bool above : {false, true}) {
        const float here =
            fraction_to_plane((above ? planes_.upper : planes_.lower)[k], from[k], way[k], above);
        if (here < fraction) fraction = here, axis = k, upper = above;
      }
    if (fraction > 1.f) break;
    fraction = std::max(fraction, 0.f);
    for (int k = 0; k < 3; ++k) from[k] += fraction * way[k];
    from[axis] = (upper ? planes_.upper : planes_.lower)[axis];
    const float left = 1.f - fraction;
    switch (side(axis, upper).reflection) {
      case Reflection::bounce_back:
      case Reflection::bounce_forward: {
        const bool back = side(axis, upper).reflection == Reflection::bounce_back;
        for (int k = 0; k < 3; ++k) {
          const float twice = 2 * side(axis, upper).velocity[k];
          way[k] = back || k == axis ? left * (twice * time - way[k]) : left * way[k];
          moving[k] = twice - moving[k];
          seen[k] = twice - seen[k];
        }
        break;
      }
      case Reflection::specular:
      case Reflection::symmetric:
      case Reflection::frozen_particles:
        for (int k = 0; k < 3; ++k) way[k] *= k == axis ? -left : left;
        moving[axis] = -moving[axis];
        seen[axis] = -seen[axis];
        break;
      case Reflection::maxwellian:
      case Reflection::thin_layer:
        emit(flight.id, met, axis, upper, moving);
        for (int k = 0; k < 3; ++k) {
          seen[k] = moving[k];
          way[k] = left * time * moving[k];
        }
        break;
    }
    time *= left;
  }
  for (int k = 0; k < 3; ++k) at[k] = std::clamp(from[k] + way[k], planes_.lower[k], planes_.upper[k]);
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      if (side(axis, upper).reflection != Reflection::thin_layer) continue;
      if (upper ? at[axis] <= layers_.upper[axis] : at[axis] >= layers_.lower[axis]) continue;
      emit(flight.id, most_met + 2 * axis + upper, axis, upper, moving);
      std::copy_n(moving, 3, seen);
    }
}

}  // namespace dmf::engine
