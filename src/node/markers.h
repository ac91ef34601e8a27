#pragma once
#include <visualization_msgs/MarkerArray.h>

#include <cstdint>
#include <set>

#include "node/convert.h"
#include "node/frame.h"

/// From frames to what RViz draws: pure functions. All in frame chip, scaled by the display scale. Namespaces
/// and ids are stable: plate (0), top_plate (0), solid (0), rail (0), electrodes and electrode_labels
/// (channel), droplets and droplet_labels (droplet id), microparticles (microparticle id), vapour (0), chains
/// (0), membranes (membrane id).
namespace dmf::node {

/// The plate, the top plate over it and the solid of a label grid, each electrode coloured by its voltage
/// (grey 0 V, orange at the board's limit; black and with a red number when it is disabled), its channel
/// number, and in front of the plate what the rail does, in red when it was halted.
visualization_msgs::MarkerArray chip_markers(const Frame& frame, const ConversionContext& context);

/// Each droplet as the spheres of its beads, coloured by id, see-through while it carries a microparticle,
/// under a label with id and contact angles; stray beads in white. @pre frame.has_beads.
visualization_msgs::MarkerArray droplet_markers(const Frame& frame, const ConversionContext& context);

/// Each microparticle as a ball of coloured stripes, so that one sees it turn. One colour tells how it wets,
/// from amber (it repels the liquid) to teal, the other what a magnet does to it: red when it is magnetic,
/// else white.
visualization_msgs::MarkerArray microparticle_markers(const Frame& frame, const ConversionContext& context);

/// The bonds of all chains as lines, and each membrane as its triangles, coloured by id.
visualization_msgs::MarkerArray bond_markers(const Frame& frame, const ConversionContext& context);

/// Takes the bonds of chains and membranes that are gone off the screen.
visualization_msgs::MarkerArray bond_deletions(bool chains, const std::set<std::uint32_t>& membranes,
                                               ros::Time stamp);

/// Takes droplets and microparticles that are gone off the screen.
visualization_msgs::MarkerArray deletions(const std::set<std::uint32_t>& droplets,
                                          const std::set<std::uint32_t>& microparticles, ros::Time stamp);

}  // namespace dmf::node
