#pragma once
#include "chip/scene.h"
#include "engine/yaml_reader.h"

namespace dmf::chip {

/// `label_grid`: walls of any shape, from pictures, a raw file and shapes, and what they do to the liquid.
/// After the domain and the wettability of the plate, whose angle at rest is the default. Notes what is wrong
/// in the reader and never throws; docs/scene_format.md lists the keys.
void read_label_grid(const engine::YamlReader& root, Scene& scene);

}  // namespace dmf::chip
