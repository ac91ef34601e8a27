#include "engine/observe/watchdog.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "engine/walls/solid.h"

namespace dmf::engine {
namespace {

std::string text_of(const Vector3d& at) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", at.x(), at.y(), at.z());
}

/// "bead 17 of droplet 2" or "bead 17 of the vapour".
std::string name_of(std::uint32_t bead, const DropletTracker& tracker) {
  const std::uint32_t droplet = tracker.droplet_of(bead);
  return fmt::format("bead {} of {}", bead,
                     droplet > 0 ? fmt::format("droplet {}", droplet) : std::string("the vapour"));
}

/// How deep rounding may put a bead into a solid voxel when it is folded back over a periodic side, r_c.
constexpr float solid_margin = 1e-3f;

/// The axis along which a point is beyond a side that is closed, or is no number; -1 for none.
int axis_beyond(const Vector3d& at, const Domain& domain) {
  for (int axis = 0; axis < 3; ++axis) {
    // Comparisons with what is no number fail. Positions are floats, and so must be the sides.
    const bool within = at[axis] >= static_cast<float>(domain.lower[axis]) &&
                        at[axis] <= static_cast<float>(domain.upper[axis]);
    if (domain.periodic(axis) ? !std::isfinite(at[axis]) : !within) return axis;
  }
  return -1;
}

std::string side_beyond(const Vector3d& at, int axis, const Domain& domain) {
  if (!std::isfinite(at[axis])) return "nowhere";
  const bool below = at[axis] < domain.lower[axis];
  const bool plate = (below ? domain.lower_side : domain.upper_side)[axis] == Side::wall;
  if (plate) return below ? "through the plate" : "through the top plate";
  return fmt::format("beyond the {} side of {}", below ? "lower" : "upper", "xyz"[axis]);
}

std::string fault_of_beads(const Parameters& parameters, const Beads& beads, double temperature,
                           const DropletTracker& tracker) {
  std::size_t beyond = beads.size(), in_solid = beads.size();
  const Solid solid(parameters);
  for (std::size_t i = 0; i < beads.size(); ++i) {
    const Record& p = beads.position[i];
    if (axis_beyond({p.x, p.y, p.z}, parameters.domain) >= 0) beyond = i;
    if (!solid.empty() && solid.contains_deep({p.x, p.y, p.z}, solid_margin)) in_solid = i;
  }
  if (beyond < beads.size()) {
    const Record& p = beads.position[beyond];
    const Vector3d at(p.x, p.y, p.z);
    return fmt::format("{} at {} is {}; look at time_step ({}) and the liquid's attraction and repulsion",
                       name_of(beads.id[beyond], tracker), text_of(at),
                       side_beyond(at, axis_beyond(at, parameters.domain), parameters.domain),
                       parameters.time_step);
  }
  if (in_solid < beads.size()) {
    const Record& p = beads.position[in_solid];
    return fmt::format("{} at {} is in the solid of the label grid; look at time_step ({})",
                       name_of(beads.id[in_solid], tracker), text_of({p.x, p.y, p.z}), parameters.time_step);
  }
  if (beads.size() < DropletTracker::fewest_beads) return "";
  const double count = static_cast<double>(beads.size());
  const double chance = 6.0 * std::sqrt(2.0 / (parameters.dimensions * count));
  const double set = parameters.liquid.temperature;
  const double lowest = (parameters.watchdog.lowest_temperature - chance) * set;
  const double highest = (parameters.watchdog.highest_temperature + chance) * set;
  if (temperature >= lowest && temperature <= highest) return "";
  return fmt::format(
      "temperature {:.4g} against {} set, allowed: {:.4g} to {:.4g}; look at time_step ({}), "
      "random_amplitude "
      "({}) and watchdog.temperature",
      temperature, set, std::max(0.0, lowest), highest, parameters.time_step,
      parameters.liquid.random_amplitude);
}

std::string fault_of_microparticles(const Parameters& parameters, const Microparticles& microparticles,
                                    const Carriage& carriage) {
  const MicroparticleParameters& model = parameters.microparticles;
  for (const Microparticle& particle : microparticles.all()) {
    const Vector3d& at = particle.body.position;
    if (const int axis = axis_beyond(at, parameters.domain); axis >= 0)
      return fmt::format(
          "microparticle {} at {} is {}; look at elastic_modulus ({}), its mass and the forces on it",
          particle.id, text_of(at), side_beyond(at, axis, parameters.domain), model.elastic_modulus);
    if (const std::uint32_t leaked = carriage.of(particle.id).leaked; leaked > parameters.watchdog.leak)
      return fmt::format(
          "microparticle {} at {}: {} liquid beads inside, allowed: {}; its {} beads on radius {} r_c at "
          "attraction {} don't keep the liquid out, look at beads, liquid_repulsion ({}) and watchdog.leak",
          particle.id, text_of(at), leaked, parameters.watchdog.leak, particle.bead_count(),
          particle.placement.radius, particle.placement.attraction, model.liquid_repulsion);
  }
  return "";
}

std::string fault_of_vapour(const Parameters& parameters, const DropletTracker& tracker) {
  std::map<std::uint32_t, std::size_t> lost;
  for (const auto& [bead, droplet] : tracker.evaporated_from()) ++lost[droplet];
  for (const auto& [id, count] : lost) {
    if (count < fewest_evaporated) continue;
    std::size_t left = 0;
    std::string place = "is gone";
    for (const DropletObservation& droplet : tracker.droplets())
      if (droplet.id == id) {
        left = droplet.beads;
        place = "at " + text_of(droplet.centroid);
      }
    const double share = static_cast<double>(count) / static_cast<double>(count + left);
    if (share <= parameters.watchdog.evaporation) continue;
    return fmt::format(
        "droplet {} {}: {} of its {} beads have evaporated{}, allowed: {:.3g} %; look at the liquid's "
        "temperature ({}) and attraction ({}), and watchdog.evaporation",
        id, place, count, count + left,
        parameters.mixture.liquids.empty() ? "" : " or dissolved in other liquids",
        100 * parameters.watchdog.evaporation, parameters.liquid.temperature, parameters.liquid.attraction);
  }
  return "";
}

}  // namespace

std::string find_fault(const Parameters& parameters, const Beads& beads, double temperature,
                       const Microparticles& microparticles, const DropletTracker& tracker,
                       const Carriage& carriage) {
  std::string fault = fault_of_beads(parameters, beads, temperature, tracker);
  if (fault.empty()) fault = fault_of_microparticles(parameters, microparticles, carriage);
  if (fault.empty()) fault = fault_of_vapour(parameters, tracker);
  return fault;
}

}  // namespace dmf::engine
