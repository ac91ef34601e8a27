#pragma once
#include <cstdint>
#include <optional>

#include "engine/simulation.h"

namespace dmf::tools {

/// A microparticle that floats in the surface of a liquid film: how deep it sits is its contact angle.
struct FloatingRun {
  double attraction = -15;                ///< A_ls of the microparticle
  double radius = 1;                      ///< of the microparticle, r_c
  double surfactant = 0;                  ///< dimers in the film's surface (surfactant.h), 1 / r_c^2
  std::optional<double> tail_attraction;  ///< of their tails with the microparticle; none: its A_ls
  double settle = 60;                     ///< tau before measuring
  double measure = 100;                   ///< tau of measuring, a look every 0.2 tau
  std::uint64_t seed = 1;
  engine::Parameters parameters{};  ///< liquid, microparticles, time step; domain and seed are the run's own
};

struct FloatingResult {
  /// Through the liquid, degrees: cos = -height / effective_radius. 0 when it was swallowed, 180 when it came
  /// off.
  double angle = 0;
  double height = 0;            ///< of its centre over the film's surface (half the bulk density), mean, r_c
  double height_deviation = 0;  ///< from look to look
  double effective_radius = 0;  ///< where the liquid under it reaches half the bulk density, r_c
  double immersion = 0;         ///< mean
};

/// The film lies on a wetting wall, 6 r_c thick, in a box that is periodic to the sides.
/// @throws engine::Instability, engine::InvalidInput.
FloatingResult run_floating(const FloatingRun& run);

}  // namespace dmf::tools
