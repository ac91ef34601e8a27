// Plain DPD, and weights of friction other than the usual one.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/simulation.h"
#include "refusal.h"
#include "systems.h"

namespace dmf::engine {
namespace {

struct Means {
  double temperature = 0, pressure = 0;
};

/// 500 beads of plain DPD with a = 25, over 15 tau.
Means means_of(const LiquidParameters& friction, double bulk_density, Integrator integrator,
               double time_step) {
  const double size = 5 * std::cbrt(4 / bulk_density);  // five lattice cells
  Parameters parameters = periodic_box(size);
  parameters.liquid = friction;
  parameters.liquid.attraction = 25;
  parameters.liquid.repulsion = 0;
  parameters.liquid.random_amplitude = 3;
  parameters.liquid.initial_density = parameters.liquid.bulk_density = bulk_density;
  parameters.integrator = integrator;
  parameters.time_step = time_step;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  const double volume = size * size * size, density = static_cast<double>(simulation.fill_box()) / volume;
  const int steps = static_cast<int>(15 / time_step);
  for (int k = 0; k < steps / 5; ++k) simulation.step();
  Means means;
  int looks = 0;
  for (int k = 0; k < steps; ++k) {
    simulation.step();
    if (k % 5 != 0) continue;
    const auto snapshot = simulation.observe({false, false, true});
    means.temperature += snapshot->temperature;
    means.pressure += density * snapshot->temperature + snapshot->virial->trace() / (3 * volume);
    ++looks;
  }
  return {means.temperature / looks, means.pressure / looks};
}

LiquidParameters friction(double exponent, double radius) {
  LiquidParameters liquid;
  liquid.dissipation_exponent = exponent;
  liquid.dissipation_radius = radius;
  return liquid;
}

TEST(PlainDpd, HasThePressureOfItsPotentialHoweverTheFrictionFades) {
  // Of soft spheres with a = 25, by Langevin dynamics of another program (numpy, all pairs, 256 and 500
  // beads): 23.645 +- 0.010 at rho = 3, the value that simulations of water under constant pressure use,
  // and 42.30 +- 0.01 at rho = 4. Groot and Warren's p = rho k_BT + 0.101 a rho^2 (1997, eq. 14) reads 25.7
  // and 44.4.
  for (const auto& [exponent, radius] : {std::pair{2.0, 1.0}, {1.0, 1.0}, {0.5, 1.0}, {0.5, 1.4}}) {
    const Means means = means_of(friction(exponent, radius), 3, Integrator::groot_warren, 0.01);
    EXPECT_NEAR(means.pressure, 23.645, 0.15) << "s = " << exponent << ", r_D = " << radius;
    // 500 beads: a look's temperature scatters by 3 %, the mean by a few thousandths.
    EXPECT_NEAR(means.temperature, 1, 0.015) << "s = " << exponent << ", r_D = " << radius;
  }
  EXPECT_NEAR(means_of(friction(2, 1), 4, Integrator::groot_warren, 0.01).pressure, 42.30, 0.2);
}

TEST(PlainDpd, HoldsItsTemperatureUnderBaoabWithEveryWeight) {
  for (const double exponent : {2.0, 1.0, 0.5})
    EXPECT_NEAR(means_of(friction(exponent, 1), 4, Integrator::baoab, 0.02).temperature, 1, 0.015)
        << exponent;
}

TEST(PlainDpd, WhatDoesNotGoTogetherIsRefused) {
  const auto refused = [](auto change) {
    Parameters parameters;
    change(parameters.liquid);
    return refusal([&] { Simulation(parameters, ContactAngleCurve::lan2016()); });
  };
  EXPECT_TRUE(holds(refused([](auto& l) { l.repulsion = 0; }), "liquid.attraction: -40, allowed: 0 to 200"));
  EXPECT_TRUE(holds(refused([](auto& l) { l.attraction = 25; }), "liquid.attraction: 25, allowed: -200"));
  EXPECT_TRUE(
      holds(refused([](auto& l) { l.dissipation_exponent = 0; }), "dissipation_exponent: 0, allowed"));
  EXPECT_TRUE(holds(refused([](auto& l) { l.dissipation_exponent = 0.7; }), "dissipation_exponent: 0.7"));
  EXPECT_TRUE(holds(refused([](auto& l) { l.dissipation_radius = 3; }), "dissipation_radius: 3, allowed"));
  EXPECT_TRUE(holds(refused([](auto& l) { l.dissipation_radius = NAN; }), "dissipation_radius: nan"));
}

}  // namespace
}  // namespace dmf::engine
