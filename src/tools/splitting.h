#pragma once
#include <cstdint>
#include <optional>

#include "chip/scene.h"

namespace dmf::tools {

/// A droplet of two electrodes' volume on the middle one of three between two plates: all three pull, then
/// the outer two.
struct SplittingRun {
  double gap = 3;           ///< from plate to plate, r_c
  double pitch = 10;        ///< of the electrodes, r_c
  double rest_angle = 120;  ///< of everything without voltage, the top plate too, degrees
  double on_angle = 50;     ///< of a pad with voltage, degrees
  std::uint64_t seed = 1;
  double time_step = 0.01;  ///< tau
};

struct SplittingResult {
  std::optional<double> time;  ///< from when the middle electrode was switched off until two droplets are
                               ///< there, tau; none: they never were
  double smaller_share = 0;    ///< of the smaller one in both
  double liquid_height = 0;    ///< r_c
};

/// @throws engine::Instability, engine::InvalidInput.
SplittingResult run_splitting(const SplittingRun& run);

/// The largest liquid height over pitch at which the three-electrode split goes through, by Cho, Moon and Kim
/// (2003), eq. for necking: 1/R_neck + 1/R_end = (cos(on) - cos(rest)) / h, the curvatures in the plane of
/// the plates that the pressure of an actuated end and of the neck allow. Both ends are discs of one
/// electrode's area at the outer electrodes' centres, the neck's arcs touch them and, when they pinch off,
/// each other: R_end = L / sqrt(pi), R_neck = (L^2 - R_end^2) / (2 R_end). @param rest_angle, on_angle
/// degrees.
double largest_splitting_height(double rest_angle, double on_angle);

}  // namespace dmf::tools
