#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "chip/scene.h"

namespace dmf::tools {

/// Solid above and below a channel along x that is wide at the ends of its period and narrow in the middle
/// (Liu figure 22), the same on both sides of z = 0. Reduced units.
struct Slopes {
  double wide = 6, narrow = 2.5;  ///< half heights
  double middle = 9;              ///< where a slope is half-way, from the middle of the period
  double run = 10;                ///< of a slope along x

  double angle() const;  ///< of the walls with x, degrees
};
/// Labels the voxels of a scene's grid again. The liquid's volume depends on the run of the slopes no more
/// than voxels do.
void lay_slopes(const Slopes& slopes, chip::Scene& scene);

/// Chains that a body force drives along x through a periodic channel of changing height. Single-threaded.
struct SlopingChannelRun {
  chip::Scene scene;                  ///< filled with liquid, with chains; its label grid is the channel
  double settle = 50, measure = 100;  ///< tau
  std::uint64_t seed = 1;
};

/// Where a section of the channel is, seen along the flow.
enum class Reach { wide, narrowing, narrow, widening };

/// A slice of the channel, one voxel thick: sums over the looks of a run.
struct ChannelSection {
  double x = 0, height = 0;  ///< of its middle; of the fluid, r_c
  Reach reach = Reach::wide;
  double volume = 0;                                 ///< of the fluid, times looks, r_c^3
  double beads = 0, momentum = 0;                    ///< all beads; along x, m r_c / tau
  double chains = 0;                                 ///< whose centroid is here
  double stretch_square = 0, end_to_end_square = 0;  ///< R_x^2 and R^2 of them, r_c^2
  double off_centre = 0;  ///< distance of their centroids from the middle plane, of half the height
};

/// Means over the sections of one kind.
struct ReachMeans {
  double height = 0, velocity = 0, density = 0;
  double stretch_square = 0, end_to_end_square = 0, off_centre = 0;  ///< of chains; NaN where none came
};

struct SlopingChannelResult {
  std::vector<ChannelSection> sections;  ///< by rising x
  double longest = 0;                    ///< largest R_x of any chain, of the greatest length of its contour
  double straightest = 0;     ///< largest R of any chain, of the length of its contour at that time
  double stretch_square = 0;  ///< <R_x^2> of all chains, r_c^2
  double temperature = 0;     ///< of motion along y, across the flow, k_BT

  ReachMeans over(Reach reach) const;
};

/// @throws engine::Instability, engine::InvalidInput.
SlopingChannelResult run_sloping_channel(const SlopingChannelRun& run);

/// Writes x, height, velocity, density and what chains do, a line a section.
void write_sections(const std::string& file, const SlopingChannelResult& result);

}  // namespace dmf::tools
