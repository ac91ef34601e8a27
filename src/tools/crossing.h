#pragma once
#include <cstdint>
#include <map>

#include "chip/scene.h"

namespace dmf::tools {

/// A droplet on its way over a wettability gradient.
struct Crossing {
  /// x (r_c) -> tau after the end of the scene's settle_time at which the centroid of the largest droplet
  /// first passes it; NaN when it did not.
  std::map<double, double> passed;
  double ns_per_bead_step = 0;
};

/// Runs the scene on one thread until the droplet is at x = 40 or `limit` tau are over.
Crossing run_crossing(const chip::Scene& scene, std::uint64_t seed, double limit);

}  // namespace dmf::tools
