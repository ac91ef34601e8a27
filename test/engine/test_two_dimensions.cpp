// Two dimensions: all beads in one plane, half-way between the y sides.
#include <gtest/gtest.h>

#include <cmath>

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
                      simulation.add_microparticle(sphere_at({5, 2}, 5.0));
                    }),
                    "microparticle: with dimensions: 2"));
  Parameters parameters = sheet(12);
  parameters.domain.upper_side[2] = parameters.domain.lower_side[2] = Side::reflecting;
  parameters.boundaries.lower_velocity = {0, 1};
  EXPECT_TRUE(holds(refusal([&] { Simulation(parameters, ContactAngleCurve::lan2016()); }),
                    "boundaries.lower_velocity: (0, 1), allowed: y zero"));
}

}  // namespace
}  // namespace dmf::engine
