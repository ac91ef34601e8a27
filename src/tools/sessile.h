#pragma once
#include <cstdint>

#include "engine/simulation.h"

namespace dmf::tools {

/// A droplet at rest on a plate of one wettability, as the contact angle is measured in the field.
struct SessileRun {
  double attraction = -15;      ///< A_lw of the wall
  double radius = 10;           ///< of the free sphere with the droplet's volume, r_c
  double starting_angle = 110;  ///< the cap it starts as, degrees: near the answer shortens the wait
  double settle = 100;          ///< tau before measuring
  double measure = 150;         ///< tau of measuring, a look every 0.2 tau
  bool flat = false;            ///< no circle that fits is no error: too flat a droplet has none
  std::uint64_t seed = 1;
  engine::Parameters parameters{};  ///< liquid, wall, time step; the domain is laid around the droplet
};

struct SessileResult {
  double angle = 0;       ///< whole measurement, degrees; with `flat` NaN where no circle fits, as its halves
  double first_half = 0;  ///< of the measurement: differs from second_half while the droplet still spreads
  double second_half = 0;
  double temperature = 0;  ///< mean, k_BT
  // By the cap of its volume (flat_cap.h), degrees:
  double by_edge = 0;         ///< NaN where it is a film
  double by_mean_height = 0;  ///< of the whole measurement, then of its halves
  double by_mean_height_first = 0, by_mean_height_second = 0;
  double thickness = 0;  ///< in its middle, r_c
};

/// A curve that passes attractions from -60 to 0 through: each is shown by an angle of its own, degrees.
engine::ContactAngleCurve uncalibrated();
double uncalibrated_angle(double attraction);

/// @throws engine::Instability, engine::InvalidInput; std::runtime_error when no circle could be fitted.
SessileResult run_sessile(const SessileRun& run);

}  // namespace dmf::tools
