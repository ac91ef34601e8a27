// Two dimensions: all beads in one plane, half-way between the y sides.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/bodies/contact.h"
#include "engine/kernels/lanes-inl.h"
#include "engine/pair_law-inl.h"
#include "engine/simulation.h"
#include "refusal.h"
#include "systems.h"

namespace dmf::engine {
namespace {

/// Periodic along x and z.
Parameters sheet(double size) {
  Parameters parameters = periodic_box(size);
  parameters.domain.upper.y() = 4;
  parameters.domain.lower_side[1] = parameters.domain.upper_side[1] = Side::reflecting;
  parameters.dimensions = 2;
  parameters.watchdog.evaporation = 1;
  return parameters;
}

Parameters plain_dpd_sheet(double size, double density) {
  Parameters parameters = sheet(size);
  parameters.liquid.attraction = 25;
  parameters.liquid.repulsion = 0;
  parameters.liquid.random_amplitude = 3;
  parameters.liquid.initial_density = parameters.liquid.bulk_density = density;
  return parameters;
}

TEST(TwoDimensions, TheDensityWeightCountsABeadOnce) {
  // The integral over a disc, against 1 (docs/physics.md).
  const double r_d = 0.75;
  double integral = 0;
  const int rings = 10000;
  for (int k = 0; k < rings; ++k) {
    const double r = r_d * (k + 0.5) / rings;
    integral += 2 * std::acos(-1) * r * HWY_NAMESPACE::density_weight(r, 1 / r_d) * r_d / rings;
  }
  EXPECT_NEAR(density_normalization(r_d, 2) * integral, 1, 1e-6);
}

TEST(TwoDimensions, AllBeadsStayInThePlaneAtTheirTemperatureAndKeepTheirMomentum) {
  for (const Integrator integrator : {Integrator::groot_warren, Integrator::baoab}) {
    Parameters parameters = plain_dpd_sheet(16, 4);
    parameters.integrator = integrator;
    Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
    EXPECT_EQ(simulation.fill_box(), 2u * 23 * 23);  // two a cell of 0.707
    double temperature = 0;
    for (int k = 0; k < 1500; ++k) {
      simulation.step();
      temperature += simulation.observe()->temperature / 1500;
    }
    const auto snapshot = simulation.observe({true});
    for (std::size_t k = 0; k < snapshot->positions.size(); ++k) {
      ASSERT_EQ(snapshot->positions[k].y(), 2);
      ASSERT_EQ(snapshot->velocities[k].y(), 0);
    }
    // 1058 beads: 3 % a look, some 50 independent ones.
    EXPECT_NEAR(temperature, 1, 0.02);
    EXPECT_LT(snapshot->momentum.norm(), 1e-2);
  }
}

TEST(TwoDimensions, ForcesAreThoseOfThreeDimensionsWithAllBeadsInAPlane) {
  // Plain DPD knows no density, the only thing that two dimensions change.
  System flat{"flat", plain_dpd_sheet(8, 4), {}};
  System spatial{"spatial", flat.parameters, {}};
  spatial.parameters.dimensions = 3;
  for (System* system : {&flat, &spatial}) {
    scatter_beads(*system, 4, {0, 0, 0}, {8, 1, 8}, [](const Vector3d&) { return true; });
    for (Record& at : system->beads.position) at.y = 2;
    for (AlignedVector<Record>* array : {&system->beads.velocity, &system->beads.predicted})
      for (Record& velocity : *array) velocity.y = 0;
    Sorted sorted(*system, "auto");
    sorted.forces.density(system->beads, sorted.wall, sorted.bodies, sorted.pairs);
    sorted.forces.force(system->beads, sorted.wall, sorted.bodies, sorted.pairs);
  }
  for (std::size_t i = 0; i < flat.beads.size(); ++i) {
    EXPECT_EQ(flat.beads.force[i].x, spatial.beads.force[i].x);
    EXPECT_EQ(flat.beads.force[i].y, 0);
    EXPECT_EQ(flat.beads.force[i].z, spatial.beads.force[i].z);
  }
}

TEST(TwoDimensions, ThePressureIsIsotropicAndThatOfTheVirial) {
  // Soft discs with a = 25 at four a r_c^2. The box is square, its lattice is not that of the liquid: what is
  // left of the lattice shows as a difference of the two normal pressures.
  Simulation simulation(plain_dpd_sheet(16, 4), ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill_box();
  for (int k = 0; k < 500; ++k) simulation.step();
  Eigen::Matrix3d pressure = Eigen::Matrix3d::Zero();
  int looks = 0;
  for (int k = 0; k < 2000; ++k) {
    simulation.step();
    if (k % 5 != 0) continue;
    const auto snapshot = simulation.observe({true, false, true});
    for (const Eigen::Vector3f& v : snapshot->velocities) {
      const Vector3d u = v.cast<double>();
      pressure += u * u.transpose();
    }
    pressure += *snapshot->virial;
    ++looks;
  }
  pressure /= looks * 16.0 * 16.0;
  EXPECT_NEAR(pressure(0, 0) / pressure(2, 2), 1, 0.01);
  EXPECT_NEAR(pressure(0, 2), 0, 0.01 * pressure(0, 0));
  EXPECT_EQ(pressure(1, 1), 0);
}

TEST(TwoDimensions, ADropletRestsOnAWallOfOneRowOfBeadsALayer) {
  Parameters parameters = sheet(30);
  parameters.domain.lower_side[2] = Side::wall;
  parameters.domain.upper_side[2] = Side::reflecting;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_droplet({{15, 0, 6}, 5});
  for (int k = 0; k < 400; ++k) simulation.step();
  const auto snapshot = simulation.observe();
  EXPECT_EQ(snapshot->wall_beads, 3u * 34);  // 30 / 0.874 a layer
  EXPECT_NEAR(static_cast<double>(snapshot->moving_beads), 6 * std::acos(-1) * 25, 15);
  ASSERT_EQ(snapshot->droplets.size(), 1u);
  EXPECT_GT(snapshot->droplets[0].beads, 0.95 * static_cast<double>(snapshot->moving_beads));
}

TEST(TwoDimensions, AreTheSameBitsWhateverTheThreadsAndAfterARestart) {
  const auto hash_after = [](Simulation& simulation, int steps) {
    for (int k = 0; k < steps; ++k) simulation.step();
    return *simulation.observe({false, true})->state_hash;
  };
  Simulation first(plain_dpd_sheet(12, 4), ContactAngleCurve::lan2016(), {1, "auto"});
  first.fill_box();
  hash_after(first, 40);
  const std::string saved = first.save_state();
  const std::uint64_t expected = hash_after(first, 40);
  Simulation second(first.parameters(), ContactAngleCurve::lan2016(), {2, "auto"});
  second.load_state(saved);
  EXPECT_EQ(hash_after(second, 40), expected);
}

TEST(TwoDimensions, RefuseWhatLeavesThePlane) {
  Simulation simulation(sheet(12), ContactAngleCurve::lan2016(), {1, "auto"});
  EXPECT_TRUE(holds(refusal([&] {
                      simulation.set_body_forces({{0, 0.1, 0}, Vector3d::Zero()});
                    }),
                    "body_forces.gravity: 0.1 along y, allowed: 0"));
  EXPECT_TRUE(holds(refusal([&] {
                      simulation.set_body_forces({Vector3d::Zero(), {0, 0.2, 0}});
                    }),
                    "body_forces.magnetic: 0.2 along y, allowed: 0"));
  Parameters parameters = sheet(12);
  parameters.domain.upper_side[2] = parameters.domain.lower_side[2] = Side::reflecting;
  parameters.boundaries.lower_velocity = {0, 1};
  EXPECT_TRUE(holds(refusal([&] { Simulation(parameters, ContactAngleCurve::lan2016()); }),
                    "boundaries.lower_velocity: (0, 1), allowed: y zero"));
}

/// A plate for a disc, without liquid.
Parameters dry_floor(ContactModel model) {
  Parameters parameters = sheet(16);
  parameters.domain.lower_side[2] = Side::wall;
  parameters.domain.upper_side[2] = Side::reflecting;
  parameters.microparticles.contact = model;
  return parameters;
}

TEST(TwoDimensions, ADiscRollsDownATiltedPlateWithHalfTheAcceleration) {
  // A hoop: its beads stand around it.
  Simulation simulation(dry_floor(ContactModel::coulomb), ContactAngleCurve::lan2016(), {1, "auto"});
  MicroparticlePlacement placement = sphere_at({8, 0});
  placement.static_friction = 1;
  placement.rolling_friction = 0;
  simulation.add_microparticle(placement);
  simulation.set_body_forces({{0.1, 0, -0.2}, Vector3d::Zero()});
  for (int k = 0; k < 1000; ++k) simulation.step();
  const MicroparticleObservation rolled = simulation.observe()->microparticles.at(0);
  EXPECT_EQ(rolled.beads, 201u);  // 32 a r_c
  EXPECT_NEAR(rolled.velocity.x(), 0.5 * 0.1 * 10, 0.02);
  EXPECT_NEAR(rolled.angular_velocity.y(), rolled.velocity.x(), 0.02);
  EXPECT_EQ(rolled.position.y(), 2);
  EXPECT_EQ(rolled.angular_velocity.x(), 0);
  EXPECT_EQ(rolled.angular_velocity.z(), 0);
}

TEST(TwoDimensions, TheAdhesionOfADiscIsTheSumOverItsBeadsAndThoseOfTheRows) {
  const WallParameters wall;
  // The mean over places along the wall, for rows are no lines.
  double sum = 0;
  const int places = 50, beads = 2000;
  for (int place = 0; place < places; ++place)
    for (int k = 0; k < beads; ++k) {
      const double angle = 2 * std::acos(-1) * (k + 0.5) / beads;
      const double x = std::cos(angle), z = 1 + std::sin(angle);
      for (int layer = 0; layer < wall.layers; ++layer)
        for (int column = -4; column <= 4; ++column) {
          const double shift = wall.lattice_constant * (column + 0.5 * (layer % 2) + double(place) / places);
          const double depth = 0.5 * layer * wall.lattice_constant;
          const double r = std::hypot(x - shift, z + depth);
          if (r < 1) sum += (1 - r) / r * (z + depth);
        }
    }
  EXPECT_NEAR(wall_adhesion_of_disc(-3, 1, 7, wall), 3 * sum / places * 7 * 2 * std::acos(-1) / beads,
              0.01 * 3 * sum / places * 7 * 2 * std::acos(-1) / beads);
}

TEST(TwoDimensions, ADiscInALiquidHasItsTemperatureAndKeepsItOut) {
  // In a liquid of M beads a body of mass m has m <v^2> = 2 k_BT M / (M + m), and I <w^2> = k_BT.
  double translation = 0, rotation = 0;
  int looks = 0;
  for (const std::uint64_t seed : {1u, 2u}) {
    Parameters parameters = sheet(14);
    parameters.seed = seed;
    parameters.liquid.initial_density = parameters.liquid.bulk_density = 4;
    Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
    MicroparticlePlacement placement = sphere_at({7, 2}, 7.0);
    placement.mass = 20;
    simulation.add_microparticle(placement);
    simulation.fill({parameters.domain.lower, parameters.domain.upper});
    for (int k = 0; k < 1000; ++k) simulation.step();
    const double beads = static_cast<double>(simulation.observe()->moving_beads);
    for (int look = 0; look < 600; ++look, ++looks) {
      for (int k = 0; k < 20; ++k) simulation.step();  // a leak stops the run
      const MicroparticleObservation seen = simulation.observe()->microparticles.at(0);
      ASSERT_EQ(seen.position.y(), 2);
      ASSERT_EQ(seen.velocity.y(), 0);
      EXPECT_GT(seen.immersion, 0.9);
      translation += 20 * seen.velocity.squaredNorm() * (beads + 20) / beads;
      rotation += 20 * seen.angular_velocity.squaredNorm();
    }
  }
  // One look in some three of 1200 is new: 2 components and 1 give 5 and 7 % of spread.
  EXPECT_NEAR(translation / looks, 2, 0.3);
  EXPECT_NEAR(rotation / looks, 1, 0.2);
}

TEST(TwoDimensions, ABodyOfPointsAndAChainStayInThePlane) {
  Parameters parameters = sheet(14);
  parameters.liquid.initial_density = parameters.liquid.bulk_density = 4;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  MicroparticlePlacement body = sphere_at({4, 0}, 7.0);
  body.radius = 0.5;
  for (int k = 0; k < 40; ++k) body.points.emplace_back(0.05 * k, 0, 0.02 * k);
  simulation.add_microparticle(body);
  ChainPlacement chain;
  chain.spring = {SpringKind::harmonic, 100, 0.5};
  chain.beads = 10;
  chain.bond_length = 0.5;
  chain.lower = {8, 0, 2};
  chain.upper = {13, 4, 12};
  simulation.add_chains(chain);
  simulation.fill({parameters.domain.lower, parameters.domain.upper});
  const Vector3d before = simulation.observe()->chains.at(0).end_to_end;
  for (int k = 0; k < 500; ++k) simulation.step();
  const auto snapshot = simulation.observe({true});
  for (const Eigen::Vector3f& p : snapshot->positions) ASSERT_EQ(p.y(), 2);
  const MicroparticleObservation& seen = snapshot->microparticles.at(0);
  EXPECT_EQ(seen.position.y(), 2);
  EXPECT_EQ(seen.angular_velocity.x(), 0);
  EXPECT_GT(std::abs(seen.angular_velocity.y()), 0);
  EXPECT_GT((snapshot->chains.at(0).end_to_end - before).norm(), 0.01);
}

TEST(TwoDimensions, WalksOfChainsAreThoseOfThePlane) {
  // Ideal ones: <R^2> = (n - 1) b^2, in the plane as in space, and half of it along each axis.
  Parameters parameters = sheet(400);
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  ChainPlacement chains;
  chains.spring = {SpringKind::harmonic, 100, 0.5};
  chains.beads = 21;
  chains.count = 2000;
  chains.bond_length = 0.5;
  chains.lower = {0, 0, 0};
  chains.upper = {400, 4, 400};
  simulation.add_chains(chains);
  double along_x = 0, along_z = 0;
  for (const ChainObservation& chain : simulation.observe()->chains) {
    ASSERT_EQ(chain.end_to_end.y(), 0);
    along_x += chain.end_to_end.x() * chain.end_to_end.x() / 2000;
    along_z += chain.end_to_end.z() * chain.end_to_end.z() / 2000;
  }
  // 2000 walks: 3 % each.
  EXPECT_NEAR(along_x, 2.5, 0.3);
  EXPECT_NEAR(along_z, 2.5, 0.3);
}

TEST(TwoDimensions, RefusesBodiesThatAreNotFlat) {
  Simulation simulation(sheet(14), ContactAngleCurve::lan2016(), {1, "auto"});
  MicroparticlePlacement smooth = sphere_at({7, 2}, 7.0), thin = smooth, bent = smooth;
  smooth.smooth = true;
  EXPECT_TRUE(holds(refusal([&] { simulation.add_microparticle(smooth); }),
                    "smooth: true, allowed: in three dimensions"));
  thin.beads = 100;
  EXPECT_TRUE(holds(refusal([&] { simulation.add_microparticle(thin); }), "allowed: 101 or more"));
  bent.points = {{0, 0, 0}, {0, 0.1, 0}};
  EXPECT_TRUE(holds(refusal([&] { simulation.add_microparticle(bent); }), "points: allowed: 0 along y"));
  ChainPlacement chain;
  chain.spring = {SpringKind::harmonic, 100, 0.5};
  chain.points = {{5, 2, 5}, {5, 2.4, 5}};
  EXPECT_TRUE(holds(refusal([&] { simulation.add_chains(chain); }), "points[1]: 2.4 along y, allowed: 2"));
}

}  // namespace
}  // namespace dmf::engine
