#pragma once
#include <cstdint>

#include "engine/parameters.h"

namespace dmf::tools {

/// Two liquids, one above the other in a periodic box, that differ in nothing but what they do to each other.
/// Reduced units.
struct InterfaceRun {
  std::uint64_t seed = 1;
  double time_step = 0.01;            ///< tau
  engine::Vector3d size{10, 10, 20};  ///< r_c; half the height each
  engine::LiquidParameters liquid{};  ///< both
  double attraction_between = 0;      ///< A_ij or a_ij of the two; all else as in `liquid`
  engine::Integrator integrator = engine::Integrator::groot_warren;
  double relax = 40, measure = 200;  ///< tau
};

struct InterfaceResult {
  double tension;      ///< of one of the two interfaces, k_BT / r_c^2
  double temperature;  ///< mean, k_BT
  double strangers;    ///< share of each liquid's beads that stand in the middle third of the other's layer
};

/// Tension from the stress of the whole box, gamma = L_z (P_zz - (P_xx + P_yy) / 2) / 2: Irving and
/// Kirkwood's integral over both interfaces (Chen eq. 16). Of the pair forces alone: the kinetic part is the
/// same in all directions. Single-threaded.
InterfaceResult run_interface(const InterfaceRun& how);

}  // namespace dmf::tools
