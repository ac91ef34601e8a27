#include "chip/electrowetting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dmf::chip {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

double cosine(double degrees) { return std::cos(degrees * kDegree); }

}  // namespace

double Electrowetting::number(double voltage) const {
  const double relative = voltage / reference_voltage;
  return relative * relative * (cosine(reference_angle) - cosine(rest_angle));
}

double Electrowetting::contact_angle(double voltage) const {
  const double wanted = std::min(cosine(rest_angle) + number(voltage), 1.0);
  // The clamp also takes away the last bit that acos(cos(theta)) may be off, so that the ends are met
  // exactly.
  return std::clamp(std::acos(wanted) / kDegree, saturation_angle, rest_angle);
}

std::vector<std::string> violations(const Electrowetting& law) {
  std::vector<std::string> found;
  const auto check = [&found](bool sound, const char* key, double value, const std::string& allowed) {
    if (!sound) found.push_back(fmt::format("{}: {}, allowed: {}", key, value, allowed));
  };
  const auto between = [](double value, double lower, double upper) {
    return value > lower && value < upper;
  };
  check(between(law.rest_angle, 0, 180), "rest_angle", law.rest_angle, "(0, 180) degrees");
  check(between(law.saturation_angle, 0, law.rest_angle), "saturation_angle", law.saturation_angle,
        fmt::format("(0, {}) degrees, below rest_angle", law.rest_angle));
  check(law.reference_angle >= law.saturation_angle && law.reference_angle < law.rest_angle,
        "reference_angle", law.reference_angle,
        fmt::format("[{}, {}) degrees, from saturation_angle to below rest_angle", law.saturation_angle,
                    law.rest_angle));
  check(law.reference_voltage > 0 && std::isfinite(law.reference_voltage), "reference_voltage",
        law.reference_voltage, "more than 0 V");
  check(law.max_voltage > 0 && std::isfinite(law.max_voltage), "max_voltage", law.max_voltage,
        "more than 0 V");
  return found;
}

}  // namespace dmf::chip
