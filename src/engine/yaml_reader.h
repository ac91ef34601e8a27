#pragma once
#include "engine/units.h"
#include "yaml/yaml_reader.h"

/// The reader of files, under the names by which engine and chip know it.
namespace dmf::engine {

using dmf::Count;
using dmf::Dimension;
using dmf::nearest_word;
using dmf::Range;
using dmf::YamlReader;

}  // namespace dmf::engine
