#include "tools/membrane_run.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "engine/simulation.h"

namespace dmf::tools {
namespace {

using engine::MembraneObservation;
using engine::Side;
using engine::Vector3d;

engine::Parameters parameters_of(const MembraneRun& how) {
  engine::Parameters parameters;
  engine::Domain& domain = parameters.domain;
  domain.lower = Vector3d::Zero();
  domain.upper = Vector3d::Constant(2 * (how.radius + how.margin));
  domain.lower_side = domain.upper_side = {Side::periodic, Side::periodic, Side::periodic};
  parameters.liquid.attraction = how.repulsion;
  parameters.liquid.repulsion = 0;
  parameters.liquid.random_amplitude = 3;
  parameters.liquid.initial_density = parameters.liquid.bulk_density = 3;
  parameters.time_step = how.time_step;
  parameters.integrator = how.integrator;
  parameters.seed = how.seed;
  if (how.own_repulsion) {
    const double amplitude = parameters.liquid.random_amplitude;
    parameters.mixture.liquids = {{"membrane", {*how.own_repulsion, 0, amplitude}, 3, 3}};
    parameters.mixture.pairs = {{"liquid", "membrane", {how.liquid_on_membrane, 0, amplitude}}};
  }
  return parameters;
}

/// Whether a closed surface winds around a point: the sum of the solid angles of its triangles (van Oosterom
/// and Strackee 1983).
bool encloses(const MembraneObservation& membrane, const Vector3d& point) {
  double sum = 0;
  for (const auto& t : membrane.mesh->triangles) {
    const Vector3d a = membrane.positions[t[0]] - point, b = membrane.positions[t[1]] - point,
                   c = membrane.positions[t[2]] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(sum) > 2 * M_PI;
}

/// Along the shortest axis: thickness near the axis over the largest one of rings around it. NaN when no bead
/// is near the axis.
double centre_thickness(const MembraneObservation& membrane) {
  Eigen::Matrix3d gyration = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : membrane.positions)
    gyration += (p - membrane.centroid) * (p - membrane.centroid).transpose();
  const Vector3d axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(gyration).eigenvectors().col(0);
  double widest = 0;
  for (const Vector3d& p : membrane.positions) {
    const Vector3d from = p - membrane.centroid;
    widest = std::max(widest, (from - from.dot(axis) * axis).norm());
  }
  constexpr int rings = 5;
  double sum[rings] = {}, count[rings] = {};
  for (const Vector3d& p : membrane.positions) {
    const Vector3d from = p - membrane.centroid;
    const double height = from.dot(axis), out = (from - height * axis).norm();
    const int ring = std::min(rings - 1, static_cast<int>(rings * out / widest));
    sum[ring] += std::abs(height);
    ++count[ring];
  }
  double thickest = 0;
  for (int ring = 0; ring < rings; ++ring)
    if (count[ring] > 0) thickest = std::max(thickest, sum[ring] / count[ring]);
  return count[0] > 0 ? sum[0] / count[0] / thickest : NAN;
}

}  // namespace

std::set<std::uint32_t> enclosed_liquid(const engine::Snapshot& snapshot, const engine::Domain& domain) {
  const MembraneObservation& membrane = snapshot.membranes.at(0);
  const std::set<std::uint32_t> bound(membrane.beads.begin(), membrane.beads.end());
  std::set<std::uint32_t> result;
  for (std::size_t k = 0; k < snapshot.positions.size(); ++k) {
    if (bound.count(snapshot.bead_ids[k])) continue;
    const Vector3d at =
        membrane.centroid + domain.nearest_image(snapshot.positions[k].cast<double>() - membrane.centroid);
    if ((at.array() < membrane.lower.array()).any() || (at.array() > membrane.upper.array()).any()) continue;
    if (encloses(membrane, at)) result.insert(snapshot.bead_ids[k]);
  }
  return result;
}

MembraneResult run_membrane(const MembraneRun& how) {
  const engine::Parameters parameters = parameters_of(how);
  engine::Simulation simulation(parameters, engine::ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill_box();
  engine::TriangleMesh mesh =
      how.red_cell ? engine::red_cell(how.subdivisions, how.radius) : engine::icosphere(how.subdivisions);
  for (Vector3d& v : mesh.vertices)
    v = (how.red_cell ? 1.0 : how.radius) * v + Vector3d::Constant(how.radius + how.margin);
  const double area = engine::area(mesh), volume = engine::volume(mesh);
  const engine::MembraneNetwork network(mesh, how.stiffness);
  MembraneResult result;
  for (const auto& edge : network.edges())
    result.mean_edge +=
        (mesh.vertices[edge.b] - mesh.vertices[edge.a]).norm() / static_cast<double>(network.edges().size());
  simulation.add_membrane({std::make_shared<const engine::TriangleMesh>(std::move(mesh)), how.stiffness,
                           how.own_repulsion ? 1u : 0u});

  const auto steps_of = [&](double time) {
    return static_cast<std::uint64_t>(std::llround(time / how.time_step));
  };
  for (std::uint64_t k = 0; k < steps_of(how.settle); ++k) simulation.step();
  const std::set<std::uint32_t> before = enclosed_liquid(*simulation.observe({true}), parameters.domain);
  double looks = 0;
  for (std::uint64_t k = 1; k <= steps_of(how.measure); ++k) {
    simulation.step();
    if (k % steps_of(0.5) != 0) continue;
    const auto snapshot = simulation.observe();
    const MembraneObservation& seen = snapshot->membranes.at(0);
    result.area += seen.area / area;
    result.volume += seen.volume / volume;
    result.largest_area_error = std::max(result.largest_area_error, std::abs(seen.area / area - 1));
    result.largest_volume_error = std::max(result.largest_volume_error, std::abs(seen.volume / volume - 1));
    result.reduced_volume += seen.reduced_volume;
    result.gyration += seen.gyration_radii;
    result.temperature += snapshot->temperature;
    ++looks;
  }
  for (double* mean : {&result.area, &result.volume, &result.reduced_volume, &result.temperature})
    *mean /= looks;
  result.gyration /= looks;
  const auto last = simulation.observe({true});
  result.centre_thickness = centre_thickness(last->membranes.at(0));
  const std::set<std::uint32_t> after = enclosed_liquid(*last, parameters.domain);
  result.inside_before = static_cast<double>(before.size());
  result.inside_after = static_cast<double>(after.size());
  double crossed = 0;
  for (const std::uint32_t id : before) crossed += after.count(id) == 0;
  for (const std::uint32_t id : after) crossed += before.count(id) == 0;
  result.crossed = before.empty() ? 0 : crossed / static_cast<double>(before.size());
  return result;
}

}  // namespace dmf::tools
