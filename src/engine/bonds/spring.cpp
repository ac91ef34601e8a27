#include "engine/bonds/spring.h"

#include <fmt/format.h>

#include <cmath>

namespace dmf::engine {
namespace {

constexpr double tiny = 1e-9;
constexpr double most_stiffness = 1e6;
constexpr double longest = 100;

}  // namespace

std::vector<std::string> violations(const Spring& spring) {
  std::vector<std::string> found;
  const auto within = [&found](const char* key, double value, double lower, double upper,
                               const char* allowed) {
    if (!(value >= lower && value <= upper))
      found.push_back(fmt::format("spring.{}: {}, allowed: {}", key, value, allowed));
  };
  if (spring.kind != SpringKind::wlc)
    within("stiffness", spring.stiffness, tiny, most_stiffness, "above 0 up to 1e6 (k_BT / r_c^2)");
  if (spring.kind == SpringKind::harmonic) {
    within("length", spring.length, 0, longest, "0 to 100 (r_c)");
  } else {
    within("max_length", spring.max_length, tiny, longest, "above 0 up to 100 (r_c)");
  }
  if (spring.kind == SpringKind::wlc)
    within("persistence_length", spring.persistence_length, tiny, 1e6, "above 0 up to 1e6 (r_c)");
  return found;
}

SpringLaw SpringLaw::of(const Spring& spring, double temperature) {
  switch (spring.kind) {
    case SpringKind::harmonic:
      return {SpringKind::harmonic, spring.stiffness, spring.length, 0};
    case SpringKind::wlc:
      return {SpringKind::wlc, temperature / (4 * spring.persistence_length), spring.max_length, 0};
    case SpringKind::fene:
      break;
  }
  return {SpringKind::fene, spring.stiffness, spring.max_length, 0};
}

SpringLaw SpringLaw::worm_like_with_repulsion(double rest, double stiffness, double max_over_rest) {
  // At rest a g = c / r^2, so the slope there is a g' / l + 2 c / r^3 = a (g' / l + 2 g / r).
  const double l = rest * max_over_rest, x = 1 / max_over_rest;
  const double g = 1 / ((1 - x) * (1 - x)) - 1 + 4 * x;
  const double slope_of_g = 2 / ((1 - x) * (1 - x) * (1 - x)) + 4;
  const double a = stiffness / (slope_of_g / l + 2 * g / rest);
  return {SpringKind::wlc, a, l, a * g * rest * rest};
}

double SpringLaw::tension(double r) const {
  if (kind == SpringKind::harmonic) return stiffness * (r - length);
  const double x = r / length;
  if (kind == SpringKind::fene) return stiffness * r / (1 - x * x);
  const double left = 1 - x;
  const double pull = stiffness * (1 / (left * left) - 1 + 4 * x);
  return repulsion > 0 ? pull - repulsion / (r * r) : pull;
}

double SpringLaw::energy(double r) const {
  if (kind == SpringKind::harmonic) return 0.5 * stiffness * (r - length) * (r - length);
  const double x = r / length;
  if (kind == SpringKind::fene) return -0.5 * stiffness * length * length * std::log1p(-x * x);
  const double stretched = stiffness * length * (1 / (1 - x) - 1 - x + 2 * x * x);
  return repulsion > 0 ? stretched + repulsion / r : stretched;
}

double SpringLaw::slope(double r) const {
  if (kind == SpringKind::harmonic) return stiffness;
  const double x = r / length;
  if (kind == SpringKind::fene) return stiffness * (1 + x * x) / ((1 - x * x) * (1 - x * x));
  const double left = 1 - x;
  const double stretched = stiffness / length * (2 / (left * left * left) + 4);
  return repulsion > 0 ? stretched + 2 * repulsion / (r * r * r) : stretched;
}

double SpringLaw::rest_length() const {
  if (kind == SpringKind::harmonic) return length;
  if (repulsion <= 0) return 0;
  double shorter = 0, longer = length;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (shorter + longer);
    (tension(middle) < 0 ? shorter : longer) = middle;
  }
  return longer;
}

double SpringLaw::reach(double most) const {
  const double rest = rest_length();
  if (kind == SpringKind::harmonic) return rest + std::sqrt(2 * most / stiffness);
  double shorter = rest, longer = length;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (shorter + longer);
    (energy(middle) - energy(rest) < most ? shorter : longer) = middle;
  }
  return shorter;
}

}  // namespace dmf::engine
