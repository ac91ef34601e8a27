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
  command.species = reader.text("species", "");
  if (reader.has("fills")) {
    if (reader.has("radius") || reader.has("volume"))
      reader.report("fills", "given together with radius or volume, allowed: one of the three");
    command.fills = reader.number("fills", Range::above(0));
    return command;
  }
  // A volume is taken as it stands: the way over a radius would cost its last bits.
  const bool by_volume = reader.has("volume") && !reader.has("radius");
  const double volume = by_volume ? reader.quantity("volume", Dimension::volume, Range::above(0))
                                  : sphere_volume(read_radius(reader));
  command.volume = volume * units.volume_m3();
  return command;
}

Command read_add_microparticle(const YamlReader& reader, const Units& units) {
  AddMicroparticle command;
  command.x = reader.quantity("x", Dimension::length, {}) * units.length_m;
  command.y = reader.quantity("y", Dimension::length, {}) * units.length_m;
  command.height = reader.quantity("height", Dimension::length, {}, 0.0) * units.length_m;
  const auto [body, contact_angle] = read_microparticle(reader);
  command.radius = body.radius * units.length_m;
  command.beads = body.beads;
  command.smooth = body.smooth;
  for (const Eigen::Vector3d& point : body.points) command.points.push_back(point * units.length_m);
  if (body.mass) command.mass = *body.mass * units.mass_kg;
  command.attraction = body.attraction;
  command.contact_angle_deg = contact_angle;
  command.static_friction = body.static_friction;
  command.kinetic_friction = body.kinetic_friction;
  command.rolling_friction = body.rolling_friction;
  command.magnetic = body.magnetic;
  return command;
}

Command read_remove(const YamlReader& reader, const Units&) {
  const std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  Remove command;
  if (reader.has("microparticle")) {
    if (reader.has("droplet"))
      reader.report("microparticle", "given together with droplet, allowed: one of both");
    command.microparticle = static_cast<std::uint32_t>(reader.integer("microparticle", 1, most));
  } else {
    command.droplet = static_cast<std::uint32_t>(reader.integer("droplet", 1, most));
  }
  return command;
}

Command read_set_body_forces(const YamlReader& reader, const Units& units) {
  const Eigen::Vector3d gravity =
      read_vector(reader, "gravity", Dimension::acceleration) * units.acceleration_m_per_s2();
  const Eigen::Vector3d magnetic = read_vector(reader, "magnetic", Dimension::force) * units.force_N();
  return SetBodyForces{{gravity.x(), gravity.y(), gravity.z()}, {magnetic.x(), magnetic.y(), magnetic.z()}};
}

Command read_inject_fault(const YamlReader& reader, const Units&) {
  InjectFault command;
  command.kind = reader.choice("kind", fault_kinds());
  if (command.kind == fault::kClear) command.all = reader.boolean("all", false);
  if (has_channel(command)) {
    const std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
    command.channel = static_cast<std::uint32_t>(reader.integer("channel", 0, most));
  }
  if (command.kind == fault::kWeak) command.strength = reader.number("strength", {});
  return command;
}

Command read_set_disabled_channels(const YamlReader& reader, const Units&) {
  return SetDisabledChannels{read_channels(reader)};
}

Command read_halt(const YamlReader& reader, const Units&) { return Halt{reader.text("reason", "")}; }

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
      {name_of(AddMicroparticle{}), read_add_microparticle},
      {name_of(Remove{}), read_remove},
      {name_of(SetBodyForces{}), read_set_body_forces},
      {name_of(InjectFault{}), read_inject_fault},
      {name_of(SetDisabledChannels{}), read_set_disabled_channels},
      {name_of(Halt{}), read_halt},
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

WrittenMicroparticle read_microparticle(const YamlReader& reader) {
  WrittenMicroparticle written;
  engine::MicroparticlePlacement& body = written.body;
  // The engine has the ranges, so that each stands once; here any number goes.
  body.radius = reader.quantity("radius", Dimension::length, Range::above(0));
  const std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  body.beads = static_cast<std::uint32_t>(reader.integer("beads", 0, most, body.beads));
  body.smooth = reader.boolean("smooth", body.smooth);
  for (const auto& point : reader.rows("points", Dimension::length, {}, {}, {3, 3})) {
    body.points.emplace_back(point[0], point[1], point[2]);
  }
  if (reader.has("points") && reader.has("beads"))
    reader.report("beads", "given together with points, allowed: one of both");
  if (reader.has("mass")) body.mass = reader.quantity("mass", Dimension::mass, {});
  body.attraction = reader.number("attraction", {}, body.attraction);
  if (reader.has("contact_angle")) {
    if (reader.has("attraction"))
      reader.report("contact_angle", "given together with attraction, allowed: one of both");
    written.contact_angle = reader.quantity("contact_angle", Dimension::angle, {});
  }
  body.static_friction = reader.number("static_friction", {}, body.static_friction);
  if (reader.has("kinetic_friction")) body.kinetic_friction = reader.number("kinetic_friction", {});
  body.rolling_friction = reader.number("rolling_friction", {}, body.rolling_friction);
  body.magnetic = reader.boolean("magnetic", body.magnetic);
  return written;
}

Eigen::Vector3d read_vector(const YamlReader& reader, const std::string& key, Dimension dimension) {
  if (!reader.has(key)) return Eigen::Vector3d::Zero();
  const auto components = reader.quantities(key, dimension, {}, {3, 3});
  if (components.size() != 3) return Eigen::Vector3d::Zero();
  return {components[0], components[1], components[2]};
}

double sphere_volume(double radius) { return 4 * M_PI / 3 * radius * radius * radius; }

double sphere_radius(double volume) { return std::cbrt(volume / (4 * M_PI / 3)); }

}  // namespace dmf::chip
