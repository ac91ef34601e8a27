#include "engine/observe/carriage.h"

#include <algorithm>
#include <cmath>

namespace dmf::engine {
namespace {

/// Wet beads above this fraction: liquid all around.
constexpr double all_around = 0.95;

Vector3d vector_of(const Record& record) { return {record.x, record.y, record.z}; }

/// What one look finds around one microparticle.
struct Surroundings {
  double immersion = 0;
  std::uint32_t leaked = 0;
  std::map<std::uint32_t, std::uint32_t> neighbours_of_droplet;
};

/// A smooth sphere has no beads that could be wet: the liquid within r_c of its surface is compared with what
/// fits there, outside the gap that the repulsion keeps.
Surroundings look_around_smooth(const Microparticle& particle, const SmoothNeighbours& near,
                                const Beads& beads, const Ghosts& ghosts, const Parameters& parameters,
                                const DropletTracker& tracker) {
  constexpr double gap = 0.35;
  Surroundings found;
  const double radius = particle.placement.radius;
  std::uint32_t neighbours = 0;
  for (const BeadRun& run : near.liquid)
    for (std::uint32_t j = run.begin; j < run.end; ++j) {
      const double distance =
          parameters.domain.nearest_image(vector_of(ghosts.position(j, beads)) - particle.body.position)
              .norm();
      if (distance >= radius + 1) continue;
      ++neighbours;
      ++found.neighbours_of_droplet[tracker.droplet_of(beads.id[ghosts.source(j)])];
      if (distance < 0.5 * radius) ++found.leaked;
    }
  const auto cubed = [](double a) { return a * a * a; };
  const double all =
      parameters.liquid.bulk_density * 4.0 / 3.0 * M_PI * (cubed(radius + 1) - cubed(radius + gap));
  found.immersion = std::min(1.0, neighbours / all);
  found.neighbours_of_droplet.erase(0);  // vapour
  return found;
}

Surroundings look_around_beads(const Microparticle& particle, const Beads& beads, const Pairs& pairs,
                               const Domain& domain, const DropletTracker& tracker) {
  Surroundings found;
  std::uint32_t wet_beads = 0;
  const bool sphere = particle.placement.points.empty();
  const double deep = 0.5 * particle.placement.radius;
  std::vector<std::uint32_t> deep_beads;
  for (const NeighbourBlock& block : pairs.body_blocks()) {
    if (block.begin < particle.first_bead || block.begin >= particle.first_bead + particle.bead_count())
      continue;
    for (std::uint32_t k = block.begin; k < block.end; ++k) {
      const auto [begin, end] = block.foreign_in_range(k);
      for (const std::uint32_t* j = begin; j != end; ++j) {
        ++found.neighbours_of_droplet[tracker.droplet_of(beads.id[pairs.ghosts().source(*j)])];
        const Vector3d at = vector_of(pairs.ghosts().position(*j, beads));
        if (sphere && domain.nearest_image(at - particle.body.position).norm() < deep)
          deep_beads.push_back(*j);
      }
      if (end - begin >= Carriage::fewest_neighbours) ++wet_beads;
    }
  }
  std::sort(deep_beads.begin(), deep_beads.end());
  found.leaked =
      static_cast<std::uint32_t>(std::unique(deep_beads.begin(), deep_beads.end()) - deep_beads.begin());
  found.immersion = static_cast<double>(wet_beads) / particle.bead_count();
  found.neighbours_of_droplet.erase(0);  // vapour
  return found;
}

Surroundings look_around(const Microparticle& particle, const Microparticles& bodies, const Beads& beads,
                         const Pairs& pairs, const Parameters& parameters, const DropletTracker& tracker) {
  if (!particle.placement.smooth)
    return look_around_beads(particle, beads, pairs, parameters.domain, tracker);
  for (const SmoothNeighbours& near : pairs.smooth_neighbours())
    if (&bodies.all()[near.microparticle] == &particle)
      return look_around_smooth(particle, near, beads, pairs.ghosts(), parameters, tracker);
  return {};
}

bool exists(std::uint32_t droplet, const DropletTracker& tracker) {
  const auto& droplets = tracker.droplets();
  return std::any_of(droplets.begin(), droplets.end(),
                     [droplet](const DropletObservation& one) { return one.id == droplet; });
}

}  // namespace

void Carriage::update(std::uint64_t step, const Microparticles& bodies, const Beads& beads,
                      const Pairs& pairs, const Parameters& parameters, const DropletTracker& tracker) {
  std::map<std::uint32_t, Entry> now;
  for (const Microparticle& particle : bodies.all()) {
    const Surroundings around = look_around(particle, bodies, beads, pairs, parameters, tracker);
    Entry entry{around.immersion, 0, around.leaked};
    if (entry.immersion >= smallest_immersion) {
      std::uint32_t most = 0;
      for (const auto& [droplet, neighbours] : around.neighbours_of_droplet)
        if (neighbours > most) {
          most = neighbours;
          entry.droplet = droplet;
        }
    }
    const std::uint32_t before = of(particle.id).droplet;
    if (before != entry.droplet) {
      if (before == 0)
        events_.push_back({MicroparticleEvent::Kind::picked_up, step, particle.id, entry.droplet});
      else if (exists(before, tracker))
        events_.push_back({MicroparticleEvent::Kind::dropped_off, step, particle.id, before});
      // Otherwise the droplet goes on under another id: it has merged into one, or evaporated.
    }
    now[particle.id] = entry;
  }
  entries_.swap(now);
}

Carriage::Entry Carriage::of(std::uint32_t id) const {
  const auto found = entries_.find(id);
  return found == entries_.end() ? Entry{} : found->second;
}

void Carriage::archive(Archive& archive) {
  std::vector<std::uint32_t> ids, droplets, leaked;
  std::vector<double> immersions;
  for (const auto& [id, entry] : entries_) {
    ids.push_back(id);
    droplets.push_back(entry.droplet);
    leaked.push_back(entry.leaked);
    immersions.push_back(entry.immersion);
  }
  archive(ids);
  archive(droplets);
  archive(leaked);
  archive(immersions);
  if (!archive.reading()) return;
  if (droplets.size() != ids.size() || leaked.size() != ids.size() || immersions.size() != ids.size())
    throw InvalidInput("saved state: carried microparticles are cut short");
  entries_.clear();
  for (std::size_t k = 0; k < ids.size(); ++k) entries_[ids[k]] = {immersions[k], droplets[k], leaked[k]};
}

MicroparticlePlace place_in(const Carriage::Entry& entry, const Vector3d& position,
                            const std::vector<DropletObservation>& droplets, const ShearedDomain& images) {
  if (entry.droplet == 0) return MicroparticlePlace::dry;
  if (entry.immersion >= all_around) return MicroparticlePlace::inside;
  const auto droplet =
      std::find_if(droplets.begin(), droplets.end(),
                   [&entry](const DropletObservation& one) { return one.id == entry.droplet; });
  if (droplet == droplets.end()) return MicroparticlePlace::dry;
  const Vector3d way = droplet->velocity.norm() > 0 ? droplet->velocity : Vector3d::UnitX();
  return images.nearest_image(position - droplet->centroid).dot(way) < 0 ? MicroparticlePlace::rear
                                                                         : MicroparticlePlace::front;
}

}  // namespace dmf::engine
