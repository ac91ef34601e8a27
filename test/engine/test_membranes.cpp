// Closed meshes, the energies of membranes and their gradients, membranes in a liquid.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "engine/bonds/membrane_network.h"
#include "engine/simulation.h"
#include "refusal.h"
#include "systems.h"

namespace dmf::engine {
namespace {

TriangleMesh sphere(int subdivisions, double radius, const Vector3d& centre = Vector3d::Zero()) {
  TriangleMesh mesh = icosphere(subdivisions);
  for (Vector3d& v : mesh.vertices) v = centre + radius * v;
  return mesh;
}

/// Every vertex pushed somewhere by up to `by` along each axis.
std::vector<Vector3d> shaken(const TriangleMesh& mesh, double by) {
  std::vector<Vector3d> at = mesh.vertices;
  std::uint32_t k = 0;
  for (Vector3d& v : at)
    for (double& component : v) component += by * (2 * scatter(k++) - 1);
  return at;
}

/// All of no stiffness but for what is set.
MembraneStiffness soft() {
  MembraneStiffness s;
  s.shear_modulus = 1e-9;
  s.bending_rigidity = s.area_stiffness = s.local_area_stiffness = s.volume_stiffness = 0;
  return s;
}

MembranePlacement placed(TriangleMesh mesh, const MembraneStiffness& stiffness = {}) {
  return {std::make_shared<const TriangleMesh>(std::move(mesh)), stiffness};
}

TEST(Meshes, SpheresComeNearToSpheres) {
  for (int subdivisions = 0; subdivisions <= 4; ++subdivisions) {
    const TriangleMesh mesh = icosphere(subdivisions);
    const std::size_t faces = 20u << (2 * subdivisions);
    EXPECT_EQ(mesh.triangles.size(), faces);
    EXPECT_EQ(mesh.vertices.size(), faces / 2 + 2);  // Euler
    EXPECT_TRUE(violations(mesh).empty()) << violations(mesh).front();
  }
  // Of a polyhedron in the sphere: off by the square of the edge.
  EXPECT_NEAR(volume(icosphere(4)), 4 * M_PI / 3, 0.01 * 4 * M_PI / 3);
  EXPECT_NEAR(area(icosphere(4)), 4 * M_PI, 0.01 * 4 * M_PI);
  EXPECT_NEAR(reduced_volume(area(icosphere(4)), volume(icosphere(4))), 1, 0.005);
}

TEST(Meshes, ARedCellHasTheAreaAndVolumeOfEvansAndFung) {
  // Their table 1, of 50 cells of diameter 7.82 um: 135 um^2 and 94 um^3.
  const TriangleMesh mesh = red_cell(4, 3.91);
  EXPECT_TRUE(violations(mesh).empty());
  EXPECT_NEAR(area(mesh), 135, 2);
  EXPECT_NEAR(volume(mesh), 94, 1.5);
  EXPECT_NEAR(reduced_volume(area(mesh), volume(mesh)), 0.64, 0.01);
  double highest = 0, at_centre = 10;
  for (const Vector3d& v : mesh.vertices) {
    highest = std::max(highest, v.z());
    if (v.head<2>().norm() < 0.5 && v.z() > 0) at_centre = std::min(at_centre, v.z());
  }
  // 0.81 um thick at the centre, 2.57 um at most.
  EXPECT_NEAR(2 * at_centre, 0.81, 0.15);
  EXPECT_NEAR(2 * highest, 2.57, 0.05);
}

TEST(Meshes, ThatAreNoClosedSurfaceAreNamed) {
  const auto told = [](auto change) {
    TriangleMesh mesh = sphere(1, 2);
    change(mesh);
    std::string all;
    for (const std::string& line : violations(mesh)) all += line + "\n";
    return all;
  };
  EXPECT_TRUE(
      holds(told([](auto& m) { m.triangles.pop_back(); }), "mesh: is not closed: the edge of vertices"));
  EXPECT_TRUE(holds(told([](auto& m) { m.triangles.pop_back(); }), "has 1 triangles, allowed: 2"));
  EXPECT_TRUE(
      holds(told([](auto& m) { m.triangles.push_back(m.triangles[3]); }), "has 3 triangles, allowed: 2"));
  EXPECT_TRUE(holds(told([](auto& m) { std::swap(m.triangles[5][0], m.triangles[5][1]); }),
                    "run along it the same way, allowed: all counter-clockwise"));
  EXPECT_TRUE(holds(told([](auto& m) {
                      for (auto& t : m.triangles) std::swap(t[0], t[1]);
                    }),
                    "its triangles face inwards"));
  EXPECT_TRUE(holds(told([](auto& m) { m.vertices[m.triangles[7][0]] = m.vertices[m.triangles[7][1]]; }),
                    "triangle 7 is degenerate: its area is 0 r_c^2"));
  EXPECT_TRUE(
      holds(told([](auto& m) { m.triangles[2][1] = 42; }), "triangle 2 has vertex 42, allowed: 0 to 41"));
  EXPECT_TRUE(holds(told([](auto& m) {
                      m.vertices.push_back({9, 9, 9});
                    }),
                    "vertex 42 belongs to no triangle"));
  EXPECT_TRUE(holds(told([](auto& m) { m.vertices[4].x() = NAN; }), "vertex 4 is at no number"));
  EXPECT_TRUE(holds(told([](auto& m) {
                      const TriangleMesh other = sphere(0, 1, {9, 0, 0});
                      for (auto t : other.triangles) {
                        for (auto& v : t) v += 42;
                        m.triangles.push_back(t);
                      }
                      m.vertices.insert(m.vertices.end(), other.vertices.begin(), other.vertices.end());
                    }),
                    "2 separate pieces, allowed: 1"));
}

TEST(Meshes, AreReadFromObjFiles) {
  const TriangleMesh cube = parse_obj(
      "# a cube\no cube\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvn 0 0 1\n"
      "f 4 3 2 1\nf 5/1 6/2 7/3 8/4\nf 1//1 2//1 6//1 5//1\nf 2 3 7 6\nf 3 4 8 7\nf -8 -4 -1 -5\n",
      "cube.obj");
  EXPECT_TRUE(violations(cube).empty());
  EXPECT_DOUBLE_EQ(volume(cube), 1);
  EXPECT_DOUBLE_EQ(area(cube), 6);
  EXPECT_TRUE(holds(refusal([] { parse_obj("v 0 0 0\nv 1 nothing\n", "bad.obj"); }),
                    "bad.obj:2: v 1 nothing, allowed: v with three numbers"));
  EXPECT_TRUE(holds(refusal([] { parse_obj("v 0 0 0\nf 1 2 3\n", "bad.obj"); }),
                    "bad.obj:2: f 1 2 3, allowed: f with numbers of vertices that stand above it"));
  EXPECT_TRUE(holds(refusal([] { parse_obj("v 0 0 0\nf 1 1\n", "bad.obj"); }), "three vertices or more"));
  EXPECT_TRUE(
      holds(refusal([] { parse_obj("v 0 0 0\nf a b c\n", "bad.obj"); }), "f with numbers of vertices"));
}

TEST(Membranes, ForcesAreTheGradientOfEachEnergy) {
  struct Term {
    const char* name;
    void (*set)(MembraneStiffness&);
    double (*of)(const MembraneEnergy&);
  };
  const Term terms[] = {
      {"wlc", [](auto& s) { s.shear_modulus = 30; }, [](const auto& e) { return e.springs; }},
      {"harmonic", [](auto& s) { s.shear_modulus = 30, s.spring = SpringKind::harmonic; },
       [](const auto& e) { return e.springs; }},
      {"bending", [](auto& s) { s.bending_rigidity = 20; }, [](const auto& e) { return e.bending; }},
      {"flat bending", [](auto& s) { s.bending_rigidity = 20, s.flat = true; },
       [](const auto& e) { return e.bending; }},
      {"area", [](auto& s) { s.area_stiffness = 100; }, [](const auto& e) { return e.area; }},
      {"local area", [](auto& s) { s.local_area_stiffness = 50; },
       [](const auto& e) { return e.local_area; }},
      {"volume", [](auto& s) { s.volume_stiffness = 100, s.volume_ratio = 0.8; },
       [](const auto& e) { return e.volume; }}};
  const TriangleMesh mesh = sphere(1, 2, {3, -4, 5});
  std::vector<Vector3d> at = shaken(mesh, 0.15);
  for (const Term& term : terms) {
    MembraneStiffness stiffness = soft();
    term.set(stiffness);
    const MembraneNetwork network(mesh, stiffness);
    std::vector<Vector3d> forces(at.size(), Vector3d::Zero());
    ASSERT_TRUE(network.add_forces(at, forces));
    double largest = 0, apart = 0;
    for (std::size_t k = 0; k < at.size(); ++k)
      for (int axis = 0; axis < 3; ++axis) {
        const double h = 1e-5, there = at[k][axis];
        at[k][axis] = there + h;
        const double above = term.of(network.energy(at));
        at[k][axis] = there - h;
        const double below = term.of(network.energy(at));
        at[k][axis] = there;
        largest = std::max(largest, std::abs(forces[k][axis]));
        apart = std::max(apart, std::abs(forces[k][axis] + (above - below) / (2 * h)));
      }
    EXPECT_GT(largest, 0.1) << term.name;
    EXPECT_LT(apart, 1e-6 * largest) << term.name;
    Vector3d sum = Vector3d::Zero(), torque = Vector3d::Zero();
    for (std::size_t k = 0; k < at.size(); ++k) {
      sum += forces[k];
      torque += at[k].cross(forces[k]);
    }
    EXPECT_LT(sum.norm(), 1e-11 * largest * static_cast<double>(at.size())) << term.name;
    EXPECT_LT(torque.norm(), 1e-10 * largest * static_cast<double>(at.size())) << term.name;
  }
}

TEST(Membranes, AreFreeOfStressInTheShapeTheyWereMadeFrom) {
  const TriangleMesh mesh = red_cell(2, 4);
  const MembraneNetwork network(mesh, {});
  std::vector<Vector3d> forces(mesh.vertices.size(), Vector3d::Zero());
  ASSERT_TRUE(network.add_forces(mesh.vertices, forces));
  for (const Vector3d& force : forces) EXPECT_LT(force.norm(), 1e-8);
  EXPECT_NEAR(network.energy(mesh.vertices).total(), 0, 1e-8);
}

TEST(Membranes, ResistDilationAsANetOfTheirShearModulus) {
  // A net of springs at rest has K = 2 mu: blown up by 1 + e it holds 2 K e^2 A.
  for (const SpringKind kind : {SpringKind::wlc, SpringKind::harmonic}) {
    MembraneStiffness stiffness = soft();
    stiffness.spring = kind;
    stiffness.shear_modulus = 40;
    const TriangleMesh mesh = sphere(3, 3);
    const double e = 1e-4;
    const double energy = MembraneNetwork(mesh, stiffness).energy(sphere(3, 3 * (1 + e)).vertices).springs;
    // The icosphere's triangles are not quite equilateral.
    EXPECT_NEAR(energy, 2 * (2 * 40) * e * e * area(mesh), 0.02 * energy);
  }
}

TEST(Membranes, BendAsSeungAndNelsonSay) {
  // k_b (1 - cos theta) over the edges of a regular net is a sheet of kappa = sqrt(3)/2 k_b with a Gaussian
  // modulus of -4/3 kappa (Seung and Nelson 1988): a sphere holds 4 pi (2 - 4/3) kappa, whatever its radius.
  MembraneStiffness stiffness = soft();
  stiffness.bending_rigidity = 20;
  stiffness.flat = true;
  for (const double radius : {2.0, 5.0}) {
    const TriangleMesh mesh = sphere(4, radius);
    const double energy = MembraneNetwork(mesh, stiffness).energy(mesh.vertices).bending;
    EXPECT_NEAR(energy, 8 * M_PI / 3 * 20, 0.05 * energy);
    // That the icosphere's triangles are not equilateral, however fine it is, makes the rest: the angle at an
    // edge is the distance between the circumcentres of its triangles over the radius, half the edge times
    // the cotangents of the angles across it.
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> dual;
    for (const auto& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) {
        const Vector3d &a = mesh.vertices[t[k]], &b = mesh.vertices[t[(k + 1) % 3]];
        const Vector3d p = a - mesh.vertices[t[(k + 2) % 3]], q = b - mesh.vertices[t[(k + 2) % 3]];
        dual[std::minmax(t[k], t[(k + 1) % 3])] += 0.5 * (a - b).norm() * p.dot(q) / p.cross(q).norm();
      }
    double expected = 0;
    for (const auto& [edge, length] : dual)
      expected += 20 / std::sqrt(3.0) * length * length / (radius * radius);
    EXPECT_NEAR(energy, expected, 0.005 * energy);
  }
}

TEST(Membranes, KnowTheirFastestOscillation) {
  const TriangleMesh mesh = sphere(1, 2);
  MembraneStiffness stiffness;
  const MembraneNetwork network(mesh, stiffness);
  const std::size_t n = mesh.vertices.size();
  Eigen::MatrixXd second(3 * n, 3 * n);
  const double h = 1e-5;
  for (std::size_t j = 0; j < 3 * n; ++j) {
    std::vector<Vector3d> at = mesh.vertices, plus(n, Vector3d::Zero()), minus(n, Vector3d::Zero());
    at[j / 3][j % 3] += h;
    ASSERT_TRUE(network.add_forces(at, plus));
    at[j / 3][j % 3] -= 2 * h;
    ASSERT_TRUE(network.add_forces(at, minus));
    for (std::size_t i = 0; i < 3 * n; ++i) second(i, j) = (minus[i / 3] - plus[i / 3])[i % 3] / (2 * h);
  }
  EXPECT_LT((second - second.transpose()).norm(), 1e-4 * second.norm());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (second + second.transpose()));
  const double exact = std::sqrt(solver.eigenvalues().maxCoeff());
  EXPECT_NEAR(network.highest_frequency(mesh.vertices), exact, 0.02 * exact);
  // No mode of the shape at rest is unstable; six of them are motions of the whole.
  EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-3);
  EXPECT_LT(std::abs(solver.eigenvalues()[5]), 1e-3);
  EXPECT_GT(solver.eigenvalues()[6], 1e-2);
}

Parameters plain_dpd(double size) {
  Parameters parameters = periodic_box(size);
  parameters.liquid.attraction = 25;
  parameters.liquid.repulsion = 0;
  parameters.liquid.random_amplitude = 3;
  parameters.liquid.initial_density = parameters.liquid.bulk_density = 3;
  return parameters;
}

TEST(Membranes, KeepAreaVolumeAndTemperatureInALiquidAlsoOverAPeriodicCorner) {
  Parameters parameters = plain_dpd(8);
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill_box();
  const TriangleMesh mesh = sphere(2, 2.6, {0.5, 7, 1});
  MembraneStiffness stiffness;
  stiffness.bending_rigidity = 10;
  EXPECT_EQ(simulation.add_membrane(placed(mesh, stiffness)), 1u);
  const double area_before = area(mesh), volume_before = volume(mesh);
  double temperature = 0, samples = 0, drift = 0;
  for (int k = 0; k < 1500; ++k) {
    simulation.step();
    if (k < 300 || k % 30 != 0) continue;
    const auto snapshot = simulation.observe();
    const MembraneObservation& seen = snapshot->membranes.at(0);
    EXPECT_NEAR(seen.area, area_before, 0.03 * area_before);
    EXPECT_NEAR(seen.volume, volume_before, 0.03 * volume_before);
    EXPECT_LT((seen.upper - seen.lower).maxCoeff(), 6.5);
    temperature += snapshot->temperature;
    drift = snapshot->momentum.norm();
    ++samples;
  }
  EXPECT_NEAR(temperature / samples, 1, 0.03);
  EXPECT_LT(drift, 1e-2);
}

TEST(Membranes, AreTheSameWhateverTheThreadsAndGoOnFromASavedState) {
  Parameters parameters = plain_dpd(7);
  parameters.integrator = Integrator::baoab;
  const auto fresh = [&](int threads) {
    auto simulation =
        std::make_unique<Simulation>(parameters, ContactAngleCurve::lan2016(), Execution{threads, "auto"});
    simulation->fill_box();
    simulation->add_membrane(placed(sphere(1, 1.2, {2, 2, 2})));
    simulation->add_membrane(placed(sphere(1, 1.2, {5, 5, 5})));
    return simulation;
  };
  const ObserveRequest hash{false, true};
  const auto one = fresh(1), three = fresh(3);
  for (int k = 0; k < 25; ++k) {
    one->step();
    three->step();
  }
  EXPECT_EQ(*one->observe(hash)->state_hash, *three->observe(hash)->state_hash);
  const auto other = fresh(2);
  other->load_state(one->save_state());
  for (int k = 0; k < 25; ++k) {
    one->step();
    other->step();
  }
  EXPECT_EQ(*one->observe(hash)->state_hash, *other->observe(hash)->state_hash);
}

TEST(Membranes, ThatCanNotBeAreRefusedWhole) {
  Parameters parameters = plain_dpd(8);
  parameters.domain.lower_side[2] = parameters.domain.upper_side[2] = Side::reflecting;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  const auto refused = [&](const MembranePlacement& placement) {
    const std::string text = refusal([&] { simulation.add_membrane(placement); });
    EXPECT_EQ(simulation.observe()->moving_beads, 0u);
    return text;
  };
  EXPECT_TRUE(holds(refused(placed(sphere(2, 3, {4, 4, 2}))), "mesh: vertex"));
  EXPECT_TRUE(holds(refused(placed(sphere(0, 3.5, {4, 4, 4}))), "a third of a periodic side"));
  MembraneStiffness stiffness;
  stiffness.max_stretch = 1;
  EXPECT_TRUE(
      holds(refused(placed(sphere(2, 3, {4, 4, 4}), stiffness)), "max_stretch: 1, allowed: 1.2 to 10"));
  stiffness = {};
  stiffness.shear_modulus = 2000;
  const std::string stiff = refused(placed(sphere(2, 3, {4, 4, 4}), stiffness));
  EXPECT_TRUE(holds(stiff, "too fast for time_step 0.01, allowed: a time_step of up to 0.00"));
  TriangleMesh open = sphere(2, 3, {4, 4, 4});
  open.triangles.pop_back();
  EXPECT_TRUE(holds(refused(placed(open)), "mesh: is not closed"));
}

TEST(Membranes, ThatAreTornStopTheRun) {
  Parameters parameters = plain_dpd(8);
  parameters.liquid.attraction = 0;
  MembraneStiffness stiffness;
  stiffness.volume_ratio = 2;
  stiffness.volume_stiffness = 2000;
  stiffness.area_stiffness = stiffness.local_area_stiffness = 0;
  stiffness.shear_modulus = 0.1;
  stiffness.max_stretch = 1.22;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_membrane(placed(sphere(2, 3, {4, 4, 4}), stiffness));
  std::string told;
  try {
    for (int k = 0; k < 2000; ++k) simulation.step();
  } catch (const Instability& instability) {
    told = instability.what();
  }
  EXPECT_TRUE(holds(told, "the edge of membrane 1 between beads"));
}

}  // namespace
}  // namespace dmf::engine
