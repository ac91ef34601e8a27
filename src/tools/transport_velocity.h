#pragma once
#include <cstdint>

#include "chip/scene.h"

namespace dmf::tools {

/// A droplet that is driven along a row of electrodes: the next one goes on as soon as the droplet has come
/// to the one before.
struct VelocityRun {
  double voltage = 60;     ///< V rms
  double patience = 1500;  ///< tau for one electrode, before it counts as at rest
  std::uint64_t seed = 1;
};

struct VelocityResult {
  double velocity;    ///< mean from the second electrode's centre to the last one's, r_c / tau; 0: it did not
                      ///< get there
  double electrodes;  ///< that it came to, of those after the first
};

/// @param scene  a row of three electrodes or more towards +x, the droplet on the first one; its schedule is
/// left out.
VelocityResult run_transport_velocity(chip::Scene scene, const VelocityRun& run);

}  // namespace dmf::tools
