#pragma once
#include <string>

#include "chip/scene.h"

namespace dmf::tools {

/// What a scene would simulate: beads, memory, units, and how far its dimensionless numbers are from water's
/// at the same size. Text for a person, several lines.
std::string explain(const chip::Scene& scene);

}  // namespace dmf::tools
