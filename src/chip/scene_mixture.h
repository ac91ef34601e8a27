#pragma once
#include "chip/scene.h"
#include "engine/yaml_reader.h"

namespace dmf::chip {

// Sections of a scene file as scene_sections.h has them: several liquids, and boxes filled with one.

/// `species`, `pairs` and `spline`; after `liquid` and `microparticle_model`, from which further liquids have
/// what they don't say.
void read_mixture(const engine::YamlReader& root, engine::Parameters& parameters);
/// Notes a section with contact angles where the wall's attraction is given (fixed_wall_attraction()).
void refuse_contact_angles(const engine::YamlReader& root, const engine::Parameters& parameters);
/// The liquid that `species` names; the first one without it.
std::uint32_t read_species(const engine::YamlReader& section, const engine::Parameters& parameters);
/// `fills`; after the domain.
void read_fills(const engine::YamlReader& root, Scene& scene);

}  // namespace dmf::chip
