#pragma once
#include <optional>

#include "chip/scene.h"
#include "engine/yaml_reader.h"

namespace dmf::chip {

/// Name of Lan's own formula among the calibrations, of the wall and of microparticles.
constexpr const char* kLanFormula = "lan2016";

/// The sections of a scene file, each from the file's root. They note what is wrong in the reader and never
/// throw; docs/scene_format.md lists the keys. A section may use what the ones before it have read.

engine::LiquidParameters read_liquid(const engine::YamlReader& root);
/// `units`: by default those of water whose r_c is 10 um.
engine::Units read_units(const engine::YamlReader& root, const engine::LiquidParameters& liquid);
/// Wall, domain, what microparticles share and how to compute; then checks every range of the engine.
void read_engine(const engine::YamlReader& root, engine::Parameters& parameters);
/// Calibration, rest angle and initial program. @returns the calibration curve unless it can't be read.
std::optional<engine::ContactAngleCurve> read_wettability(const engine::YamlReader& root, Scene& scene);
/// Electrodes and electrowetting. @returns false when there is no sound layout.
bool read_chip(const engine::YamlReader& root, Scene& scene);
void read_droplets(const engine::YamlReader& root, Scene& scene);
/// Microparticles and the calibration of their contact angles.
void read_microparticles(const engine::YamlReader& root, Scene& scene);
void read_body_forces(const engine::YamlReader& root, Scene& scene);
/// The angles of the plate at rest and under the highest voltage lie within the calibration.
void check_angles(const engine::YamlReader& root, const Scene& scene, const engine::ContactAngleCurve& curve);

}  // namespace dmf::chip
