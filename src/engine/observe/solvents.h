#pragma once
#include <cstdint>
#include <vector>

#include "engine/beads.h"
#include "engine/bonds/bonds.h"
#include "engine/pairs.h"

namespace dmf::engine {

/// The liquid that each bead counts to when droplets are looked for, by index. Unbound beads are of their own
/// species; one that belongs to a chain or membrane is of the liquid that most of the unbound beads in range
/// are (of two, of that with the lower number), whatever it is made of itself; without any, of the one that
/// most bound beads in range count to. So a surfactant is part of the droplet that it covers, and a membrane
/// of the liquid around it. What touches no liquid stays with its own species. Empty when there is nothing to
/// tell apart. Needs who is in range now.
std::vector<std::uint8_t> solvents(const Beads& beads, const Pairs& pairs, const Bonds& bonds);

}  // namespace dmf::engine
