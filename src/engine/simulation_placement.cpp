// What comes into a simulation and goes out of it: liquid, chains and membranes, microparticles.
#include "engine/simulation_state.h"

namespace dmf::engine {

std::size_t Simulation::add_droplet(const DropletPlacement& placement) {
  const std::vector<Vector3d> sites = droplet_sites(placement, state_->parameters);
  state_->require_room(sites);
  require_free(state_->beads, sites, state_->parameters);
  return place(sites, placement.species);
}

std::size_t Simulation::fill(const FillPlacement& placement) {
  const State& s = *state_;
  const std::vector<Vector3d> sites = free_sites(placement, s.beads, s.microparticles, s.parameters);
  s.require_room(sites);
  return place(sites, placement.species);
}

std::size_t Simulation::place(const std::vector<Vector3d>& sites, std::uint32_t species) {
  State& s = *state_;
  const std::size_t placed =
      place_beads(s.beads, sites, species, s.parameters, s.step, s.next_bead_id).size();
  refresh();
  return placed;
}

std::size_t Simulation::fill_box() {
  return fill_slab(state_->parameters.domain.lower, state_->parameters.domain.upper);
}

std::size_t Simulation::fill_slab(const Vector3d& lower, const Vector3d& upper) {
  const std::vector<Vector3d> sites = slab_sites({lower, upper}, state_->parameters);
  state_->require_room(sites);
  require_free(state_->beads, sites, state_->parameters);
  return place(sites, 0);
}

namespace {
void require_sound(const std::vector<std::string>& wrong) {
  if (!wrong.empty()) throw InvalidInput(fmt::format("{}", fmt::join(wrong, "\n")));
}
}  // namespace

std::vector<std::uint32_t> Simulation::take(const std::vector<Vector3d>& sites,
                                            const std::vector<std::uint8_t>& species) {
  State& s = *state_;
  s.require_room_for_bonded(static_cast<double>(sites.size()));
  s.microparticles.require_clear(sites);
  return take_sites(s.beads, sites, species, s.bonds, s.parameters, s.pairs.ghosts().images(), s.step,
                    s.next_bead_id);
}

std::uint32_t Simulation::add_chains(const ChainPlacement& placement) {
  State& s = *state_;
  require_sound(violations(placement, s.parameters));
  s.require_room_for_bonded(placement.points.empty() ? 1.0 * placement.count * placement.beads : 0.0);
  const std::uint32_t first = s.bonds.next_chain();
  const std::vector<std::vector<Vector3d>> chains = chain_sites(placement, s.parameters, s.step, first);
  std::vector<Vector3d> sites;
  std::vector<std::uint8_t> species;
  for (const std::vector<Vector3d>& chain : chains) {
    sites.insert(sites.end(), chain.begin(), chain.end());
    for (std::size_t k = 0; k < chain.size(); ++k)
      species.push_back(static_cast<std::uint8_t>(placement.species_of(k)));
  }
  const std::vector<std::uint32_t> ids = take(sites, species);
  auto next = ids.begin();
  for (const std::vector<Vector3d>& chain : chains) {
    const auto end = next + static_cast<std::ptrdiff_t>(chain.size());
    s.bonds.bind_chain(placement.spring, placement.stretching_force, {next, end});
    next = end;
  }
  refresh();
  return first;
}

std::uint32_t Simulation::add_membrane(const MembranePlacement& placement) {
  State& s = *state_;
  require_sound(violations(placement, s.parameters));
  const std::vector<Vector3d>& sites = placement.mesh->vertices;
  const std::vector<std::uint8_t> species(sites.size(), static_cast<std::uint8_t>(placement.species));
  const std::uint32_t id = s.bonds.bind_membrane(placement, take(sites, species));
  refresh();
  return id;
}

void Simulation::remove_droplet(std::uint32_t id) {
  State& s = *state_;
  std::vector<bool> gone(s.next_bead_id, false);
  bool there = false;
  for (const std::uint32_t bead : s.beads.id) {
    gone[bead] = id != 0 && s.tracker.droplet_of(bead) == id;
    there = there || gone[bead];
  }
  if (!there) {
    std::vector<std::uint32_t> known;
    for (const DropletObservation& droplet : s.tracker.droplets()) known.push_back(droplet.id);
    throw InvalidInput(
        fmt::format("droplet {} does not exist; droplets are [{}]", id, fmt::join(known, ", ")));
  }
  s.tracker.forget(id);
  s.bonds.remove_with(gone);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < s.beads.size(); ++i)
    if (!gone[s.beads.id[i]]) kept.push_back(i);
  s.beads.reorder(kept);
  refresh();
}
std::uint32_t Simulation::add_microparticle(const MicroparticlePlacement& placement) {
  State& s = *state_;
  const std::size_t told = std::max<std::size_t>({1, placement.beads, placement.points.size()});
  require_memory(s.parameters, static_cast<double>(s.beads.size()),
                 static_cast<double>(s.microparticles.beads().size() + told),
                 static_cast<double>(s.bonds.bead_count()));
  std::vector<Vector3d> liquid;
  for (const Record& bead : s.beads.position) liquid.emplace_back(bead.x, bead.y, bead.z);
  const double force = placement.magnetic ? s.far.magnetic.norm() : 0.0;
  const std::uint32_t id = s.microparticles.add(placement, liquid, force / s.largest_acceleration());
  refresh();
  return id;
}

void Simulation::remove_microparticle(std::uint32_t id) {
  state_->microparticles.remove(id);
  refresh();
}

}  // namespace dmf::engine
