#pragma once
#include <cstdint>

#include "engine/chain.h"

namespace dmf::tools {

/// Chains in a periodic box of plain DPD beads, or between two closed sides in z. Single-threaded; reduced
/// units.
struct ChainRun {
  std::uint64_t seed = 1;
  double time_step = 0.01;  ///< tau
  engine::Integrator integrator = engine::Integrator::groot_warren;
  engine::Spring spring;
  std::uint32_t beads = 10;  ///< of a chain
  std::uint32_t chains = 10;
  double stretching_force = 0;        ///< along x, at both ends, k_BT / r_c
  double repulsion = 0;               ///< a, of all beads; 0: phantom chains, which feel friction and noise
  double density = 3;                 ///< of all beads; what the chains leave over is liquid
  engine::Vector3d size{0, 0, 0};     ///< of the box; 0: a cube that the chains alone fill
  bool channel = false;               ///< z sides closed: no slip
  double gravity = 0;                 ///< along x, r_c / tau^2
  double settle = 50, measure = 200;  ///< tau
  double interval = 1;                ///< between two looks, tau
};

struct ChainResult {
  double end_to_end_square = 0;  ///< <R^2>, r_c^2
  double gyration_square = 0;    ///< <R_g^2>, r_c^2
  double bond_square = 0;        ///< <b^2>, r_c^2
  double extension = 0;          ///< <R_x>, r_c
  double stretch_square = 0;     ///< <R_x^2>, r_c^2
  double relaxation = 0;         ///< time in which <R(t) R(0)> falls to 1/e, tau; 0: not within the run
  double off_centre = 0;         ///< mean distance of centroids from the middle plane, of half the height
  double temperature = 0;        ///< of what moves against the flow: across it, k_BT
  double speed = 0;              ///< mean along x, r_c / tau
};
ChainResult run_chains(const ChainRun& how);

/// Mean extension of a bond along a force that pulls it, by the partition function of one bond, and <b^2>
/// without any force (force 0). @param force  k_BT / r_c.
double thermal_extension(const engine::SpringLaw& law, double temperature, double force);
double thermal_square(const engine::SpringLaw& law, double temperature);

/// Time in which the end-to-end vector of a Rouse chain forgets itself, zeta N^2 <b^2> / (3 pi^2 k_BT) (Doi
/// and Edwards 1986, eq. 4.37), with the friction of a bead of plain DPD in its mean field,
/// zeta = 4 pi gamma rho / 90 for s = 2 (Groot and Warren 1997).
double rouse_time(std::uint32_t beads, double bond_square, double gamma, double density, double temperature);

}  // namespace dmf::tools
