#pragma once
#include <cstdint>
#include <vector>

#include "chip/scene.h"

namespace dmf::tools {

/// Velocity along a duct of rectangular section without slip, at (y, z) from its axis, over the pressure
/// gradient divided by the viscosity (Boussinesq 1868; White, Viscous Fluid Flow, eq. 3-48).
/// @param half_y, half_z  half the sides of the section.
double duct_velocity(double y, double z, double half_y, double half_z);
/// Its mean over the section.
double mean_duct_velocity(double half_y, double half_z);

/// Liquid driven along a square channel of solid voxels (Chen 2010, 3.1: scene square_channel).
/// Single-threaded; reduced units.
struct DuctRun {
  chip::Scene scene;  ///< filled; the channel's axis is x, along which gravity acts
  std::uint64_t seed = 1;
  double settle = 150;   ///< tau before measuring
  double measure = 100;  ///< tau

  double acceleration() const { return scene.body_forces.gravity.x(); }  ///< r_c / tau^2
  double half_width() const;                                             ///< of the fluid, r_c
};

struct DuctResult {
  double mass_flow = 0;    ///< integral of rho u over the section, m / tau
  double temperature = 0;  ///< of motion across the flow, k_BT
  double viscosity = 0;    ///< from the fit, m / (r_c tau)
  double fitted_width =
      0;                 ///< half width at which the fitted profile vanishes, r_c: the channel's without slip
  double deviation = 0;  ///< root mean square, from the fit, of the largest velocity
  double densest = 0;    ///< of the cells next to a wall, over the mean
  double half_width = 0;                  ///< of the fluid, r_c
  int cells = 0;                          ///< of the section, along each side
  std::vector<double> velocity, density;  ///< by cell, y fastest
  double middle(int cell) const { return (cell + 0.5) * 2 * half_width / cells - half_width; }
};

/// Domain and solid of such a channel, of walls of four beads per r_c^3. @param half_width  a multiple of
/// 1/2.
void lay_duct(double length, double half_width, engine::Parameters& parameters);
/// The same of a scene that one liquid fills.
void lay_duct(double length, double half_width, chip::Scene& scene);

/// @throws engine::Instability.
DuctResult run_duct(const DuctRun& run);

}  // namespace dmf::tools
