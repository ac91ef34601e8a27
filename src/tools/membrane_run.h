#pragma once
#include <cstdint>
#include <optional>
#include <set>

#include "engine/membrane.h"
#include "engine/observe/snapshot.h"

namespace dmf::tools {

/// A membrane in the middle of a periodic box of plain DPD liquid. Single-threaded; reduced units.
struct MembraneRun {
  std::uint64_t seed = 1;
  double time_step = 0.01;
  engine::Integrator integrator = engine::Integrator::groot_warren;
  bool red_cell = false;  ///< else a sphere
  double radius = 3;
  int subdivisions = 3;
  engine::MembraneStiffness stiffness;
  double repulsion = 25;  ///< a; 0: liquid that feels friction and noise only, and goes through the membrane
  /// With it the membrane is of a species of its own, whose beads repel each other so; else it is of the
  /// liquid.
  std::optional<double> own_repulsion;
  double liquid_on_membrane = 25;  ///< a of liquid and such a membrane
  double margin = 2;               ///< from the membrane to the sides of the box
  double settle = 10, measure = 50;
};

struct MembraneResult {
  double mean_edge = 0;                                     ///< when placed, r_c
  double area = 0, volume = 0;                              ///< means, of those when placed
  double largest_area_error = 0, largest_volume_error = 0;  ///< of those when placed
  double reduced_volume = 0;                                ///< mean
  engine::Vector3d gyration = engine::Vector3d::Zero();     ///< mean radii, rising, r_c
  /// Thickness at the axis over the largest thickness: below 1 for a biconcave shape. Of what it looks like
  /// at the end, along its shortest axis; NaN when none of its few beads is near that.
  double centre_thickness = 0;
  double inside_before = 0, inside_after = 0;  ///< liquid beads
  double crossed =
      0;  ///< liquid beads that changed sides between start and end of `measure`, of those inside
  double temperature = 0;
};
MembraneResult run_membrane(const MembraneRun& how);

/// Ids of the beads inside the first membrane that are no part of it.
std::set<std::uint32_t> enclosed_liquid(const engine::Snapshot& snapshot, const engine::Domain& domain);

}  // namespace dmf::tools
