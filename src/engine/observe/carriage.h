#pragma once
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "engine/archive.h"
#include "engine/beads.h"
#include "engine/bodies/microparticles.h"
#include "engine/microparticle.h"
#include "engine/observe/droplet_tracker.h"
#include "engine/pairs.h"

namespace dmf::engine {

/// Which droplet carries which microparticle. Looks when the droplet tracker has looked, so that events are
/// functions of the run.
///
/// A bead of a microparticle is wet when at least `fewest_neighbours` liquid beads are within r_c of it. The
/// droplet that most of these neighbours belong to carries the microparticle, once a tenth of its beads is
/// wet. It has dropped it when another droplet, or none, has taken its place though it is still there.
class Carriage {
 public:
  static constexpr std::uint32_t fewest_neighbours = 3;
  static constexpr double smallest_immersion = 0.1;

  struct Entry {
    double immersion = 0;       ///< wet beads, of all
    std::uint32_t droplet = 0;  ///< that carries it, 0: none
    std::uint32_t leaked = 0;   ///< liquid beads deep inside a sphere
  };

  void update(std::uint64_t step, const Microparticles& bodies, const Beads& beads, const Pairs& pairs,
              const Parameters& parameters, const DropletTracker& tracker);

  /// By id of the microparticle; what it was at the last look.
  Entry of(std::uint32_t id) const;
  std::vector<MicroparticleEvent> take_events() { return std::exchange(events_, {}); }

  void archive(Archive& archive);

 private:
  std::map<std::uint32_t, Entry> entries_;
  std::vector<MicroparticleEvent> events_;
};

/// Where a microparticle stands in its droplet.
MicroparticlePlace place_in(const Carriage::Entry& entry, const Vector3d& position,
                            const std::vector<DropletObservation>& droplets, const ShearedDomain& images);

}  // namespace dmf::engine
