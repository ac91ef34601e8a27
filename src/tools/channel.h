#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "chip/scene.h"

namespace dmf::tools {

/// Liquid between two walls that a body force, or the walls, drive along x. Single-threaded; reduced units
/// throughout.
struct ChannelRun {
  chip::Scene scene;  ///< filled with liquid; z sides are the walls
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
  std::size_t most_outside = 0;     ///< beads beyond a plane in any of the looks, the settling's too
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

/// What a profile between walls that move by -speed and speed says.
struct ShearFlow {
  double
      slip;  ///< what the liquid lacks of the walls' velocity at them, of it: by a line through |z| < 0.6 h
  double density;      ///< of the slabs at the walls, of that of the slabs in the line
  double temperature;  ///< of the slabs at the walls, k_BT
};
ShearFlow shear_of(const ChannelProfile& profile, double speed);

/// Writes z, velocity, parabola, temperature, density, a line a slab.
void write_profile(const std::string& file, const ChannelProfile& profile);

}  // namespace dmf::tools
