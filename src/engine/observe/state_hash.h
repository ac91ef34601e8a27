#pragma once
#include <cstdint>

#include "engine/beads.h"
#include "engine/bodies/microparticles.h"
#include "engine/bonds/bonds.h"
#include "engine/walls/walls.h"

namespace dmf::engine {

/// Fingerprint of all that decides how a run goes on: step, position, velocity, force bits and species of
/// every moving bead by id, the wall's attraction, place and motion of every microparticle, who is bound to
/// whom. Independent of storage order. Equal hashes: the same bits, but for one chance in 2^64.
std::uint64_t state_hash(std::uint64_t step, const Beads& beads, const Walls& wall,
                         const Microparticles& bodies, const Bonds& bonds);

}  // namespace dmf::engine
