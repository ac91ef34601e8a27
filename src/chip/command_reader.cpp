#include "chip/command_reader.h"

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace dmf::chip {

using engine::Dimension;
using engine::Range;
using engine::Units;
using engine::YamlReader;

namespace {

constexpr double kPi = 3.14159265358979323846;

std::vector<std::uint32_t> read_channels(const YamlReader& reader) {
  std::vector<std::uint32_t> channels;
  for (const std::uint64_t channel :
       reader.integers("channels", 0, std::numeric_limits<std::uint32_t>::max(), {})) {
    channels.push_back(static_cast<std::uint32_t>(channel));
  }
  return channels;
}

Command read_set_electrodes(const YamlReader& reader, const Units&) {
  return SetElectrodes{read_channels(reader)};
}

Command read_set_hv(const YamlReader& reader, const Units&) {
  SetHv command;
  command.voltage = reader.quantity("voltage", Dimension::voltage, {});
  command.frequency = reader.quantity("frequency", Dimension::frequency, {}, 0.0);
  command.enabled = reader.boolean("enabled", true);
  return command;
}

Command read_set_electrode_voltages(const YamlReader& reader, const Units&) {
  return SetElectrodeVoltages{read_channels(reader),
                              reader.quantities("voltages", Dimension::voltage, {}, {1})};
}

Command read_set_wettability(const YamlReader& reader, const Units& units) {
  SetWettability command;
  command.positions = reader.quantities("positions", Dimension::length, {}, {1});
  for (double& position : command.positions) position *= units.length_m;
  command.contact_angles_deg = reader.quantities("contact_angles", Dimension::angle, {}, {1});
  return command;
}

Command read_load_pattern(const YamlReader& reader, const Units&) { return LoadPattern{reader.text("name")}; }

Command read_dispense_droplet(const YamlReader& reader, const Units& units) {
  DispenseDroplet command;
  command.x = reader.quantity("x", Dimension::length, {}) * units.length_m;
  command.y = reader.quantity("y", Dimension::length, {}) * units.length_m;
  // A volume is taken as it stands: the way over a radius would cost its last bits.
  const bool by_volume = reader.has("volume") && !reader.has("radius");
  const double volume = by_volume ? reader.quantity("volume", Dimension::volume, Range::above(0))
                                  : sphere_volume(read_radius(reader));
  command.volume = volume * units.volume_m3();
  return command;
}

Command read_remove(const YamlReader& reader, const Units&) {
  const std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  return Remove{static_cast<std::uint32_t>(reader.integer("droplet", 1, most))};
}

Command read_reset(const YamlReader&, const Units&) { return Reset{}; }

using Read = std::function<Command(const YamlReader&, const Units&)>;

const std::vector<std::pair<std::string, Read>>& readers() {
  static const std::vector<std::pair<std::string, Read>> table{
      {name_of(SetElectrodes{}), read_set_electrodes},
      {name_of(SetHv{}), read_set_hv},
      {name_of(SetElectrodeVoltages{}), read_set_electrode_voltages},
      {name_of(SetWettability{}), read_set_wettability},
      {name_of(LoadPattern{}), read_load_pattern},
      {name_of(DispenseDroplet{}), read_dispense_droplet},
      {name_of(Remove{}), read_remove},
      {name_of(Reset{}), read_reset}};
  return table;
}

}  // namespace

const std::vector<std::string>& command_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, read] : readers()) all.push_back(name);
    return all;
  }();
  return names;
}

Command read_command(const std::string& name, const YamlReader& arguments, const Units& units) {
  for (const auto& [known, read] : readers()) {
    if (known == name) return read(arguments, units);
  }
  arguments.report("", name + ": unknown command");
  return Reset{};
}

double read_radius(const YamlReader& reader) {
  if (!reader.has("volume")) return reader.quantity("radius", Dimension::length, Range::above(0));
  if (reader.has("radius")) {
    reader.report("volume", "given together with radius, allowed: one of both");
    return reader.quantity("radius", Dimension::length, Range::above(0));
  }
  return sphere_radius(reader.quantity("volume", Dimension::volume, Range::above(0)));
}

double sphere_volume(double radius) { return 4 * kPi / 3 * radius * radius * radius; }

double sphere_radius(double volume) { return std::cbrt(volume / (4 * kPi / 3)); }

}  // namespace dmf::chip
