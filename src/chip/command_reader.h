#pragma once
#include <optional>
#include <string>
#include <vector>

#include "chip/command.h"
#include "engine/microparticle.h"
#include "engine/units.h"
#include "engine/yaml_reader.h"

namespace dmf::chip {

/// Names of all commands as name_of() gives them.
const std::vector<std::string>& command_names();

/// Reads a command's arguments from the keys of a mapping. Notes in `arguments` what is wrong with them; what
/// the chip makes of them is not looked at.
/// @param name one of command_names().
/// @param units what the file's bare numbers are in; the command itself is in SI units.
Command read_command(const std::string& name, const engine::YamlReader& arguments,
                     const engine::Units& units);

/// Radius of the sphere that a `radius` or a `volume` describes, whichever is given, in the reader's native
/// unit.
double read_radius(const engine::YamlReader& reader);

/// What a mapping says of a microparticle besides its place, in the reader's native units.
struct WrittenMicroparticle {
  engine::MicroparticlePlacement body;  ///< its place as it was
  std::optional<double> contact_angle;  ///< degrees; stands for the body's attraction when it is written
};
WrittenMicroparticle read_microparticle(const engine::YamlReader& reader);

/// Three components in the native unit; zero when the key is absent.
Eigen::Vector3d read_vector(const engine::YamlReader& reader, const std::string& key,
                            engine::Dimension dimension);

double sphere_volume(double radius);
double sphere_radius(double volume);

}  // namespace dmf::chip
