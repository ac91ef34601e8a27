#include "chip/electrowetting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "yaml/units.h"

namespace dmf::chip {

namespace {

double cosine(double angle) { return std::cos(angle * degree); }

/// V_a^2 / V^2 at a frequency.
double roll_off(double frequency, double cutoff_frequency) {
  if (cutoff_frequency <= 0) return 1;
  const double relative = frequency / cutoff_frequency;
  return 1 / (1 + relative * relative);
}

}  // namespace

double Electrowetting::number(double voltage, double frequency) const {
  // In units of the reference voltage: without threshold and roll-off just the square.
  const double relative = voltage / reference_voltage;
  const double threshold = threshold_voltage / reference_voltage;
  const double acting = relative * relative * roll_off(frequency, cutoff_frequency);
  const double share = (acting - threshold * threshold) / (1 - threshold * threshold);
  return std::max(0.0, share) * (cosine(reference_angle) - cosine(rest_angle));
}

double Electrowetting::saturation_number() const { return cosine(saturation_angle) - cosine(rest_angle); }

double Electrowetting::contact_angle(double voltage, double frequency) const {
  return contact_angle_of_number(number(voltage, frequency));
}

double Electrowetting::contact_angle_of_number(double number) const {
  const double wanted = std::min(cosine(rest_angle) + number, 1.0);
  // The clamp also takes away the last bit that acos(cos(theta)) may be off, so that the ends are met
  // exactly.
  return std::clamp(std::acos(wanted) / degree, saturation_angle, rest_angle);
}

double Electrowetting::voltage_of_number(double number, double frequency) const {
  const double threshold = threshold_voltage / reference_voltage;
  const double share = number / (cosine(reference_angle) - cosine(rest_angle));
  const double acting = share * (1 - threshold * threshold) + threshold * threshold;
  return reference_voltage * std::sqrt(acting / roll_off(frequency, cutoff_frequency));
}

double Electrowetting::dielectric_capacitance(double surface_tension) const {
  return 2 * surface_tension * (cosine(reference_angle) - cosine(rest_angle)) /
         (reference_voltage * reference_voltage - threshold_voltage * threshold_voltage);
}

double Dielectric::capacitance() const { return kVacuumPermittivity * relative_permittivity / thickness; }

Electrowetting with_dielectric(Electrowetting law, const Dielectric& dielectric, double surface_tension) {
  const double number_per_square = dielectric.capacitance() / (2 * surface_tension);
  const double threshold_square = law.threshold_voltage * law.threshold_voltage;
  const double saturates = std::sqrt(threshold_square + law.saturation_number() / number_per_square);
  if (saturates <= law.max_voltage) {
    law.reference_voltage = saturates;
    law.reference_angle = law.saturation_angle;
  } else {
    law.reference_voltage = law.max_voltage;
    law.reference_angle = law.contact_angle_of_number(number_per_square *
                                                      (law.max_voltage * law.max_voltage - threshold_square));
  }
  return law;
}

std::vector<std::string> violations(const Electrowetting& law) {
  std::vector<std::string> found;
  const auto check = [&found](bool sound, const char* key, double value, const std::string& allowed) {
    if (!sound) found.push_back(fmt::format("{}: {}, allowed: {}", key, value, allowed));
  };
  const auto between = [](double value, double lower, double upper) {
    return value > lower && value < upper;
  };
  const auto at_least_0 = [](double value) { return value >= 0 && std::isfinite(value); };
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
  const double below = std::min(law.reference_voltage, law.max_voltage);
  check(law.threshold_voltage == 0 || (law.threshold_voltage > 0 && law.threshold_voltage < below),
        "threshold_voltage", law.threshold_voltage,
        fmt::format("[0, {}) V, below reference_voltage and max_voltage", below));
  check(at_least_0(law.cutoff_frequency), "cutoff_frequency", law.cutoff_frequency, "0 Hz (none) or more");
  check(at_least_0(law.breakdown_voltage), "breakdown_voltage", law.breakdown_voltage, "0 V (none) or more");
  check(at_least_0(law.charging_time), "charging_time", law.charging_time, "0 tau (at once) or more");
  return found;
}

}  // namespace dmf::chip
