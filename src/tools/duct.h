#pragma once
#include <cstdint>
#include <vector>

#include "engine/parameters.h"

namespace dmf::tools {

/// Velocity along a duct of rectangular section without slip, at (y, z) from its axis, over the pressure
/// gradient divided by the viscosity (Boussinesq 1868; White, Viscous Fluid Flow, eq. 3-48).
/// @param half_y, half_z  half the sides of the section.
double duct_velocity(double y, double z, double half_y, double half_z);
/// Its mean over the section.
double mean_duct_velocity(double half_y, double half_z);

/// Plain DPD driven along a square channel of solid voxels (Chen 2010, 3.1): 30 x 20 x 20 r_c, rho 4,
/// a 18.75, s 1/2, gamma 4.5, g 0.1 by default.
struct DuctRun {
  std::uint64_t seed = 1;
  double time_step = 0.01;
  double wall_repulsion = 9.68;  ///< a of fluid and wall, k_BT / r_c
  bool wall_friction = true;     ///< of fluid and wall; without it nothing but bouncing back holds the fluid
  double acceleration = 0.1;     ///< r_c / tau^2
  double length = 30;            ///< of the period along the channel, r_c
  double half_width = 10;        ///< r_c, a multiple of 1/2
  double settle = 150;           ///< tau before measuring
  double measure = 100;          ///< tau
};

struct DuctResult {
  double mass_flow = 0;    ///< integral of rho u over the section, m / tau
  double temperature = 0;  ///< of motion across the flow, k_BT
  double viscosity = 0;    ///< from the fit, m / (r_c tau)
  double fitted_width =
      0;                 ///< half width at which the fitted profile vanishes, r_c: the channel's without slip
  double deviation = 0;  ///< root mean square, from the fit, of the largest velocity
  double densest = 0;    ///< of the cells next to a wall, over the mean
  int cells = 0;         ///< of the section, along each side
  std::vector<double> velocity, density;  ///< by cell, y fastest
  double middle(int cell, double half_width) const {
    return (cell + 0.5) * 2 * half_width / cells - half_width;
  }
};

/// Domain and solid of such a channel.
void lay_duct(const DuctRun& run, engine::Parameters& parameters);

/// @throws engine::Instability.
DuctResult run_duct(const DuctRun& run);

}  // namespace dmf::tools
