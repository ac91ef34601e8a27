#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace dmf::engine {

/// Numbers of beads that spread evenly over a sphere: 10 (h^2 + h k + k^2) + 2, the vertices of an
/// icosahedron whose faces are divided into triangles (Caspar and Klug 1962). 312 is (5, 1), 612 (5, 4), 1242
/// (10, 2).
bool is_shell_count(std::uint32_t beads);
/// The one nearest to a number.
std::uint32_t nearest_shell_count(double beads);

/// That many points on the unit sphere, spread evenly: on the divided icosahedron, then pushed apart until
/// the closest are nearly as far from each other as the farthest neighbours. Their centroid is the origin. A
/// function of the count alone, to the bit. @param beads  a shell count up to 20,000.
std::vector<Eigen::Vector3d> shell_points(std::uint32_t beads);

/// That many points evenly around the unit circle in the plane of x and z. A function of the count alone, to
/// the bit. @param beads  3 or more.
std::vector<Eigen::Vector3d> circle_points(std::uint32_t beads);

/// Reorders points so that consecutive ones lie close together, and cuts them into patches of at most
/// `largest` points. @returns where each patch ends.
std::vector<std::uint32_t> order_in_patches(std::vector<Eigen::Vector3d>& points, std::uint32_t largest);

}  // namespace dmf::engine
