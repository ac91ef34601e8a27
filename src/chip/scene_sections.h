#pragma once
#include <cstdint>
#include <optional>
#include <sstream>
#include <string>

#include "chip/scene.h"
#include "engine/yaml_reader.h"

namespace dmf::chip {

/// Name of Lan's own formula among the calibrations, of the wall and of microparticles.
constexpr const char* kLanFormula = "lan2016";
/// The largest number of a channel.
constexpr std::uint64_t kMaxChannel = 1'000'000;

/// Adds what a constructor or a look-up refused to the violations of a key.
template <typename Action>
bool attempt(const engine::YamlReader& reader, const std::string& key, const Action& action) {
  try {
    action();
    return true;
  } catch (const engine::InvalidInput& refusal) {
    std::istringstream lines(refusal.what());
    for (std::string line; std::getline(lines, line);) reader.report(key, line);
    return false;
  }
}

/// The sections of a scene file, each from the file's root. They note what is wrong in the reader and never
/// throw; docs/scene_format.md lists the keys. A section may use what the ones before it have read.

engine::LiquidParameters read_liquid(const engine::YamlReader& root);
/// What microparticles share.
engine::MicroparticleParameters read_microparticle_model(const engine::YamlReader& root);
/// `chip.file`: the board file that the scene names, if it does; a path counts from the scene's own file.
/// After noting that it can't be had: a stand-in without electrodes.
std::optional<SceneBoard> read_board(const engine::YamlReader& root, Scene& scene);
/// `units`: by default those of water whose r_c is 10 um, or what the board's resolution makes of it.
engine::Units read_units(const engine::YamlReader& root, const engine::LiquidParameters& liquid,
                         const std::optional<SceneBoard>& board);
/// Wall, domain and how to compute; then checks every range of the engine. A board has a domain of its own.
void read_engine(const engine::YamlReader& root, engine::Parameters& parameters,
                 const std::optional<SceneBoard>& board);
/// The domain of a board for which the scene gives none.
engine::Domain domain_around(const SceneBoard& board);
/// The gap of a board for which the scene gives none, r_c.
double default_gap(const SceneBoard& board);
/// Calibration, rest angle and initial program. @returns the calibration curve unless it can't be read.
std::optional<engine::ContactAngleCurve> read_wettability(const engine::YamlReader& root, Scene& scene);
/// Electrodes and electrowetting. @returns false when there is no sound layout.
bool read_chip(const engine::YamlReader& root, Scene& scene);
void read_droplets(const engine::YamlReader& root, Scene& scene);
/// Microparticles and the calibration of their contact angles.
void read_microparticles(const engine::YamlReader& root, Scene& scene);
/// Chains of beads and membranes (scene_bonds.cpp); meshes are read from their files.
void read_chains(const engine::YamlReader& root, Scene& scene);
void read_membranes(const engine::YamlReader& root, Scene& scene);
void read_body_forces(const engine::YamlReader& root, Scene& scene);
/// The angles of the plate at rest and under the highest voltage lie within the calibration.
void check_angles(const engine::YamlReader& root, const Scene& scene, const engine::ContactAngleCurve& curve);

}  // namespace dmf::chip
