#pragma once
#include <cstdint>

namespace dmf::engine {

/// What a bead is made of. A pair of species has a law (pair_law.h); beads of one group share a species, so
/// no kernel looks a species up bead by bead. Bodies, second liquids and chains add their groups here.
enum class Species : std::uint8_t { liquid, wall };

}  // namespace dmf::engine
