// Liu's conservative force from two cubic splines.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>

#include "engine/kernels/lanes-inl.h"
#include "engine/pair_law-inl.h"
#include "engine/simulation.h"
#include "refusal.h"
#include "systems.h"

namespace dmf::engine {
namespace {

/// Liu (18).
double cubic_spline(double r, double cutoff) {
  const double q = 2 * r / cutoff;
  return q < 1 ? 1 - 1.5 * q * q + 0.75 * q * q * q : q < 2 ? 0.25 * std::pow(2 - q, 3) : 0;
}

/// Liu (19).
double potential(const SplineParameters& spline, double strength, double r) {
  return strength * (spline.repulsion * cubic_spline(r, spline.repulsion_radius) -
                     spline.attraction * cubic_spline(r, spline.attraction_radius));
}

double force(const SplineParameters& spline, double strength, double r) {
  LiquidParameters liquid;
  const SplineLaw<double> law{liquid_law(liquid, 0.01), spline_shape(spline)};
  return HWY_NAMESPACE::pair_force<PairForce::conservative, DissipativeWeight::power>(law, strength, r, 9.0,
                                                                                      1.0, 1.0);
}

TEST(SplineForce, IsMinusTheSlopeOfItsPotential) {
  for (const auto& [repulsion, repulsion_radius, attraction, attraction_radius] :
       {std::array{2.0, 0.8, 1.0, 1.0}, {1.0, 1.0, 0.0, 1.0}, {2.0, 0.8, 1.1, 1.0}, {3.0, 0.5, 1.0, 0.9}}) {
    const SplineParameters spline{true, repulsion, repulsion_radius, attraction, attraction_radius};
    const double h = 1e-5;
    for (double r = 0.003; r < 1.2; r += 0.013) {
      const double slope = (potential(spline, 18.75, r + h) - potential(spline, 18.75, r - h)) / (2 * h);
      // Third derivatives up to 18.75 * 3 * 9 / 0.25^3 = 3e4, times h^2 / 6.
      EXPECT_NEAR(force(spline, 18.75, r), -slope, 1e-5) << "at " << r;
    }
  }
}

TEST(SplineForce, OfLiusExampleTurnsFromRepulsionToAttractionWhereHisPotentialHasItsBottom) {
  // "Becomes negative at r = 0.4529", and ends at 1.
  const SplineParameters spline = liu_spline();
  EXPECT_NEAR(potential(spline, 1, 0.4529), 0, 1e-4);
  EXPECT_GT(force(spline, 1, 0.45), 0);
  EXPECT_LT(force(spline, 1, 0.7), 0);
  EXPECT_EQ(force(spline, 1, 1.0), 0);
}

Parameters liquid_of(const SplineParameters& spline, double size) {
  Parameters parameters = periodic_box(size);
  parameters.liquid.attraction = 18.75;
  parameters.liquid.repulsion = 0;
  parameters.liquid.random_amplitude = 3;
  parameters.liquid.initial_density = parameters.liquid.bulk_density = 6;
  parameters.spline = spline;
  parameters.watchdog.evaporation = 1;
  return parameters;
}

TEST(SplineLiquid, FormsADropWithSparseVapourWhereLiuHasOne) {
  Simulation simulation(liquid_of(liu_spline(), 14), ContactAngleCurve::lan2016(), {1, "auto"});
  const auto beads = static_cast<double>(simulation.fill({{4, 4, 4}, {10, 10, 10}}));
  for (int k = 0; k < 4000; ++k) simulation.step();
  const auto snapshot = simulation.observe({true});
  ASSERT_EQ(snapshot->droplets.size(), 1u);
  const DropletObservation& drop = snapshot->droplets[0];
  EXPECT_GT(static_cast<double>(drop.beads), 0.9 * beads);
  // Round, from a cube.
  const Vector3d size = drop.upper - drop.lower;
  EXPECT_LT(size.maxCoeff() / size.minCoeff(), 1.25);
  // Liu: the liquid is more than 600 times as dense as the gas.
  double inside = 0, outside = 0;
  for (const Eigen::Vector3f& p : snapshot->positions) {
    const double r = simulation.parameters().domain.nearest_image(p.cast<double>() - drop.centroid).norm();
    inside += r < 2;
    outside += r > 6;
  }
  const double volume = 4.0 / 3 * M_PI;
  EXPECT_LT(outside / (14 * 14 * 14 - volume * 216), inside / (volume * 8) / 200);
}

TEST(SplineLiquid, FillsItsBoxWithoutAttraction) {
  SplineParameters spline = liu_spline();
  spline.attraction = 0;
  Parameters parameters = liquid_of(spline, 12);
  parameters.watchdog.highest_temperature = 100;  // a cube of six beads per r_c^3 bursts
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill({{4, 4, 4}, {8, 8, 8}});
  for (int k = 0; k < 2000; ++k) simulation.step();
  const auto snapshot = simulation.observe({true});
  Vector3d spread = Vector3d::Zero();
  for (const Eigen::Vector3f& p : snapshot->positions)
    spread += (p.cast<double>() - Vector3d::Constant(6)).cwiseAbs2() /
              static_cast<double>(snapshot->positions.size());
  // Evenly in a box of 12: 12 of variance along each axis. The cube it came from had 1.3.
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(std::sqrt(spread[axis]), std::sqrt(12.0), 0.5);
}

TEST(SplineLiquid, HoldsItsTemperature) {
  for (const Integrator integrator : {Integrator::groot_warren, Integrator::baoab}) {
    Parameters parameters = liquid_of(liu_spline(), 6);
    parameters.integrator = integrator;
    Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
    simulation.fill_box();
    for (int k = 0; k < 300; ++k) simulation.step();
    double sum = 0;
    for (int k = 0; k < 1500; ++k) {
      simulation.step();
      if (k % 10 == 0) sum += simulation.observe()->temperature / 150;
    }
    // 1,300 beads: 2.3 % a look, 150 looks.
    EXPECT_NEAR(sum, 1, 0.02);
  }
}

TEST(SplineParameters, OutOfRangeAreRefused) {
  const auto refused = [](auto change) {
    Parameters parameters = liquid_of(liu_spline(), 6);
    change(parameters);
    return refusal([&] { Simulation(parameters, ContactAngleCurve::lan2016()); });
  };
  EXPECT_TRUE(holds(refused([](auto& p) { p.spline.repulsion_radius = 1.01; }),
                    "spline.repulsion_radius: 1.01, allowed: 0.1 to 1 (r_c"));
  EXPECT_TRUE(
      holds(refused([](auto& p) { p.spline.attraction_radius = 0; }), "attraction_radius: 0, allowed"));
  EXPECT_TRUE(
      holds(refused([](auto& p) { p.spline.attraction = 2; }), "spline.attraction: 2, allowed: 0 up"));
  EXPECT_TRUE(holds(refused([](auto& p) { p.spline.repulsion = 0; }), "spline.repulsion: 0, allowed"));
  EXPECT_TRUE(holds(refused([](auto& p) {
                      p.liquid.attraction = -40;
                      p.liquid.repulsion = 25;
                    }),
                    "spline: together with a many-body repulsion"));
}

}  // namespace
}  // namespace dmf::engine
