#pragma once
#include "engine/observe/snapshot.h"

namespace dmf::tools {

/// Null when there is none.
inline const engine::DropletObservation* largest_droplet(const engine::Snapshot& snapshot) {
  const engine::DropletObservation* largest = nullptr;
  for (const engine::DropletObservation& droplet : snapshot.droplets)
    if (!largest || droplet.beads > largest->beads) largest = &droplet;
  return largest;
}

}  // namespace dmf::tools
