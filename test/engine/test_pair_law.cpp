#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>

#include "engine/kernels/lanes-inl.h"
#include "engine/pair_law-inl.h"
#include "engine/pair_law.h"
#include "engine/units.h"

namespace dmf::engine {
namespace {

using HWY_NAMESPACE::density_weight;
using HWY_NAMESPACE::mdpd_force;

TEST(DensityWeight, IntegratesToOneOverSpace) {
  const double r_d = 0.75;
  double integral = 0;
  const int n = 100000;
  for (int k = 0; k < n; ++k) {
    const double r = (k + 0.5) * r_d / n;
    integral += 4 * M_PI * r * r * density_normalization(r_d) * density_weight(r, 1 / r_d) * r_d / n;
  }
  EXPECT_NEAR(integral, 1.0, 1e-8);
}

TEST(DensityWeight, VanishesAtAndBeyondTheRepulsionRadius) {
  EXPECT_EQ(density_weight(0.75, 1 / 0.75), 0.0);
  EXPECT_EQ(density_weight(0.9, 1 / 0.75), 0.0);
}

TEST(PairForce, IsThePapersFormula) {
  // By hand: r 0.5, rho_i + rho_j 12, approach -2, zeta 0.3, dt 0.01.
  // -40 * 0.5 + 25 * 12 * (1 - 0.5/0.75) - 18 * 0.25 * (-2) + 6 / 0.1 * 0.5 * 0.3 = -20 + 100 + 9 + 9
  const MdpdLaw<double> law = liquid_law(LiquidParameters{}, 0.01);
  EXPECT_NEAR(mdpd_force(law, law.attraction, 0.5, 12.0, -2.0, 0.3), 98.0, 1e-12);
}

TEST(PairForce, OnlyAttractsBetweenRepulsionRadiusAndCutoff) {
  const MdpdLaw<double> law = liquid_law(LiquidParameters{}, 0.01);
  EXPECT_NEAR(mdpd_force(law, law.attraction, 0.8, 12.0, 0.0, 0.0), -8.0, 1e-12);
}

TEST(PairForce, FrictionAndNoiseObeyTheFluctuationDissipationTheorem) {
  LiquidParameters liquid;
  liquid.temperature = 0.7;
  liquid.random_amplitude = 5;
  const MdpdLaw<double> law = liquid_law(liquid, 0.02);
  EXPECT_NEAR(law.random_amplitude * law.random_amplitude * 0.02, 2 * law.friction * 0.7, 1e-12);
}

TEST(Units, WaterAtTenMicrometresHasWatersDensityAndTension) {
  const Units units = Units::matching(1e-5, 1000, 0.072, 6.05, 7.5);
  EXPECT_NEAR(6.05 * units.mass_kg / units.volume_m3(), 1000, 1e-9);
  EXPECT_NEAR(7.5 * units.surface_tension_N_per_m(), 0.072, 1e-15);
  EXPECT_NEAR(units.mass_kg, 1.65e-13, 0.01e-13);
}

}  // namespace
}  // namespace dmf::engine
