#include "chip/command_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "chip/command_reader.h"
#include "chip/polygon.h"
#include "engine/placement.h"

namespace dmf::chip {

namespace {

constexpr double kMaxFrequency = 100e3;  // Hz

// What a command may hold, whoever sends it: more is refused with one sentence, not one for each.
constexpr std::size_t kMaxPositions = 10'000;  // of a wettability program
constexpr std::size_t kMaxPoints = 20'000;     // of a microparticle
constexpr std::size_t kMaxTold = 20;           // violations
constexpr std::size_t kMaxEcho = 100;          // characters of what was written

std::string echo(const std::string& text) {
  if (text.size() <= kMaxEcho) return text;
  std::size_t end = kMaxEcho;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80)
    --end;  // not within a character of UTF-8
  return text.substr(0, end) + "...";
}

/// A length in r_c as both readers of a message want it.
std::string length_text(double reduced, const engine::Units& units) {
  return fmt::format("{:.6g} mm ({:.6g} r_c)", reduced * units.length_m * 1e3, reduced);
}

/// Collects what is wrong with one command.
class Rules {
 public:
  Rules(const Scene& scene, const engine::ContactAngleCurve& curve) : scene_(scene), curve_(curve) {}

  void operator()(const SetElectrodes& command) { check_channels(command.channels); }

  void operator()(const SetHv& command) {
    check_voltage(command.voltage);
    if (!(command.frequency >= 0 && command.frequency <= kMaxFrequency)) {
      note("frequency {} Hz: allowed 0 to {} Hz", command.frequency, kMaxFrequency);
    }
  }

  void operator()(const SetElectrodeVoltages& command) {
    if (command.channels.empty()) note("channels: none given, allowed: one or more");
    check_lengths("channels", command.channels.size(), "voltages", command.voltages.size());
    check_channels(command.channels);
    if (command.voltages.size() > scene_.layout.electrodes().size()) return;  // told by one of both
    for (const double voltage : command.voltages) check_voltage(voltage);
  }

  void operator()(const SetWettability& command) {
    if (engine::fixed_wall_attraction(scene_.parameters))
      note("contact angles on a wall with wall.attraction or pairs.liquid.wall, allowed: on a wall without");
    if (command.positions.empty()) note("positions: none given, allowed: one or more");
    check_lengths("positions", command.positions.size(), "contact angles", command.contact_angles_deg.size());
    const std::size_t longest = std::max(command.positions.size(), command.contact_angles_deg.size());
    if (longest > kMaxPositions)
      return note("positions: {} given, allowed: up to {}", longest, kMaxPositions);
    check_positions(command.positions);
    for (const double angle : command.contact_angles_deg) {
      if (!(angle >= curve_.min_angle() && angle <= curve_.max_angle())) {
        note("contact angle {} degrees: allowed {:.4g} to {:.4g} degrees, the calibrated range", angle,
             curve_.min_angle(), curve_.max_angle());
      }
    }
  }

  void operator()(const LoadPattern& command) {
    if (scene_.patterns.count(command.name)) return;
    std::vector<std::string> names;
    for (const auto& [name, sequence] : scene_.patterns) names.push_back(name);
    if (names.empty()) {
      note("pattern `{}` does not exist; this scene has no patterns", echo(command.name));
    } else {
      note("pattern `{}` does not exist; patterns are {}", echo(command.name), fmt::join(names, ", "));
    }
  }

  void operator()(const DispenseDroplet& command) {
    check_finite("x", command.x, "m");
    check_finite("y", command.y, "m");
    const auto sound = [](double value) { return value > 0 && std::isfinite(value); };
    if (command.volume != 0 && command.fills != 0) {
      note("fills {} given together with volume: allowed one of both", command.fills);
    } else if (command.fills != 0 && !sound(command.fills)) {
      note("fills {}: allowed more than 0 electrodes", command.fills);
    } else if (command.fills == 0 && !sound(command.volume)) {
      note("volume {} m^3: allowed more than 0 m^3", command.volume);
    }
    if (!found_.empty()) return;
    try {
      if (!command.species.empty()) engine::liquid_named(scene_.parameters, echo(command.species));
      for (auto& violation : violations(placement_of(command, scene_), scene_)) found_.push_back(violation);
    } catch (const engine::InvalidInput& refusal) {
      note("{}", refusal.what());
    }
  }

  void operator()(const AddMicroparticle& command) {
    check_finite("x", command.x, "m");
    check_finite("y", command.y, "m");
    if (!(command.height >= 0 && std::isfinite(command.height))) {
      note("height {} m: allowed 0 m or more over the plate", command.height);
    }
    if (!(command.radius > 0 && std::isfinite(command.radius))) {
      note("radius {} m: allowed more than 0 m", command.radius);
    }
    if (command.beads > 0 && !command.points.empty()) {
      note("beads {} given together with points: allowed one of both", command.beads);
    }
    if (command.points.size() > kMaxPoints)
      return note("points: {} given, allowed: up to {}", command.points.size(), kMaxPoints);
    for (const Eigen::Vector3d& point : command.points) {
      if (!point.allFinite())
        note("points: ({}, {}, {}) m, allowed: finite", point.x(), point.y(), point.z());
    }
    if (command.mass && !(*command.mass > 0 && std::isfinite(*command.mass))) {
      note("mass {} kg: allowed more than 0 kg", *command.mass);
    }
    if (!found_.empty()) return;
    try {
      for (auto& violation : engine::violations(placement_of(command, scene_), scene_.parameters))
        found_.push_back(std::move(violation));
    } catch (const engine::InvalidInput& refusal) {
      note("{}", refusal.what());
    }
  }

  void operator()(const Remove& command) {
    if ((command.droplet > 0) == (command.microparticle > 0)) {
      note("droplet {} and microparticle {}: allowed the id of one, from 1, and 0 for the other",
           command.droplet, command.microparticle);
    }
  }

  void operator()(const SetBodyForces& command) {
    check_finite("gravity's x", command.gravity[0], "m/s^2");
    check_finite("gravity's y", command.gravity[1], "m/s^2");
    check_finite("gravity's z", command.gravity[2], "m/s^2");
    check_finite("magnetic force's x", command.magnetic[0], "N");
    check_finite("magnetic force's y", command.magnetic[1], "N");
    check_finite("magnetic force's z", command.magnetic[2], "N");
  }

  void operator()(const InjectFault& command) {
    const std::vector<std::string>& kinds = fault_kinds();
    if (std::find(kinds.begin(), kinds.end(), command.kind) == kinds.end()) {
      note("kind `{}`: allowed {}", echo(command.kind), fmt::join(kinds, ", "));
      return;
    }
    if (command.all && command.kind != fault::kClear) {
      note("all with kind {}: allowed with clear", command.kind);
      return;
    }
    if (has_channel(command)) check_channels({command.channel});
    if (command.kind == fault::kWeak && !(command.strength >= 0 && command.strength <= 1)) {
      note("strength {}: allowed 0 to 1", command.strength);
    }
  }

  void operator()(const SetDisabledChannels& command) { check_channels(command.channels); }

  void operator()(const Halt&) {}

  void operator()(const Reset&) {}

  std::vector<std::string> found() && { return std::move(found_); }

 private:
  template <typename... Arguments>
  void note(const char* text, const Arguments&... arguments) {
    if (found_.size() < kMaxTold) found_.push_back(fmt::format(fmt::runtime(text), arguments...));
  }

  void check_finite(const std::string& name, double value, const char* unit) {
    if (!std::isfinite(value)) note("{} {} {}: allowed: a finite number", name, value, unit);
  }

  void check_channels(const std::vector<std::uint32_t>& channels) {
    const std::size_t there = scene_.layout.electrodes().size();
    if (there > 0 && channels.size() > there)
      return note("channels: {} given, allowed: up to {}, each once", channels.size(), there);
    std::set<std::uint32_t> seen;
    for (const std::uint32_t channel : channels) {
      if (found_.size() >= kMaxTold) return;
      if (!seen.insert(channel).second) note("channels: {} given twice", channel);
      try {
        scene_.layout.index_of(channel);
      } catch (const engine::InvalidInput& error) {
        note("{}", error.what());
      }
    }
  }

  void check_voltage(double voltage) {
    const double most = scene_.electrowetting.max_voltage;
    if (!(voltage >= 0 && voltage <= most)) note("voltage {} V: allowed 0 to {} V", voltage, most);
  }

  void check_lengths(const char* a, std::size_t a_size, const char* b, std::size_t b_size) {
    if (a_size != b_size) note("{}: {} given but {} {}, allowed: as many of both", a, a_size, b_size, b);
  }

  void check_positions(const std::vector<double>& positions) {
    const double lower = scene_.parameters.domain.lower.x();
    const double upper = scene_.parameters.domain.upper.x();
    // A position that was converted from r_c and back may be off by its last bits.
    const double tolerance = 1e-9 * (upper - lower);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const double x = positions[i] / scene_.units.length_m;
      if (!(x >= lower - tolerance && x <= upper + tolerance)) {
        note("position {}: allowed {} to {}, the plate", length_text(x, scene_.units),
             length_text(lower, scene_.units), length_text(upper, scene_.units));
      }
      if (i > 0 && !(positions[i] > positions[i - 1])) {
        note("positions: {} m after {} m, allowed: rising", positions[i], positions[i - 1]);
      }
    }
  }

  const Scene& scene_;
  const engine::ContactAngleCurve& curve_;
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> violations(const Command& command, const Scene& scene,
                                    const engine::ContactAngleCurve& curve) {
  Rules rules(scene, curve);
  std::visit(rules, command);
  return std::move(rules).found();
}

double filling_volume(const Scene& scene, const Vector2d& point, double count) {
  const auto& electrodes = scene.layout.electrodes();
  if (!scene.parameters.domain.has_top_plate() || electrodes.empty())
    throw engine::InvalidInput(fmt::format(
        "fills {}: a droplet fills electrodes between two plates, allowed: with domain.sides.z: plates",
        count));
  const auto nearest = std::min_element(
      electrodes.begin(), electrodes.end(),
      [&](const auto& a, const auto& b) { return distance(point, a.outline) < distance(point, b.outline); });
  const double side = std::sqrt(area(nearest->outline)) + scene.layout.gap();
  return count * side * side * engine::liquid_height(scene.parameters);
}

engine::DropletPlacement placement_of(const DispenseDroplet& command, const Scene& scene) {
  const engine::Units& units = scene.units;
  const Vector2d at(command.x / units.length_m, command.y / units.length_m);
  const double volume =
      command.fills > 0 ? filling_volume(scene, at, command.fills) : command.volume / units.volume_m3();
  const double radius = sphere_radius(volume);
  engine::DropletPlacement droplet{{at.x(), at.y(), scene.parameters.domain.lower.z() + radius}, radius};
  if (!command.species.empty()) droplet.species = engine::liquid_named(scene.parameters, command.species);
  return droplet;
}

engine::MicroparticlePlacement placement_of(const AddMicroparticle& command, const Scene& scene) {
  const engine::Units& units = scene.units;
  engine::MicroparticlePlacement body;
  body.center = {command.x / units.length_m, command.y / units.length_m};
  body.radius = command.radius / units.length_m;
  body.beads = command.beads;
  body.smooth = command.smooth;
  double lowest = 0;  // of the contact spheres' centres
  for (const Eigen::Vector3d& point : command.points) {
    body.points.push_back(point / units.length_m);
    lowest = body.points.size() == 1 ? body.points[0].z() : std::min(lowest, body.points.back().z());
  }
  if (command.height > 0) {
    body.z = scene.parameters.domain.lower.z() + body.radius - lowest + command.height / units.length_m;
  }
  if (command.mass) body.mass = *command.mass / units.mass_kg;
  body.attraction = command.contact_angle_deg ? microparticle_attraction(scene, *command.contact_angle_deg)
                                              : command.attraction;
  body.static_friction = command.static_friction;
  body.kinetic_friction = command.kinetic_friction;
  body.rolling_friction = command.rolling_friction;
  body.magnetic = command.magnetic;
  return body;
}

engine::BodyForces body_forces_of(const SetBodyForces& command, const Scene& scene) {
  return {Eigen::Vector3d(command.gravity.data()) / scene.units.acceleration_m_per_s2(),
          Eigen::Vector3d(command.magnetic.data()) / scene.units.force_N()};
}

std::vector<std::string> violations(const engine::DropletPlacement& placement, const Scene& scene) {
  std::vector<std::string> found;
  const engine::Domain& domain = scene.parameters.domain;
  constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  const double pancake = engine::pancake_radius(placement, scene.parameters);
  const int axes = pancake > 0 ? 2 : 3;  // a pancake stands from plate to plate
  for (int axis = 0; axis < axes; ++axis) {
    const bool cut_by_wall = axis == 2 && domain.has_wall();
    const double reach = domain.periodic(axis) ? 0 : pancake > 0 ? pancake : placement.radius;
    const double lower = domain.lower[axis] + (cut_by_wall ? -placement.radius : reach);
    const double upper = domain.upper[axis] - reach;
    const double tolerance = 1e-9 * (domain.upper[axis] - domain.lower[axis]);
    const double centre = placement.center[axis];
    if (centre >= lower - tolerance && centre <= upper + tolerance) continue;
    if (lower > upper) {
      found.push_back(fmt::format("radius {}: allowed up to {}, what fits into the domain along {}",
                                  length_text(reach, scene.units),
                                  length_text(0.5 * domain.size()[axis], scene.units), kAxes[axis]));
    } else {
      found.push_back(fmt::format("centre's {} {}: allowed {} to {} for a radius of {}", kAxes[axis],
                                  length_text(centre, scene.units), length_text(lower, scene.units),
                                  length_text(upper, scene.units), length_text(reach, scene.units)));
    }
  }
  if (found.empty() && scene.parameters.label_grid.grid) {
    try {
      engine::droplet_sites(placement, scene.parameters);
    } catch (const engine::InvalidInput& refusal) {
      found.push_back(refusal.what());
    }
  }
  return found;
}

}  // namespace dmf::chip
