// Stress, slab by slab.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "engine/bonds/mesh.h"
#include "engine/simulation.h"
#include "refusal.h"
#include "systems.h"

namespace dmf::engine {
namespace {

std::vector<SlabStress> profile_of(System& system, const StressSlabs& slabs) {
  const Walls wall(system.parameters);
  Pairs pairs(system.parameters);
  pairs.rebuild(system.beads, wall);
  Microparticles none(system.parameters);
  Forces(system.parameters, "auto").density(system.beads, wall, none, pairs);
  return stress_profile(slabs, system.beads, pairs.blocks(), pairs.ghosts(), Bonds(system.parameters),
                        system.parameters);
}

/// Two resting beads 0.9 r_c apart: too far for the repulsion, so that the force is A (1 - 0.9) = -4.
System pair_along(const Vector3d& from, const Vector3d& direction) {
  System system{"pair", periodic_box(4), {}};
  add_bead(system, from);
  add_bead(system, from + 0.9 * direction);
  for (Record& v : system.beads.velocity) v = {};
  return system;
}

TEST(StressProfile, GivesASlabThePartOfThePairsLineThatLiesInIt) {
  // From z = 0.9 to 1.8 in slabs of 0.5: 0.1, 0.5 and 0.3 of the 0.9.
  System system = pair_along({1, 1, 0.9}, Vector3d::UnitZ());
  const std::vector<SlabStress> slabs = profile_of(system, {2, 8});
  const double stress = -4 * 0.9 / (4 * 4 * 0.5);
  const double parts[8] = {0, 1.0 / 9, 5.0 / 9, 3.0 / 9, 0, 0, 0, 0};
  for (int k = 0; k < 8; ++k) {
    EXPECT_NEAR(slabs[k].pressure(2, 2), parts[k] * stress, 1e-6) << k;
    EXPECT_NEAR(slabs[k].pressure.cwiseAbs().sum(), std::abs(slabs[k].pressure(2, 2)), 1e-6);
  }
}

TEST(StressProfile, FollowsALineOverAPeriodicSide) {
  System system = pair_along({3.8, 1, 1}, Vector3d::UnitX());
  const std::vector<SlabStress> slabs = profile_of(system, {0, 8});
  const double stress = -4 * 0.9 / (4 * 4 * 0.5);
  EXPECT_NEAR(slabs[7].pressure(0, 0), stress * 2 / 9, 1e-5);
  EXPECT_NEAR(slabs[0].pressure(0, 0), stress * 5 / 9, 1e-5);
  EXPECT_NEAR(slabs[1].pressure(0, 0), stress * 2 / 9, 1e-5);
}

TEST(StressProfile, GivesALineAlongTheSlabToThatSlabAlone) {
  System system = pair_along({1, 1, 1.2}, Vector3d(1, 1, 0).normalized());
  const std::vector<SlabStress> slabs = profile_of(system, {2, 8});
  const double stress = -4 * 0.9 / (4 * 4 * 0.5) / 2;
  EXPECT_NEAR(slabs[2].pressure(0, 0), stress, 1e-5);
  EXPECT_NEAR(slabs[2].pressure(0, 1), stress, 1e-5);
  EXPECT_NEAR(slabs[2].pressure(2, 2), 0, 1e-6);
}

TEST(StressProfile, CountsTheFrictionOfBeadsThatApproach) {
  System system = pair_along({1, 1, 1}, Vector3d::UnitX());
  system.parameters.liquid.attraction = -1e-6;
  const int second = system.beads.position[0].x < system.beads.position[1].x ? 1 : 0;
  system.beads.velocity[second].x = -3;
  // gamma w_D v = 18 (0.1)^2 3 pushes them apart; their own motion about the mean adds 2 (3/2)^2, times n /
  // (n - 1).
  const std::vector<SlabStress> slabs = profile_of(system, {1, 1});
  EXPECT_NEAR(slabs[0].pressure(0, 0) * 64, 18 * 0.01 * 3 * 0.9 + 2 * 2 * 2.25, 1e-4);
}

TEST(StressProfile, AddsUpToTheVirialAndTheMotionOfAllBeads) {
  Parameters parameters = periodic_box(7);
  parameters.domain.upper.z() = 11;
  parameters.liquid.random_amplitude = 0;  // no friction either, which the virial leaves out
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_droplet({{3.5, 3.5, 5}, 2.5});
  for (int k = 0; k < 50; ++k) simulation.step();
  ObserveRequest request{true, false, true};
  request.stress = StressSlabs{2, 1};
  const auto whole = simulation.observe(request);
  request.stress = StressSlabs{2, 37};
  const auto divided = simulation.observe(request);
  const double volume = parameters.domain.size().prod();
  const auto motion = [&](const std::vector<SlabStress>& slabs) {
    std::vector<Eigen::Matrix3d> sums(slabs.size(), Eigen::Matrix3d::Zero());
    std::vector<double> beads(slabs.size());
    for (std::size_t i = 0; i < whole->positions.size(); ++i) {
      const auto slab = static_cast<std::size_t>(whole->positions[i].z() / 11.0 * double(slabs.size()));
      const Vector3d v = whole->velocities[i].cast<double>() - slabs[slab].velocity;
      sums[slab] += v * v.transpose();
      ++beads[slab];
    }
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < slabs.size(); ++k)
      if (beads[k] > 1) sum += sums[k] * beads[k] / (beads[k] - 1);
    return sum;
  };
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double beads = 0;
  for (const SlabStress& slab : divided->stress) {
    sum += slab.pressure * volume / 37;
    beads += slab.density * volume / 37;
  }
  EXPECT_NEAR(beads, static_cast<double>(whole->moving_beads), 1e-6);
  const Eigen::Matrix3d pairs = whole->stress[0].pressure * volume - motion(whole->stress);
  EXPECT_LT((sum - motion(divided->stress) - pairs).norm(), 1e-6 * pairs.norm());
  EXPECT_LT((pairs - *whole->virial).norm(), 1e-6 * whole->virial->norm());
}

TEST(StressProfile, OfAFilmAtRestPushesNowhereAcrossItAndPullsAlongItsSurfacesOnly) {
  // The momentum balance: P_zz is the same everywhere, here 0 as in the vapour; and P_zz - P_xx, the tension,
  // lies in the surfaces. 7.54 in all (docs/physics.md), by BAOAB, whose stress has no error of the time
  // step.
  const double width = 6, height = 16;
  Parameters parameters = periodic_box(width);
  parameters.domain.upper.z() = height;
  parameters.integrator = Integrator::baoab;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill_slab({0, 0, 4}, {width, width, 12});
  for (int k = 0; k < 1000; ++k) simulation.step();
  constexpr std::size_t count = 32;
  std::vector<double> across(count), tension(count), density(count);
  constexpr int looks = 500;
  for (int look = 0; look < looks; ++look) {
    for (int k = 0; k < 10; ++k) simulation.step();
    ObserveRequest request;
    request.stress = StressSlabs{2, count};
    const auto snapshot = simulation.observe(request);
    for (std::size_t k = 0; k < count; ++k) {
      const Eigen::Matrix3d& p = snapshot->stress[k].pressure;
      across[k] += p(2, 2) / looks;
      tension[k] += (p(2, 2) - 0.5 * (p(0, 0) + p(1, 1))) * (height / count) / looks;
      density[k] += snapshot->stress[k].density / looks;
    }
  }
  double total = 0, inside = 0;
  for (std::size_t k = 0; k < count; ++k) {
    total += tension[k];
    const double z = (static_cast<double>(k) + 0.5) * height / count;
    if (std::abs(z - 8) < 2) {
      inside += tension[k];
      EXPECT_NEAR(density[k], 6.06, 0.25) << "z = " << z;
    }
    EXPECT_NEAR(across[k], 0, 0.6) << "z = " << z;
  }
  EXPECT_NEAR(total / 2, 7.54, 0.6);
  EXPECT_NEAR(inside / 2, 0, 0.4);
}

TEST(StressProfile, RefusesAnAxisOrACountThatThereIsNot) {
  System system = pair_along({1, 1, 1}, Vector3d::UnitX());
  EXPECT_EQ(refusal([&] { profile_of(system, {3, 1}); }), "stress.axis: 3, allowed: 0 to 2");
  EXPECT_EQ(refusal([&] { profile_of(system, {0, 0}); }), "stress.count: 0, allowed: 1 to 100000");
}

TEST(BondStress, MakesAMoleculeOneParticleOfAnIdealGas) {
  // Beads that feel nothing but bonds: p V = (molecules) k_BT, so that of the beads' own N k_BT each bond
  // takes one k_BT, and a membrane of N beads N - 1.
  Parameters parameters = periodic_box(5.5);
  parameters.liquid.attraction = parameters.liquid.repulsion = 0;
  parameters.liquid.random_amplitude = 3;
  parameters.liquid.initial_density = 1.5;
  parameters.watchdog.evaporation = 1;
  const auto bonds_share = [&](Simulation& simulation, int steps) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    double slabs = 0, looks = 0;
    for (int k = 0; k < steps; ++k) {
      simulation.step();
      if (k < steps / 5 || k % 5 != 0) continue;
      ObserveRequest request{true, false, true};
      const auto snapshot = simulation.observe(request);
      sum += *snapshot->virial;
      for (const float one : snapshot->bead_virials) slabs += one;
      ++looks;
    }
    EXPECT_NEAR(slabs / looks, sum.trace() / 3 / looks, 1e-3 * std::abs(slabs / looks));
    EXPECT_NEAR(sum(0, 0) / sum(2, 2), 1, 0.1);
    return sum.trace() / 3 / looks;
  };
  {
    Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
    ChainPlacement placement;
    placement.spring.stiffness = 60;
    placement.spring.length = 0.6;
    placement.count = 50;
    placement.beads = 6;
    placement.bond_length = 0.6;
    placement.upper = parameters.domain.upper;
    simulation.add_chains(placement);
    EXPECT_NEAR(bonds_share(simulation, 3000) / -(50 * 5), 1, 0.03);
  }
  {
    // Over a periodic corner, in a thermostat of unbound beads.
    Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
    simulation.fill_box();
    TriangleMesh mesh = icosphere(1);
    for (Vector3d& vertex : mesh.vertices) vertex = 1.3 * vertex + Vector3d(0.2, 0.1, 5.3);
    simulation.add_membrane({std::make_shared<const TriangleMesh>(mesh), {}});
    EXPECT_NEAR(bonds_share(simulation, 5000) / -41, 1, 0.08);
  }
}

TEST(BondStress, StandsInTheSlabsThatTheBondCrosses) {
  Parameters parameters = periodic_box(4);
  parameters.liquid.attraction = parameters.liquid.repulsion = parameters.liquid.random_amplitude = 0;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  ChainPlacement placement;
  placement.spring.stiffness = 50;
  placement.spring.length = 0.5;
  placement.points = {{1, 1, 0.9}, {1, 1, 1.8}};
  simulation.add_chains(placement);
  ObserveRequest request;
  request.stress = StressSlabs{2, 8};
  const auto bound = simulation.observe(request);
  // Of T (r) = 50 (0.9 - 0.5) = 20 over 0.9 in slabs of 0.5, beside two beads' motion along z.
  const double stress = -20 * 0.9 / (4 * 4 * 0.5);
  EXPECT_NEAR(bound->stress[2].pressure(2, 2), stress * 5 / 9, 1e-5);
  EXPECT_NEAR(bound->stress[2].pressure(0, 0), 0, 1e-9);
  EXPECT_NEAR(bound->stress[4].pressure(2, 2), 0, 1e-9);
}

}  // namespace
}  // namespace dmf::engine
