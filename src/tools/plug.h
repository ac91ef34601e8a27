#pragma once
#include <cstdint>

#include "engine/parameters.h"

namespace dmf::tools {

/// Two liquids of plain DPD that differ in nothing but what they do to each other and to walls (Chen 2010):
/// rho 4, a 18.75 and 56.25 between them, gamma 4.5, s 1/2. @returns all but domain and walls; the second
/// liquid is called "carrier".
/// @param carrier_wall_repulsion  a of the carrier and the walls, k_BT / r_c.
engine::Parameters immiscible_liquids(double carrier_wall_repulsion);

/// What a channel's walls are made of.
enum class ChannelWalls {
  plates,  ///< frozen layers above and below, six beads per r_c^3 as Chen's, periodic across: a slit
  square,  ///< a square channel of solid voxels (duct.h), four beads per r_c^3, which beads bounce back from
};

/// A plug of one liquid in another along a channel (Chen 3.3): its angle with the walls at rest, and what
/// becomes of it under a body force.
struct PlugRun {
  std::uint64_t seed = 1;
  double time_step = 0.01;  ///< tau
  ChannelWalls walls = ChannelWalls::plates;
  double length = 30;    ///< of the period along the channel, r_c
  double half_gap = 10;  ///< half the distance of the walls, r_c; of a square channel a multiple of 1/2
  double width = 6;      ///< of a slit's period across, r_c
  double plug = 16;      ///< of the channel's length that the plug fills when placed, r_c
  double wall_repulsion = 10, carrier_wall_repulsion = 10;         ///< a_wA of the plug and a_wB, k_BT / r_c
  engine::Reflection reflection = engine::Reflection::thin_layer;  ///< of the plates
  double acceleration = 0;                                         ///< of both liquids along x, r_c / tau^2
  double settle = 100;   ///< tau before measuring; the acceleration begins half-way
  double measure = 120;  ///< tau
};

struct PlugResult {
  double angle = 0;                        ///< in the plug, of both ends taken together, degrees
  double first_half = 0, second_half = 0;  ///< the same of the halves of the measurement
  double advancing = 0, receding = 0;      ///< at the front and at the rear end, degrees
  double length = 0;                       ///< of the plug along the middle of the channel, r_c
  double velocity = 0;                     ///< of its centre, r_c / tau
  double section = 0;  ///< share of the channel's section that it fills in the middle quarter of its length
  double corners = 0;  ///< share that it fills of what is nearer than 2 r_c to both a y and a z wall
  double temperature = 0;  ///< k_BT
};

/// Angles in the plane in the middle of the channel (of a square one, both such planes), from the arcs of
/// meniscus.h. Single-threaded. @throws engine::Instability; std::runtime_error when the plug has no two
/// ends.
PlugResult run_plug(const PlugRun& run);

}  // namespace dmf::tools
