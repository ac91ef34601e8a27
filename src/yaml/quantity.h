#pragma once
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "yaml/units.h"

namespace dmf {

/// What kind of thing a number in a file measures. A bare number is in the native unit, which is the reduced
/// one for lengths, times, volumes, masses, accelerations and forces; text such as "1.5 mm" is converted.
enum class Dimension {
  number,
  length,
  time,
  volume,
  angle,
  voltage,
  frequency,
  density,
  surface_tension,
  mass,
  acceleration,
  force,
  capacitance,
  current
};

/// A number as it was written, before the scene's units are applied.
struct WrittenQuantity {
  double value;  ///< native when `bare`, else in the base unit: m, s, m^3, degrees, V, Hz, kg/m^3, N/m, kg,
                 ///< m/s^2, N, F, A
  bool bare;     ///< written without a unit
};

namespace quantity_detail {

struct UnitName {
  std::string_view name;
  Dimension dimension;
  double base;  ///< one of it in the base unit
};

inline constexpr std::array kUnitNames{
    UnitName{"m", Dimension::length, 1},
    UnitName{"mm", Dimension::length, 1e-3},
    UnitName{"um", Dimension::length, 1e-6},
    UnitName{"nm", Dimension::length, 1e-9},
    UnitName{"s", Dimension::time, 1},
    UnitName{"ms", Dimension::time, 1e-3},
    UnitName{"us", Dimension::time, 1e-6},
    UnitName{"ns", Dimension::time, 1e-9},
    UnitName{"m^3", Dimension::volume, 1},
    UnitName{"mm^3", Dimension::volume, 1e-9},
    UnitName{"um^3", Dimension::volume, 1e-18},
    UnitName{"ul", Dimension::volume, 1e-9},
    UnitName{"nl", Dimension::volume, 1e-12},
    UnitName{"pl", Dimension::volume, 1e-15},
    UnitName{"deg", Dimension::angle, 1},
    UnitName{"rad", Dimension::angle, 1 / degree},
    UnitName{"V", Dimension::voltage, 1},
    UnitName{"mV", Dimension::voltage, 1e-3},
    UnitName{"kV", Dimension::voltage, 1e3},
    UnitName{"Hz", Dimension::frequency, 1},
    UnitName{"kHz", Dimension::frequency, 1e3},
    UnitName{"kg/m^3", Dimension::density, 1},
    UnitName{"g/cm^3", Dimension::density, 1e3},
    UnitName{"N/m", Dimension::surface_tension, 1},
    UnitName{"mN/m", Dimension::surface_tension, 1e-3},
    UnitName{"kg", Dimension::mass, 1},
    UnitName{"mg", Dimension::mass, 1e-6},
    UnitName{"ug", Dimension::mass, 1e-9},
    UnitName{"ng", Dimension::mass, 1e-12},
    UnitName{"m/s^2", Dimension::acceleration, 1},
    UnitName{"N", Dimension::force, 1},
    UnitName{"uN", Dimension::force, 1e-6},
    UnitName{"nN", Dimension::force, 1e-9},
    UnitName{"pN", Dimension::force, 1e-12},
    UnitName{"F", Dimension::capacitance, 1},
    UnitName{"uF", Dimension::capacitance, 1e-6},
    UnitName{"nF", Dimension::capacitance, 1e-9},
    UnitName{"pF", Dimension::capacitance, 1e-12},
    UnitName{"fF", Dimension::capacitance, 1e-15},
    UnitName{"aF", Dimension::capacitance, 1e-18},
    UnitName{"A", Dimension::current, 1},
    UnitName{"mA", Dimension::current, 1e-3},
    UnitName{"uA", Dimension::current, 1e-6},
    UnitName{"nA", Dimension::current, 1e-9},
};

}  // namespace quantity_detail

/// The number at the start of `text`, which is shortened to what follows it. Empty when there is none or it
/// is not finite. Does not depend on the locale.
inline std::optional<double> take_number(std::string_view& text) {
  // from_chars knows no leading plus, YAML does.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(end - text.data());
  return value;
}

/// The units that can be written for a dimension, "m, mm, um, nm".
inline std::string unit_names(Dimension dimension) {
  std::string names;
  for (const auto& unit : quantity_detail::kUnitNames) {
    if (unit.dimension == dimension) names += (names.empty() ? "" : ", ") + std::string(unit.name);
  }
  return names;
}

/// What a bare number of this dimension is measured in.
inline std::string_view native_unit(Dimension dimension) {
  constexpr std::array<std::string_view, 14> names{"",          "r_c",      "tau",    "r_c^3", "degrees",
                                                   "V",         "Hz",       "kg/m^3", "N/m",   "beads",
                                                   "r_c/tau^2", "k_BT/r_c", "F",      "A"};
  return names[static_cast<std::size_t>(dimension)];
}

/// The native unit is a reduced one: it means something only together with the scene's units.
inline bool is_reduced(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
    case Dimension::time:
    case Dimension::volume:
    case Dimension::mass:
    case Dimension::acceleration:
    case Dimension::force:
      return true;
    default:
      return false;
  }
}

/// Reads "1.5 mm", "1.5mm" or "1.5". Empty when the text is no number, the unit is unknown or measures
/// something else.
inline std::optional<WrittenQuantity> parse_quantity(std::string_view text, Dimension dimension) {
  const std::optional<double> value = take_number(text);
  if (!value) return std::nullopt;
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  if (text.empty()) return WrittenQuantity{*value, true};
  for (const auto& unit : quantity_detail::kUnitNames) {
    if (unit.name == text && unit.dimension == dimension) return WrittenQuantity{*value * unit.base, false};
  }
  return std::nullopt;
}

/// One native unit of a dimension in its base unit.
inline double native_in_base(Dimension dimension, const Units& units) {
  switch (dimension) {
    case Dimension::length:
      return units.length_m;
    case Dimension::time:
      return units.time_s;
    case Dimension::volume:
      return units.volume_m3();
    case Dimension::mass:
      return units.mass_kg;
    case Dimension::acceleration:
      return units.acceleration_m_per_s2();
    case Dimension::force:
      return units.force_N();
    default:
      return 1;
  }
}

}  // namespace dmf
