#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/bonds/spring.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// How the beads of a chain lie when it is placed.
enum class ChainShape {
  random_walk,  ///< every bond points anywhere
  straight      ///< along a direction
};

/// Chains to be placed: beads in a row, each bound to the next one by a spring (Liu 3.4). Reduced units. In a
/// liquid a chain's bead takes the place of the nearest bead within r_c, with its velocity, so that the
/// density stays as it is; elsewhere it is a new one.
struct ChainPlacement {
  Spring spring;
  /// Numbers of liquids (mixture.h): one of all beads, or one a bead from the first to the last. Empty: the
  /// first liquid. So a surfactant is a chain of a bead that likes the liquid and one that does not.
  std::vector<std::uint32_t> species;
  /// Where the beads of the one chain are, r_c. Empty: `count` chains of `beads` are placed in a box.
  std::vector<Vector3d> points;
  std::uint32_t count = 1;   ///< [1, 1e6]
  std::uint32_t beads = 10;  ///< of each chain; [2, 1e5]
  ChainShape shape = ChainShape::random_walk;
  double bond_length = 0;                   ///< when placed; above 0, below the spring's maximum, r_c
  Vector3d lower{0, 0, 0}, upper{0, 0, 0};  ///< the box that all beads lie in, r_c; inside the domain
  Vector3d direction{1, 0, 0};              ///< of straight chains; not zero
  /// Pulls the last bead this way and the first one the other way, k_BT / r_c: what tweezers do.
  Vector3d stretching_force = Vector3d::Zero();

  std::uint32_t species_of(std::size_t bead) const {
    return species.empty() ? 0 : species.size() == 1 ? species[0] : species[bead];
  }
};

/// The length at which bonds of this spring are placed when nobody says how long: that of rest, or half the
/// longest one, r_c.
double usual_bond_length(const Spring& spring);

/// All that is wrong with a placement, each as "key: value, allowed: what would work": numbers out of range,
/// beads farther apart than the spring's maximum, places outside the domain, liquids that are not there, a
/// spring that is too stiff for the time step. What else stands in its way is known only when it is placed.
std::vector<std::string> violations(const ChainPlacement& placement, const Parameters& parameters);

/// One chain between two steps. Reduced units.
struct ChainObservation {
  std::uint32_t id = 0;                    ///< from 1, persistent, never used twice in a run
  std::vector<std::uint32_t> beads;        ///< ids, from end to end
  std::vector<Vector3d> positions;         ///< continuous across periodic sides, r_c
  Vector3d end_to_end = Vector3d::Zero();  ///< from the first bead to the last, r_c
  Vector3d centroid = Vector3d::Zero();    ///< in the image in which the first bead stands, r_c
  double radius_of_gyration = 0;           ///< r_c
  double contour_length = 0;               ///< sum of all bonds, r_c
  double longest_bond = 0;                 ///< r_c
  double energy = 0;                       ///< of its springs, k_BT
};

}  // namespace dmf::engine
