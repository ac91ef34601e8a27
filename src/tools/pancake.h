#pragma once
#include <cstdint>

#include "engine/simulation.h"

namespace dmf::tools {

/// A droplet at rest between two plates of one wettability. Reduced units.
struct PancakeRun {
  double gap = 6;              ///< from plate to plate, r_c
  double contact_angle = 110;  ///< of both plates, degrees, through `curve`
  double radius = 12;          ///< of the footprint, about, r_c
  double settle = 60;          ///< tau before measuring
  double measure = 100;        ///< tau of measuring, a look every 0.2 tau
  std::uint64_t seed = 1;
  double time_step = 0.01;  ///< tau
};

struct PancakeResult {
  double density;        ///< in the middle, between the plates and far from the rim, beads per r_c^3
  double pressure;       ///< there, as the stress reads: too low by FilmResult::normal_pressure
  double wall_distance;  ///< half of what the liquid's height (beads of a column over that density) lacks to
                         ///< the gap
  double equator;        ///< radius where the density half-way between the plates falls to half, r_c
};

/// @throws engine::Instability, engine::InvalidInput.
PancakeResult run_pancake(const PancakeRun& run, const engine::ContactAngleCurve& curve);

/// Laplace pressure of an axisymmetric liquid bridge without gravity, for a surface tension of 1: the first
/// integral of Young and Laplace's equation, r sin(phi) = (p / 2) (r^2 - R^2) + R with the normal's slope phi
/// and the equator R, met by the contact angle on both plates.
/// @param height  of the liquid, at most about its radius; @param angle  degrees, of both plates; @param
/// equator  radius half-way between the plates.
double bridge_pressure(double height, double angle, double equator);

}  // namespace dmf::tools
