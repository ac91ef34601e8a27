#pragma once
#include <optional>
#include <string>
#include <vector>

#include "chip/scene.h"

namespace dmf::tools {

/// A dimensionless number of the simulated liquid and of water at the same length and speed.
struct Likeness {
  std::string name;  ///< with its formula
  double simulated = 0, water = 0;
  /// What is not to be trusted because of it, a sentence; empty when both are alike or do not matter.
  std::string therefore;
};

/// Ohnesorge, capillary, Bond, Reynolds and the thermal number of a droplet of a radius (r_c) that moves with
/// a speed (r_c/tau); docs/physics.md has the definitions.
std::vector<Likeness> likeness(const chip::Scene& scene, double radius, double speed);

/// From centre to centre of neighbouring electrodes, r_c: a board's own, else the median distance of an
/// electrode to the nearest one. Empty without electrodes.
std::optional<double> pitch_of(const chip::Scene& scene);

/// What a scene would simulate: beads, memory, units, and how far its dimensionless numbers are from water's
/// at the same size. Text for a person, several lines.
std::string explain(const chip::Scene& scene);

}  // namespace dmf::tools
