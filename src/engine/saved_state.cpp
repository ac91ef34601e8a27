#include "engine/saved_state.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "engine/walls/solid.h"

namespace dmf::engine {
namespace {

/// How far a bead may be beyond a periodic side before it is wrapped, and a rounding error, r_c.
constexpr double bead_margin = 1.0;
constexpr float solid_margin = 1e-3f;  ///< of a rounding error, r_c

bool finite(const Record& record) {
  return std::isfinite(record.x) && std::isfinite(record.y) && std::isfinite(record.z);
}

}  // namespace

void require_inside(const Record& place, double margin, const Domain& domain) {
  const double at[3] = {place.x, place.y, place.z};
  for (int axis = 0; axis < 3; ++axis)
    if (!(at[axis] >= domain.lower[axis] - margin && at[axis] <= domain.upper[axis] + margin))
      throw InvalidInput(fmt::format("saved state: a bead at ({:.6g}, {:.6g}, {:.6g}), allowed: the domain",
                                     at[0], at[1], at[2]));
}

void require_sound(const Beads& beads, std::uint32_t next_bead_id, const DropletTracker& tracker,
                   const Parameters& parameters) {
  const Domain& domain = parameters.domain;
  for (const AlignedVector<Record>* array :
       {&beads.position, &beads.predicted, &beads.velocity, &beads.force, &beads.listed})
    if (array->size() != beads.size()) throw InvalidInput("saved state: arrays of unequal length");

  if (!beads.species.empty() && beads.species.size() != beads.size())
    throw InvalidInput("saved state: arrays of unequal length");
  for (const std::uint8_t species : beads.species)
    if (species > parameters.mixture.liquids.size())
      throw InvalidInput(fmt::format("saved state: species {}, allowed: 0 to {}", species,
                                     parameters.mixture.liquids.size()));

  // What is kept by id must fit.
  if (next_bead_id > parameters.max_beads)
    throw InvalidInput(fmt::format("saved state: next bead {}, allowed: up to {} (max_beads)", next_bead_id,
                                   parameters.max_beads));
  // Whoever was in a droplet at some look is known to the tracker; what was placed after them is still there.
  if (tracker.known_beads() > next_bead_id || next_bead_id - tracker.known_beads() > beads.size())
    throw InvalidInput(fmt::format("saved state: next bead {}, allowed: {} to {}", next_bead_id,
                                   tracker.known_beads(), tracker.known_beads() + beads.size()));
  std::vector<bool> taken(next_bead_id, false);
  for (const std::uint32_t id : beads.id) {
    if (id >= next_bead_id || taken[id])
      throw InvalidInput(
          fmt::format("saved state: bead {}, allowed: each id below {} once", id, next_bead_id));
    taken[id] = true;
  }
  const Solid solid(parameters);
  for (std::size_t i = 0; i < beads.size(); ++i) {
    const Record& p = beads.position[i];
    if (!solid.empty() && solid.contains_deep({p.x, p.y, p.z}, solid_margin))
      throw InvalidInput(
          fmt::format("saved state: bead {} is in the solid, allowed: outside of it", beads.id[i]));
    require_inside(beads.position[i], bead_margin, domain);
    require_inside(beads.listed[i], bead_margin, domain);
    if (!finite(beads.predicted[i]) || !finite(beads.velocity[i]) || !finite(beads.force[i]))
      throw InvalidInput(fmt::format("saved state: bead {} moves to no number", beads.id[i]));
  }
}

}  // namespace dmf::engine
