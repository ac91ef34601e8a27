#pragma once
#include <cstdint>
#include <functional>

#include "engine/parameters.h"

namespace dmf::tools {

/// What a droplet is when it is placed. It tends to keep to the ridges that it has come to lie on.
enum class DropletStart {
  square,  ///< lies on its whole side, and pulls back
  disc     ///< touches with one point, as Yao's, and spreads
};

/// What lies under the grooves. Beads there draw liquid in that hangs within their range.
enum class GrooveBottom {
  beads,  ///< the plate goes on
  bare    ///< nothing but what bounces liquid back: all that is solid are the ridges
};

/// A droplet in a thin slab, periodic along x and y, on a plate with ridges across x (Yao 2013): L wide, S
/// apart, H high, so that the liquid on their tops touches the share f_s = L / (L + S) of the plane. After a
/// rest a body force along x drives it.
struct StructuredWallRun {
  double attraction = -13;  ///< A_sl of plate and ridges
  double ridge = 4;         ///< L, r_c
  double spacing = 9;       ///< S, r_c; 0: a smooth plate
  double height = 1;        ///< H, r_c
  double length = 100;      ///< of the slab, r_c: the nearest whole number of ridges is taken
  double area = 400;        ///< of the droplet in the x-z plane, r_c^2: Yao's 7060 beads are 392
  DropletStart start = DropletStart::square;
  GrooveBottom bottom = GrooveBottom::beads;
  double force = 0.0007;  ///< F_x on each bead, k_BT / r_c
  double settle = 150;    ///< tau until it is measured
  double rest = 150;      ///< tau of measuring at rest
  double drive = 0;       ///< tau with the force
  std::uint64_t seed = 1;
  engine::Parameters parameters{};  ///< liquid and time step; the domain is laid around the droplet

  double solid_fraction() const { return spacing > 0 ? ridge / (ridge + spacing) : 1; }
  /// The largest height of the ridges' tops, r_c.
  double top() const { return spacing > 0 ? height : 0; }
};

/// What is seen every 2 tau while it is driven.
struct FrontSample {
  double time;           ///< since the force acts, tau
  double centre, front;  ///< x of the centre of mass and of the front, from where the centre was, r_c
  double angle;          ///< advancing, over the last 10 tau, degrees; NaN while it can't be fitted
};

struct StructuredWallResult {
  double angle = 0;       ///< at rest: of both sides, against the plane of the ridges' tops, degrees
  double difference = 0;  ///< of the two sides, degrees
  double sunk = 0;  ///< liquid below the tops, of what the grooves under it would hold; 0 on a smooth plate
  double velocity = 0;  ///< mean of the centre of mass in the last three quarters of the drive, r_c / tau
};

/// cos theta* = f (cos theta + 1) - 1 (Cassie and Baxter 1944), degrees.
double cassie_baxter_angle(double solid_fraction, double angle);

/// @throws engine::Instability, engine::InvalidInput; std::runtime_error when no circle could be fitted.
StructuredWallResult run_structured_wall(const StructuredWallRun& run,
                                         const std::function<void(const FrontSample&)>& sample = {});

}  // namespace dmf::tools
