#pragma once
#include "engine/parameters.h"
#include "engine/yaml_reader.h"

namespace dmf::chip {

/// `dimensions`, `boundaries` and `wall.attraction` of a scene file, from its root. Notes what is wrong in
/// the reader and never throws; what is out of range engine::violations() says.
void read_boundaries(const engine::YamlReader& root, engine::Parameters& parameters);

}  // namespace dmf::chip
