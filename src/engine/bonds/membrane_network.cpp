#include "engine/bonds/membrane_network.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace dmf::engine {
namespace {

using Triangle = TriangleMesh::Triangle;

/// Two triangles at an edge, seen along it.
struct Hinge {
  Vector3d edge, normal_1, normal_2;  ///< normals are as long as twice the areas
  double length, square_1, square_2;
  double cosine, sine;

  Hinge(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d)
      : edge(b - a), normal_1(edge.cross(c - a)), normal_2((d - a).cross(edge)) {
    length = edge.norm();
    square_1 = normal_1.squaredNorm();
    square_2 = normal_2.squaredNorm();
    const double both = std::sqrt(square_1 * square_2);
    cosine = normal_1.dot(normal_2) / both;
    sine = normal_1.cross(normal_2).dot(edge) / (both * length);
  }
};

Vector3d normal_of(const std::vector<Vector3d>& at, const Triangle& t) {
  return (at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]);
}

}  // namespace

double area(const std::vector<Vector3d>& positions, const std::vector<Triangle>& triangles) {
  double twice = 0;
  for (const Triangle& t : triangles) twice += normal_of(positions, t).norm();
  return 0.5 * twice;
}

double volume(const std::vector<Vector3d>& positions, const std::vector<Triangle>& triangles) {
  double six = 0;
  for (const Triangle& t : triangles) six += (positions[t[0]] - positions[0]).dot(normal_of(positions, t));
  return six / 6;
}

MembraneNetwork::MembraneNetwork(const TriangleMesh& mesh, const MembraneStiffness& stiffness)
    : stiffness_(stiffness),
      bending_(2 * stiffness.bending_rigidity / std::sqrt(3.0)),
      triangles_(mesh.triangles),
      rest_area_(dmf::engine::area(mesh)),
      rest_volume_(dmf::engine::volume(mesh) * stiffness.volume_ratio) {
  for (const Triangle& t : triangles_) rest_areas_.push_back(0.5 * normal_of(mesh.vertices, t).norm());
  find_edges(mesh, stiffness);
  find_order(mesh.vertices.size());
}

void MembraneNetwork::find_edges(const TriangleMesh& mesh, const MembraneStiffness& stiffness) {
  // The corner that lies across an edge, for the edge as a triangle runs along it.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> across;
  for (const Triangle& t : triangles_)
    for (int k = 0; k < 3; ++k) across[{t[k], t[(k + 1) % 3]}] = t[(k + 2) % 3];
  const double of_edge = 4 * stiffness.shear_modulus / std::sqrt(3.0);
  const std::vector<Vector3d>& at = mesh.vertices;
  for (const auto& [edge, c] : across) {
    const auto [a, b] = edge;
    if (a > b) continue;
    const std::uint32_t d = across.at({b, a});
    const double rest = (at[b] - at[a]).norm();
    const SpringLaw law = stiffness.spring == SpringKind::wlc
                              ? SpringLaw::worm_like_with_repulsion(rest, of_edge, stiffness.max_stretch)
                              : SpringLaw{SpringKind::harmonic, of_edge, rest, 0};
    edges_.push_back({a, b, law});
    const Hinge hinge(at[a], at[b], at[c], at[d]);
    bends_.push_back({a, b, c, d, stiffness.flat ? 1.0 : hinge.cosine, stiffness.flat ? 0.0 : hinge.sine});
  }
}

void MembraneNetwork::find_order(std::size_t vertices) {
  std::vector<std::vector<std::uint32_t>> neighbours(vertices);
  for (const SpringEdge& edge : edges_) {
    neighbours[edge.a].push_back(edge.b);
    neighbours[edge.b].push_back(edge.a);
  }
  predecessor_.assign(vertices, 0);
  std::vector<bool> seen(vertices, false);
  order_ = {0};
  seen[0] = true;
  for (std::size_t k = 0; k < order_.size(); ++k)
    for (const std::uint32_t next : neighbours[order_[k]]) {
      if (seen[next]) continue;
      seen[next] = true;
      predecessor_[next] = order_[k];
      order_.push_back(next);
    }
}

MembraneEnergy MembraneNetwork::energy(const std::vector<Vector3d>& at) const {
  MembraneEnergy energy;
  for (const SpringEdge& edge : edges_)
    energy.springs +=
        edge.law.energy((at[edge.b] - at[edge.a]).norm()) - edge.law.energy(edge.law.rest_length());
  for (const Bend& bend : bends_) {
    const Hinge hinge(at[bend.a], at[bend.b], at[bend.c], at[bend.d]);
    energy.bending += bending_ * (1 - hinge.cosine * bend.cos_rest - hinge.sine * bend.sin_rest);
  }
  double total = 0;
  for (std::size_t k = 0; k < triangles_.size(); ++k) {
    const double now = 0.5 * normal_of(at, triangles_[k]).norm(), more = now - rest_areas_[k];
    energy.local_area += 0.5 * stiffness_.local_area_stiffness * more * more / rest_areas_[k];
    total += now;
  }
  const double more_area = total - rest_area_, more_volume = volume(at, triangles_) - rest_volume_;
  energy.area = 0.5 * stiffness_.area_stiffness * more_area * more_area / rest_area_;
  energy.volume = 0.5 * stiffness_.volume_stiffness * more_volume * more_volume / rest_volume_;
  return energy;
}

bool MembraneNetwork::add_forces(const std::vector<Vector3d>& at, std::vector<Vector3d>& forces) const {
  for (const SpringEdge& edge : edges_) {
    const Vector3d apart = at[edge.b] - at[edge.a];
    const double r = apart.norm();
    if (!(r > 0 && r < edge.law.max_length())) return false;
    const Vector3d pull = edge.law.tension(r) / r * apart;
    forces[edge.a] += pull;
    forces[edge.b] -= pull;
  }
  if (bending_ > 0)
    for (const Bend& bend : bends_) {
      const Vector3d &a = at[bend.a], &b = at[bend.b], &c = at[bend.c], &d = at[bend.d];
      const Hinge hinge(a, b, c, d);
      if (!(hinge.square_1 > 0 && hinge.square_2 > 0)) return false;
      const double torque = bending_ * (hinge.sine * bend.cos_rest - hinge.cosine * bend.sin_rest);
      // d theta / dc = -|e| n_1 / n_1^2, the same of d; a and b take the rest, so that the sum is zero.
      const Vector3d per_1 = hinge.normal_1 / hinge.square_1, per_2 = hinge.normal_2 / hinge.square_2;
      const Vector3d along = hinge.edge / hinge.length;
      forces[bend.c] += torque * hinge.length * per_1;
      forces[bend.d] += torque * hinge.length * per_2;
      forces[bend.a] -= torque * ((b - c).dot(along) * per_1 + (b - d).dot(along) * per_2);
      forces[bend.b] -= torque * ((c - a).dot(along) * per_1 + (d - a).dot(along) * per_2);
    }
  const double pressure =
      stiffness_.volume_stiffness * (volume(at, triangles_) - rest_volume_) / rest_volume_;
  const double tension = stiffness_.area_stiffness * (area(at, triangles_) - rest_area_) / rest_area_;
  const Vector3d& origin = at[0];
  for (std::size_t k = 0; k < triangles_.size(); ++k) {
    const auto& [i, j, l] = triangles_[k];
    const Vector3d normal = normal_of(at, triangles_[k]);
    const double twice_area = normal.norm();
    if (!(twice_area > 0)) return false;
    const double of_this =
        stiffness_.local_area_stiffness * (0.5 * twice_area - rest_areas_[k]) / rest_areas_[k];
    // dA/da = 1/2 (b - c) x n / |n|, dV/da = (b x c) / 6.
    const Vector3d per_area = -0.5 * (tension + of_this) / twice_area * normal;
    const Vector3d a = at[i] - origin, b = at[j] - origin, c = at[l] - origin;
    const double per_volume = -pressure / 6;
    forces[i] += (b - c).cross(per_area) + per_volume * b.cross(c);
    forces[j] += (c - a).cross(per_area) + per_volume * c.cross(a);
    forces[l] += (a - b).cross(per_area) + per_volume * a.cross(b);
  }
  return true;
}

double MembraneNetwork::highest_frequency(const std::vector<Vector3d>& at) const {
  // Largest eigenvalue of the second derivatives by power iteration; the derivative along a direction is the
  // difference of two forces.
  const std::size_t n = at.size();
  constexpr double small = 1e-5;
  std::vector<Vector3d> direction(n), moved(n), plus(n), minus(n);
  for (std::size_t k = 0; k < n; ++k)  // without symmetry: every mode has a share in it
    direction[k] = Vector3d(1 + k % 7, -2.0 + k % 5, -1.0 + k % 3);
  double eigenvalue = 0;
  for (int iteration = 0; iteration < 100; ++iteration) {
    double square = 0;
    for (const Vector3d& d : direction) square += d.squaredNorm();
    if (square == 0) return 0;
    const double scale = 1 / std::sqrt(square);
    for (Vector3d& d : direction) d *= scale;
    for (const double sign : {1.0, -1.0}) {
      std::vector<Vector3d>& force = sign > 0 ? plus : minus;
      std::fill(force.begin(), force.end(), Vector3d::Zero());
      for (std::size_t k = 0; k < n; ++k) moved[k] = at[k] + sign * small * direction[k];
      add_forces(moved, force);
    }
    eigenvalue = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const Vector3d next = (minus[k] - plus[k]) / (2 * small);
      eigenvalue += next.dot(direction[k]);
      direction[k] = next;
    }
  }
  return std::sqrt(std::max(0.0, eigenvalue));
}

}  // namespace dmf::engine
