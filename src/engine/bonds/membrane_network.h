#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "engine/bonds/mesh.h"
#include "engine/bonds/spring.h"

namespace dmf::engine {

/// How stiff a membrane is. Reduced units.
struct MembraneStiffness {
  SpringKind spring = SpringKind::wlc;  ///< along the edges: wlc with a repulsion, or harmonic
  double shear_modulus = 30;            ///< mu of the net, k_BT / r_c^2; (0, 1e5]
  double max_stretch = 2.2;             ///< of wlc: longest edge over that at rest; [1.2, 10]
  double bending_rigidity = 5;          ///< kappa, k_BT; [0, 1e5]
  bool flat = false;                    ///< unbent when flat; else in the shape in which it was placed
  double area_stiffness = 100;          ///< k_a, of the whole area, k_BT / r_c^2; [0, 1e6]
  double local_area_stiffness = 20;     ///< k_d, of every triangle, k_BT / r_c^2; [0, 1e6]
  double volume_stiffness = 100;        ///< k_v, k_BT / r_c^3; [0, 1e6]
  double volume_ratio = 1;              ///< of the volume that it strives for and that when placed; [0.1, 2]
};

/// What of a membrane's energy an edge, a bend, an area and the volume have, k_BT.
struct MembraneEnergy {
  double springs = 0, bending = 0, local_area = 0, area = 0, volume = 0;
  double total() const { return springs + bending + local_area + area + volume; }
};

/// The energy of a closed surface of beads, and its exact gradient (Fedosov, Caswell and Karniadakis 2010,
/// Biophys. J. 98, 2215, eqs. 3-8; Liu 4.4 only tells of it):
///
///   U = sum over edges U_spring(r) + sum over edges k_b [1 - cos(theta - theta_0)]
///     + k_a (A - A_0)^2 / (2 A_0) + sum over triangles k_d (a - a_0)^2 / (2 a_0) + k_v (V - V_0)^2 / (2 V_0)
///
/// Every edge is at rest at its length in the mesh, so that the shape is free of stress. theta is the angle
/// between the normals of both triangles at an edge, above 0 where the surface bulges out. What is given is
/// the moduli of a regular net: a spring's stiffness at rest is 4 mu / sqrt(3) (hexagonal net of springs that
/// are at rest), k_b = 2 kappa / sqrt(3) (Fedosov's eq. 14). Fedosov multiplies k_a and k_v with k_BT over
/// squares and cubes of the edge length; here they carry their units.
class MembraneNetwork {
 public:
  /// @pre violations(mesh) is empty.
  MembraneNetwork(const TriangleMesh& mesh, const MembraneStiffness& stiffness);

  MembraneEnergy energy(const std::vector<Vector3d>& positions) const;
  /// Adds -dU/dr to `forces`. @returns false, with forces of no meaning, when an edge is as long as its
  /// spring can be, or has no length.
  bool add_forces(const std::vector<Vector3d>& positions, std::vector<Vector3d>& forces) const;

  /// Fastest oscillation around the shape that it was made from, of beads of mass 1, 1 / tau.
  double highest_frequency(const std::vector<Vector3d>& positions) const;

  struct SpringEdge {
    std::uint32_t a, b;
    SpringLaw law;
  };
  const std::vector<SpringEdge>& edges() const { return edges_; }
  const std::vector<TriangleMesh::Triangle>& triangles() const { return triangles_; }
  double rest_area() const { return rest_area_; }
  double rest_volume() const { return rest_volume_; }

  /// For every vertex but the first, one that comes before it in `order()` and shares an edge: along them
  /// positions are followed across periodic sides.
  const std::vector<std::uint32_t>& order() const { return order_; }
  const std::vector<std::uint32_t>& predecessor() const { return predecessor_; }

 private:
  struct Bend {
    std::uint32_t a, b, c, d;  ///< triangles (a, b, c) and (b, a, d)
    double cos_rest, sin_rest;
  };
  void find_edges(const TriangleMesh& mesh, const MembraneStiffness& stiffness);
  void find_order(std::size_t vertices);

  MembraneStiffness stiffness_;
  double bending_ = 0;  ///< k_b
  std::vector<SpringEdge> edges_;
  std::vector<Bend> bends_;
  std::vector<TriangleMesh::Triangle> triangles_;
  std::vector<double> rest_areas_;
  double rest_area_ = 0, rest_volume_ = 0;
  std::vector<std::uint32_t> order_, predecessor_;
};

double area(const std::vector<Vector3d>& positions, const std::vector<TriangleMesh::Triangle>& triangles);
double volume(const std::vector<Vector3d>& positions, const std::vector<TriangleMesh::Triangle>& triangles);

}  // namespace dmf::engine
