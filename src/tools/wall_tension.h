#pragma once
#include <cstdint>

#include "engine/parameters.h"

namespace dmf::tools {

/// A film of one liquid of plain DPD (plug.h) between two plates, for the tension of liquid and wall.
struct WallTensionRun {
  std::uint64_t seed = 1;
  double time_step = 0.01;     ///< tau
  double width = 6, gap = 20;  ///< of the film's period, and of the plates, r_c
  double wall_repulsion = 10;  ///< a_w, k_BT / r_c
  engine::Reflection reflection = engine::Reflection::thin_layer;
  double settle = 30, measure = 300;  ///< tau
};

/// Of one wall, with the plane that beads are sent back from as the surface that divides liquid and wall.
struct WallTensionResult {
  /// Integral of p_N - p_T from the middle of the film to the plane, k_BT / r_c^2: p_T is the liquid's alone,
  /// the wall is no part of it, as if it were an outer potential (Chen eq. 18)
  double tension = 0;
  double pressure = 0;  ///< of the liquid in the middle, k_BT / r_c^3
  double lacking =
      0;  ///< d tension / d p: layer of liquid as dense as in the middle that the wall keeps off, r_c
  /// d tension / d a_w at constant pressure, 1 / r_c: mean of the wall's potential over a_w. The other way to
  /// tensions, by integration over a_w, where the way in which beads are sent back keeps the equilibrium
  double slope = 0;
  double temperature = 0;  ///< k_BT
};

/// Single-threaded. @throws engine::Instability.
WallTensionResult run_wall_tension(const WallTensionRun& run);

/// Young's equation for a plug of one liquid in another between two plates: cos theta in the plug, beyond -1
/// and 1 where it does not touch the walls or spreads. Each tension is taken at its liquid's own pressure:
/// they differ by Laplace's, -tension cos theta / half_gap, and their mean over the channel is that of the
/// films.
/// @param tension  of the two liquids; @param share  of the channel that the plug fills.
double young_cosine(const WallTensionResult& plug, const WallTensionResult& carrier, double tension,
                    double half_gap, double share);

}  // namespace dmf::tools
