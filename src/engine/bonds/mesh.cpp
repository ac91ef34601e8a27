#include "engine/bonds/mesh.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>
#include <utility>

namespace dmf::engine {
namespace {

using Triangle = TriangleMesh::Triangle;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

constexpr std::size_t most_told = 3;  ///< violations of one kind

/// Twice the area, along the normal.
Vector3d normal_of(const TriangleMesh& mesh, const Triangle& t) {
  const Vector3d& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

class Findings {
 public:
  void add(std::size_t kind, std::string text) {
    if (told_[kind]++ < most_told) found_.push_back("mesh: " + std::move(text));
  }
  bool none() const { return found_.empty(); }
  std::vector<std::string> take() { return std::move(found_); }

 private:
  std::map<std::size_t, std::size_t> told_;
  std::vector<std::string> found_;
};

enum Kind : std::size_t { corners, flat, edges, orientation, unused, whole };

void check_triangles(const TriangleMesh& mesh, Findings& found) {
  if (mesh.triangles.size() < 4)
    found.add(whole, fmt::format("{} triangles, allowed: 4 or more", mesh.triangles.size()));
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (!mesh.vertices[v].allFinite())
      found.add(corners, fmt::format("vertex {} is at no number, allowed: finite", v));
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
    for (const std::uint32_t v : mesh.triangles[k])
      if (v >= mesh.vertices.size())
        found.add(corners, fmt::format("triangle {} has vertex {}, allowed: 0 to {}", k, v,
                                       static_cast<std::ptrdiff_t>(mesh.vertices.size()) - 1));
}

void check_areas(const TriangleMesh& mesh, Findings& found) {
  const double mean = area(mesh) / static_cast<double>(mesh.triangles.size());
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const double of_this = 0.5 * normal_of(mesh, mesh.triangles[k]).norm();
    if (!(of_this > 1e-4 * mean))
      found.add(flat, fmt::format("triangle {} is degenerate: its area is {:.3g} r_c^2, allowed: more than "
                                  "{:.3g}, a ten-thousandth of the mean",
                                  k, of_this, 1e-4 * mean));
  }
}

/// Every edge once in each direction.
void check_edges(const TriangleMesh& mesh, Findings& found) {
  std::map<Edge, std::array<std::size_t, 2>> along;  // how often, from the smaller vertex and from the larger
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k], to = t[(k + 1) % 3];
      ++along.try_emplace({std::min(from, to), std::max(from, to)}, std::array<std::size_t, 2>{})
            .first->second[from < to ? 0 : 1];
    }
  for (const auto& [edge, times] : along) {
    if (times[0] + times[1] != 2)
      found.add(edges,
                fmt::format("is not closed: the edge of vertices {} and {} has {} triangles, allowed: 2",
                            edge.first, edge.second, times[0] + times[1]));
    else if (times[0] != 1)
      found.add(orientation,
                fmt::format("both triangles at the edge of vertices {} and {} run along it the same "
                            "way, allowed: all counter-clockwise as seen from outside",
                            edge.first, edge.second));
  }
}

void check_pieces(const TriangleMesh& mesh, Findings& found) {
  std::vector<std::uint32_t> root(mesh.vertices.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto root_of = [&root](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) {
      used[v] = true;
      root[root_of(v)] = root_of(t[0]);
    }
  std::size_t pieces = 0;
  for (std::uint32_t v = 0; v < used.size(); ++v) {
    if (!used[v])
      found.add(unused, fmt::format("vertex {} belongs to no triangle, allowed: every one to some", v));
    if (used[v] && root_of(v) == v) ++pieces;
  }
  if (pieces > 1) found.add(whole, fmt::format("{} separate pieces, allowed: 1", pieces));
}

/// Adds the middle of every edge, on the unit sphere.
TriangleMesh halved(const TriangleMesh& coarse) {
  TriangleMesh fine{coarse.vertices, {}};
  std::map<Edge, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [found, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)},
                                                    static_cast<std::uint32_t>(fine.vertices.size()));
    if (fresh) fine.vertices.push_back((fine.vertices[a] + fine.vertices[b]).normalized());
    return found->second;
  };
  for (const auto& [a, b, c] : coarse.triangles) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const Triangle& t : {Triangle{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}})
      fine.triangles.push_back(t);
  }
  return fine;
}

}  // namespace

std::vector<std::string> violations(const TriangleMesh& mesh) {
  Findings found;
  check_triangles(mesh, found);
  if (!found.none()) return found.take();
  check_areas(mesh, found);
  check_edges(mesh, found);
  check_pieces(mesh, found);
  if (found.none() && !(volume(mesh) > 0))
    found.add(whole, "its triangles face inwards, allowed: counter-clockwise as seen from outside");
  return found.take();
}

double area(const TriangleMesh& mesh) {
  double twice = 0;
  for (const Triangle& t : mesh.triangles) twice += normal_of(mesh, t).norm();
  return 0.5 * twice;
}

double volume(const TriangleMesh& mesh) {
  double six = 0;
  if (mesh.vertices.empty()) return 0;
  const Vector3d origin = mesh.vertices.front();
  for (const Triangle& t : mesh.triangles) six += (mesh.vertices[t[0]] - origin).dot(normal_of(mesh, t));
  return six / 6;
}

double reduced_volume(double area, double volume) {
  constexpr double root_of_pi = 1.77245385090551602730;
  return 6 * root_of_pi * volume / (area * std::sqrt(area));
}

TriangleMesh icosphere(int subdivisions) {
  // Corners of three golden rectangles at right angles.
  const double golden = 0.5 * (1 + std::sqrt(5.0));
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double wide : {1.0, -1.0})
      for (const double high : {golden, -golden}) {
        Vector3d corner;
        corner[axis] = 0;
        corner[(axis + 1) % 3] = wide;
        corner[(axis + 2) % 3] = high;
        mesh.vertices.push_back(corner.normalized());
      }
  // Corners at the distance of an edge make its twenty triangles.
  const double edge = (mesh.vertices[0] - mesh.vertices[2]).norm();
  const auto near = [&](std::uint32_t a, std::uint32_t b) {
    return (mesh.vertices[a] - mesh.vertices[b]).norm() < 1.1 * edge;
  };
  for (std::uint32_t a = 0; a < 12; ++a)
    for (std::uint32_t b = a + 1; b < 12; ++b)
      for (std::uint32_t c = b + 1; c < 12; ++c)
        if (near(a, b) && near(b, c) && near(c, a)) {
          const Triangle t{a, b, c};
          const bool outwards = normal_of(mesh, t).dot(mesh.vertices[a]) > 0;
          mesh.triangles.push_back(outwards ? t : Triangle{a, c, b});
        }
  for (int k = 0; k < subdivisions; ++k) mesh = halved(mesh);
  return mesh;
}

int usual_subdivisions(double radius) {
  constexpr double shortest = 0.75;            // r_c
  constexpr double edge_of_icosahedron = 1.2;  // of equilateral triangles that cover the unit sphere
  int subdivisions = 0;
  for (double edge = edge_of_icosahedron * radius / 2; edge >= shortest && subdivisions < 6; edge /= 2)
    ++subdivisions;
  return subdivisions;
}

TriangleMesh red_cell(int subdivisions, double radius) {
  constexpr double c0 = 0.207161, c1 = 2.002558, c2 = -1.122762;
  TriangleMesh mesh = icosphere(subdivisions);
  for (Vector3d& v : mesh.vertices) {
    // On the unit sphere z is sqrt(1 - s^2).
    const double s2 = v.x() * v.x() + v.y() * v.y();
    v = radius * Vector3d(v.x(), v.y(), 0.5 * v.z() * (c0 + c1 * s2 + c2 * s2 * s2));
  }
  return mesh;
}

TriangleMesh parse_obj(const std::string& text, const std::string& name) {
  TriangleMesh mesh;
  std::istringstream lines(text);
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    const auto refuse = [&](const char* allowed) {
      throw InvalidInput(fmt::format("{}:{}: {}, allowed: {}", name, number, line.substr(0, 80), allowed));
    };
    if (kind == "v") {
      Vector3d v;
      if (!(words >> v.x() >> v.y() >> v.z()) || !v.allFinite()) refuse("v with three numbers");
      mesh.vertices.push_back(v);
    } else if (kind == "f") {
      std::vector<std::uint32_t> corners;
      // "7", "7/2" and "7/2/3" all name vertex 7; below 0 they count from the last vertex.
      for (std::string word; words >> word;) {
        long long index = 0;
        try {
          index = std::stoll(word);
        } catch (const std::exception&) {
          refuse("f with numbers of vertices");
        }
        if (index < 0) index += static_cast<long long>(mesh.vertices.size()) + 1;
        if (index < 1 || index > static_cast<long long>(mesh.vertices.size()))
          refuse("f with numbers of vertices that stand above it, from 1");
        corners.push_back(static_cast<std::uint32_t>(index - 1));
      }
      if (corners.size() < 3) refuse("f with three vertices or more");
      for (std::size_t k = 1; k + 1 < corners.size(); ++k)
        mesh.triangles.push_back({corners[0], corners[k], corners[k + 1]});
    }
  }
  return mesh;
}

}  // namespace dmf::engine
