#include "chip/command.h"

#include <nlohmann/json.hpp>

#include "chip/command_reader.h"

namespace dmf::chip {

namespace {

struct NameOf {
  const char* operator()(const SetElectrodes&) const { return "set_electrodes"; }
  const char* operator()(const SetHv&) const { return "set_hv"; }
  const char* operator()(const SetElectrodeVoltages&) const { return "set_electrode_voltages"; }
  const char* operator()(const SetWettability&) const { return "set_wettability"; }
  const char* operator()(const LoadPattern&) const { return "load_pattern"; }
  const char* operator()(const DispenseDroplet&) const { return "dispense_droplet"; }
  const char* operator()(const AddMicroparticle&) const { return "add_microparticle"; }
  const char* operator()(const Remove&) const { return "remove"; }
  const char* operator()(const SetBodyForces&) const { return "set_body_forces"; }
  const char* operator()(const InjectFault&) const { return "inject_fault"; }
  const char* operator()(const SetDisabledChannels&) const { return "set_disabled_channels"; }
  const char* operator()(const Halt&) const { return "halt"; }
  const char* operator()(const Reset&) const { return "reset"; }
};

using Json = nlohmann::ordered_json;

struct Write {
  Json& json;
  void operator()(const SetElectrodes& command) const { json["channels"] = command.channels; }
  void operator()(const SetHv& command) const {
    json["voltage"] = command.voltage;
    json["frequency"] = command.frequency;
    json["enabled"] = command.enabled;
  }
  void operator()(const SetElectrodeVoltages& command) const {
    json["channels"] = command.channels;
    json["voltages"] = command.voltages;
  }
  void operator()(const SetWettability& command) const {
    json["positions"] = command.positions;
    json["contact_angles"] = command.contact_angles_deg;
  }
  void operator()(const LoadPattern& command) const { json["name"] = command.name; }
  void operator()(const DispenseDroplet& command) const {
    json["x"] = command.x;
    json["y"] = command.y;
    if (command.fills > 0) {
      json["fills"] = command.fills;
    } else {
      json["volume"] = command.volume;
    }
    if (!command.species.empty()) json["species"] = command.species;
  }
  void operator()(const AddMicroparticle& command) const {
    json["x"] = command.x;
    json["y"] = command.y;
    json["height"] = command.height;
    json["radius"] = command.radius;
    if (command.beads > 0) json["beads"] = command.beads;
    if (command.smooth) json["smooth"] = true;
    for (const Eigen::Vector3d& point : command.points)
      json["points"].push_back({point.x(), point.y(), point.z()});
    if (command.mass) json["mass"] = *command.mass;
    if (command.contact_angle_deg) {
      json["contact_angle"] = *command.contact_angle_deg;
    } else {
      json["attraction"] = command.attraction;
    }
    json["static_friction"] = command.static_friction;
    if (command.kinetic_friction) json["kinetic_friction"] = *command.kinetic_friction;
    json["rolling_friction"] = command.rolling_friction;
    json["magnetic"] = command.magnetic;
  }
  void operator()(const Remove& command) const {
    if (command.microparticle > 0) {
      json["microparticle"] = command.microparticle;
    } else {
      json["droplet"] = command.droplet;
    }
  }
  void operator()(const SetBodyForces& command) const {
    json["gravity"] = command.gravity;
    json["magnetic"] = command.magnetic;
  }
  void operator()(const InjectFault& command) const {
    json["kind"] = command.kind;
    if (has_channel(command)) json["channel"] = command.channel;
    if (command.kind == fault::kWeak) json["strength"] = command.strength;
    if (command.all) json["all"] = true;
  }
  void operator()(const SetDisabledChannels& command) const { json["channels"] = command.channels; }
  void operator()(const Halt& command) const {
    if (!command.reason.empty()) json["reason"] = command.reason;
  }
  void operator()(const Reset&) const {}
};

}  // namespace

const std::vector<std::string>& fault_kinds() {
  static const std::vector<std::string> kinds{fault::kStuckOn, fault::kStuckOff,     fault::kShort,
                                              fault::kWeak,    fault::kDisconnected, fault::kClear};
  return kinds;
}

bool has_channel(const InjectFault& command) { return command.kind != fault::kDisconnected && !command.all; }

std::string name_of(const Command& command) { return std::visit(NameOf{}, command); }

std::string to_json(const Command& command) {
  Json json;
  json["command"] = name_of(command);
  std::visit(Write{json}, command);
  constexpr int kOneLine = -1;
  // A name that is not UTF-8 must not stop a recording.
  return json.dump(kOneLine, ' ', false, Json::error_handler_t::replace);
}

Command command_from_json(const std::string& json) {
  // JSON is YAML, so the scene's reader serves; a reduced unit of 1 makes its bare numbers SI.
  constexpr engine::Units kSi{1, 1, 1};
  engine::YamlReader reader = engine::YamlReader::parse(json, "command");
  reader.set_units(kSi);
  const std::string name = reader.choice("command", command_names());
  Command command = reader.failed() ? Command(Reset{}) : read_command(name, reader, kSi);
  reader.finish();
  return command;
}

}  // namespace dmf::chip
