#pragma once
#include <string>

#include "engine/simulation.h"
#include "systems.h"

namespace dmf::engine {

/// A droplet of about 1,000 beads on its wall, x and y periodic.
inline Simulation droplet_on_wall(int threads, const std::string& kernel = "auto", std::uint64_t seed = 1) {
  Parameters parameters = plate(16, 14);
  parameters.seed = seed;
  return Simulation(parameters, ContactAngleCurve::lan2016(), {threads, kernel});
}

inline void start_droplet(Simulation& simulation) {
  simulation.set_wettability([](double, double) { return 90.0; });
  simulation.add_droplet({{8, 8, 3}, 3.5});
}

inline std::uint64_t hash_after(Simulation& simulation, int steps) {
  for (int k = 0; k < steps; ++k) simulation.step();
  return *simulation.observe({false, true}).get()->state_hash;
}

}  // namespace dmf::engine
