#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "chip/board.h"
#include "chip/polygon.h"
#include "chip/scene.h"
#include "engine/observe/snapshot.h"
#include "engine/wettability.h"

namespace dmf::chip {

/// What pulls on a contact line, per surface tension, r_c: the closed integral of cos theta(s) n ds over the
/// outline of a footprint, n its outward normal.
struct LinePull {
  Vector2d net = Vector2d::Zero();
  /// Outward pull towards +x, +y, -x, -y: cos theta times the part of n that points there. Below 0 where the
  /// line is pushed inward.
  std::array<double, 4> sides{};
};
/// @param outline  counter-clockwise. @param piece  length over which the angle is taken as constant, r_c.
LinePull line_pull(const Polygon& outline, const engine::ContactAngleField& angle, double piece);

/// Why a droplet moves or does not. Reduced units.
struct DropletExplanation {
  /// gamma times the net pull of the angles that are shown under its contact line, k_BT / r_c. A top plate
  /// has one angle everywhere and adds nothing.
  Vector2d driving_force = Vector2d::Zero();
  std::array<double, 4> side_forces{};  ///< outward, towards +x, +y, -x, -y, k_BT / r_c
  /// What the threshold voltage keeps back on the part of the contact line that reaches the nearest
  /// electrode, k_BT / r_c. It is taken off the driving force already. The drag of the liquid is not in it:
  /// it comes with the motion and is what the driving force is spent on.
  double opposing_force = 0;
  std::vector<std::uint32_t> channels;  ///< under its footprint
  /// The actuated electrode that is not wholly under its footprint and nearest to it; of those it stands on,
  /// the one with the smallest share of it.
  std::optional<std::uint32_t> nearest_channel;
  double nearest_distance = 0;  ///< from footprint to that electrode, r_c; 0: they overlap
  /// The lowest voltage, of the rail or of the electrode when it is driven past the rail, at which the net
  /// force towards that electrode does more work over the length of the footprint than ten times k_BT: less
  /// is lost in thermal motion. Rounded up to 0.1 V; none when no voltage up to max_voltage does that.
  std::optional<double> needed_voltage;
  std::string message;  ///< all that in words
};
DropletExplanation explain_droplet(const engine::DropletObservation& droplet, const Board& board,
                                   const Scene& scene);

}  // namespace dmf::chip
