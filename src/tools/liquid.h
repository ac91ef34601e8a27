#pragma once
#include <cstdint>

#include "engine/parameters.h"

namespace dmf::tools {

/// How to measure a liquid, the default one if nothing is said. Single-threaded; reduced units throughout.
struct LiquidRun {
  std::uint64_t seed = 1;
  double time_step = 0.01;  ///< tau
  double lambda = 0;        ///< of the integrator; 0: the engine's default
  bool quick = false;       ///< 20 to 30 tau instead of 300 to 400
  engine::Integrator integrator = engine::Integrator::groot_warren;
  double list_skin = 0;  ///< r_c; 0: the engine's default
  double measure = 0;    ///< tau of measuring; 0: as long as `quick` says
  engine::LiquidParameters liquid{};
  engine::SplineParameters spline{};  ///< Liu's conservative force in place of the liquid's own
  int bulk_cells = 14;                ///< of the lattice along each side of the bulk's box, four beads each
};

struct FilmResult {
  double density;  ///< in the middle of the film, beads per r_c^3
  double tension;  ///< k_BT / r_c^2
  /// P_zz inside, k_BT / r_c^3. A film at rest carries none; what is read here is the time step's error of
  /// the stress (docs/physics.md), to be taken off other pressures of the same liquid.
  double normal_pressure;
};
/// A film across a periodic box: tension from the stress that it carries (mechanical route),
/// gamma = (P_zz - (P_xx + P_yy) / 2) L_z / 2 for two surfaces.
FilmResult run_film(const LiquidRun& how);

struct FreeDropletResult {
  double density;   ///< inside, beads per r_c^3
  double pressure;  ///< inside, as the stress reads, k_BT / r_c^3
  double radius;    ///< equimolar, r_c: Laplace's tension is (pressure - film's normal_pressure) radius / 2
  double temperature;  ///< mean, k_BT
  double momentum;     ///< that it gathered by the end, m r_c / tau
};
/// A droplet in a periodic box without walls. @param radius  r_c, above 4.
FreeDropletResult run_free_droplet(const LiquidRun& how, double radius);

struct BulkResult {
  double density;      ///< of the box, beads per r_c^3
  double temperature;  ///< mean, k_BT
  double pressure;     ///< k_BT / r_c^3
  double viscosity;    ///< m / (r_c tau)
  double diffusivity;  ///< of a bead, r_c^2 / tau
};
/// Bulk liquid at its bulk_density. Viscosity from how fast transverse momentum waves of the equilibrium
/// decay, C(t) = exp(-mu k^2 t / rho) (Palmer 1994), between 0.8 and 0.3 of their start. Diffusivity from the
/// mean squared displacement between a quarter and the whole of the time (Einstein).
BulkResult run_bulk(const LiquidRun& how);

}  // namespace dmf::tools
