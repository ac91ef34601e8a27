#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/parameters.h"

namespace dmf::engine {

/// A surface of triangles. The corners of a triangle run counter-clockwise as seen from outside.
struct TriangleMesh {
  using Triangle = std::array<std::uint32_t, 3>;
  std::vector<Vector3d> vertices;  ///< r_c
  std::vector<Triangle> triangles;
};

/// Why a mesh is not one closed surface around a volume, each as "mesh: what, allowed: what would do": a
/// corner that is not there, a triangle without area, an edge without exactly two triangles, neighbours that
/// are oriented differently, normals that point inwards, vertices without triangles, more than one piece. At
/// most a few of each. An empty result: the mesh is sound.
std::vector<std::string> violations(const TriangleMesh& mesh);

double area(const TriangleMesh& mesh);    ///< r_c^2
double volume(const TriangleMesh& mesh);  ///< enclosed, above 0 when the normals point outwards, r_c^3

/// 6 sqrt(pi) V / A^(3/2): 1 for a sphere, less for every other shape.
double reduced_volume(double area, double volume);

/// Unit sphere: an icosahedron whose triangles are halved along each edge `subdivisions` times,
/// 10 * 4^subdivisions + 2 vertices. @param subdivisions  [0, 6]
TriangleMesh icosphere(int subdivisions);

/// The finest icosphere of this radius whose edges are 0.75 r_c long or longer in the mean, 6 at most: the
/// beads of a finer one repel each other so much that its area grows (docs/physics.md).
int usual_subdivisions(double radius);

/// Shape of a red blood cell at rest, around the z axis (Evans and Fung 1972, Microvasc. Res. 4, 335):
/// z = +- R/2 sqrt(1 - s^2) (c0 + c1 s^2 + c2 s^4), s the distance from the axis over R.
/// @param radius  R, half the diameter, r_c.
TriangleMesh red_cell(int subdivisions, double radius);

/// Vertices and triangles of a Wavefront OBJ file; larger faces are cut into triangles, all else in the file
/// is passed over.
/// @param name  stands for the file in messages.
/// @throws InvalidInput with the line that can't be read.
TriangleMesh parse_obj(const std::string& text, const std::string& name);

}  // namespace dmf::engine
