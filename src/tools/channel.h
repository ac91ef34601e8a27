#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "chip/scene.h"

namespace dmf::tools {

/// Liquid between two walls that a body force drives along x. Single-threaded; reduced units throughout.
struct ChannelRun {
  chip::Scene scene;  ///< filled with liquid; z sides are the walls, gravity acts along x
  std::uint64_t seed = 1;
  double settle = 0, measure = 0;  ///< tau
  int bins = 122;                  ///< slabs from wall to wall, an even number
};

/// Means over slabs and time, from wall to wall.
struct ChannelProfile {
  std::vector<double> z;            ///< middle of the slab, 0 half-way between the walls, r_c
  std::vector<double> velocity;     ///< along x, r_c / tau
  std::vector<double> temperature;  ///< kinetic, of what moves relative to the slab's mean, k_BT
  std::vector<double> density;      ///< beads per r_c^3, in two dimensions per r_c^2
  double half_width = 0;            ///< from the middle to the planes, h
};
ChannelProfile run_channel(const ChannelRun& run);

/// What a profile says, from the parabola u = u_0 - c z^2 through what lies up to 0.8 h from the middle.
struct ChannelFlow {
  double fastest;               ///< u_0
  double viscosity;             ///< rho g / 2 c with the density of the same part
  double slip;                  ///< of the parabola at the planes of the walls, u_0 - c h^2
  double density, temperature;  ///< of the same part
  double most_dense_at_wall;    ///< largest density in a slab within 1 r_c of a wall, of that in the middle
  double coolest_at_wall, hottest_at_wall;  ///< of temperatures within 1 r_c of a wall
};
ChannelFlow flow_of(const ChannelProfile& profile, double acceleration);

/// Writes z, velocity, parabola, temperature, density, a line a slab.
void write_profile(const std::string& file, const ChannelProfile& profile);

}  // namespace dmf::tools
