#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/bonds/membrane_network.h"
#include "engine/bonds/mesh.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// A membrane to be placed: a closed surface of beads (bonds/membrane_network.h), where its mesh is. They
/// take the places of liquid beads as those of a chain do (chain.h): liquid that is there already stands
/// inside and outside of it.
struct MembranePlacement {
  std::shared_ptr<const TriangleMesh> mesh;  ///< in the chip's frame, r_c; 4 to 1e5 vertices
  MembraneStiffness stiffness;
  std::uint32_t species = 0;  ///< number of the liquid that its beads are of (mixture.h)
};

/// All that is wrong with a placement, each as "key: value, allowed: what would work": numbers out of range,
/// a mesh that is no closed surface, vertices outside the domain, edges too long for a periodic side, a
/// membrane that is too stiff for the time step.
std::vector<std::string> violations(const MembranePlacement& placement, const Parameters& parameters);

/// One membrane between two steps. Reduced units. Places are those in the image in which its first bead
/// stands.
struct MembraneObservation {
  std::uint32_t id = 0;                      ///< from 1, persistent, never used twice in a run
  std::vector<std::uint32_t> beads;          ///< ids, vertex by vertex
  std::shared_ptr<const TriangleMesh> mesh;  ///< as it was placed: whose triangles are its triangles
  std::vector<Vector3d> positions;           ///< of the vertices, continuous across periodic sides
  double area = 0, volume = 0;
  double reduced_volume = 0;             ///< 1: as much as its area can hold, that of a sphere
  Vector3d centroid = Vector3d::Zero();  ///< of the vertices
  Vector3d lower = Vector3d::Zero();     ///< bounding box
  Vector3d upper = Vector3d::Zero();
  /// Roots of the eigenvalues of the gyration tensor of its vertices, rising, r_c: two long and a short one
  /// are a disc, two short and a long one a rod.
  Vector3d gyration_radii = Vector3d::Zero();
  double longest_edge = 0;  ///< r_c
  MembraneEnergy energy;
};

}  // namespace dmf::engine
