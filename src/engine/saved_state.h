#pragma once
#include <cstdint>

#include "engine/beads.h"
#include "engine/observe/droplet_tracker.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// A run of more steps than this was never made: 10^15 steps take longer than any machine lasts.
constexpr std::uint64_t most_steps = 1'000'000'000'000'000;

/// Whether beads that were read from a saved state can be those of a run with these parameters: arrays of one
/// length, ids that are there once, finite numbers, places inside the domain. What passes may still be
/// nonsense, but the engine gets through it, or stops with an Instability.
/// @param next_bead_id  id of the next bead that will be placed.
/// @throws InvalidInput.
void require_sound(const Beads& beads, std::uint32_t next_bead_id, const DropletTracker& tracker,
                   const Parameters& parameters);

/// The same of the place of a bead, of liquid or of a microparticle, r_c.
void require_inside(const Record& place, double margin, const Domain& domain);

}  // namespace dmf::engine
