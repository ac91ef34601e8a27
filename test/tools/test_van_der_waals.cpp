#include "tools/van_der_waals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tools/liquid.h"

namespace dmf::tools {
namespace {

// Liu's figure 13.
constexpr VanDerWaals liu{1.9 * 0.016, 0.016, 0};

TEST(VanDerWaals, IsFoundAgainFromPressuresOfItsLoop) {
  // At k_BT = 0.54 its isotherm falls between two densities.
  std::vector<double> densities, pressures;
  for (double density = 5; density < 45; density += 5) {
    densities.push_back(density);
    pressures.push_back(liu.pressure(density, 0.54));
  }
  const VanDerWaals found = fit_van_der_waals(densities, pressures, 0.54);
  EXPECT_NEAR(found.attraction, liu.attraction, 1e-6);
  EXPECT_NEAR(found.excluded_volume, liu.excluded_volume, 1e-6);
  EXPECT_LT(found.residual, 1e-4);
}

TEST(VanDerWaals, HasItsCriticalPointWhereTheTextbooksSay) {
  // rho_c = 1 / (3 b), k_BT_c = 8 a / (27 b), p_c = a / (27 b^2): there the isotherm is flat.
  const double density = 1 / (3 * liu.excluded_volume),
               temperature = 8 * liu.attraction / (27 * liu.excluded_volume);
  EXPECT_NEAR(liu.pressure(density, temperature),
              liu.attraction / (27 * liu.excluded_volume * liu.excluded_volume), 1e-12);
  const double h = 1e-3 * density;
  EXPECT_NEAR((liu.pressure(density + h, temperature) - liu.pressure(density - h, temperature)) / (2 * h), 0,
              1e-5);
}

TEST(VanDerWaals, LeavesAResidualWherePressuresAreNotItsOwn) {
  const VanDerWaals fit = fit_van_der_waals({1, 2, 3, 4}, {1, 3, 2, 5}, 1);
  EXPECT_GT(fit.residual, 0.3);
}

/// Liu (18).
double cubic_spline(double r, double cutoff) {
  const double q = 2 * r / cutoff;
  return q < 1 ? 1 - 1.5 * q * q + 0.75 * q * q * q : q < 2 ? 0.25 * std::pow(2 - q, 3) : 0;
}

/// 2 pi times the integral of r^2 (1 - exp(-U)) at k_BT = 1.
double second_virial_coefficient(double strength, const engine::SplineParameters& spline) {
  double sum = 0;
  constexpr int n = 10'000;
  for (int k = 0; k < n; ++k) {
    const double r = (k + 0.5) / n;
    const double energy = strength * (spline.repulsion * cubic_spline(r, spline.repulsion_radius) -
                                      spline.attraction * cubic_spline(r, spline.attraction_radius));
    sum += 2 * M_PI * r * r * (1 - std::exp(-energy)) / n;
  }
  return sum;
}

// One that only repels, and Liu's of figure 17 with a third of its strength: 0.28 and -0.18.
TEST(Bulk, OfLiusSplinesHasThePressureOfItsSecondVirialCoefficientWhileItIsThin) {
  for (const auto& [strength, attraction] : {std::pair{3.0, 0.0}, {6.0, 1.0}}) {
    LiquidRun how;
    how.quick = true;
    how.measure = 10;
    how.bulk_cells = 8;
    how.liquid.attraction = strength;
    how.liquid.repulsion = 0;
    how.liquid.random_amplitude = 3;
    how.liquid.initial_density = how.liquid.bulk_density = 1;
    how.spline = {true, 2, 0.8, attraction, 1};
    const BulkResult bulk = run_bulk(how);
    const double coefficient = second_virial_coefficient(strength, how.spline);
    EXPECT_GT(std::abs(coefficient), 0.15);
    EXPECT_NEAR(bulk.pressure, bulk.density * bulk.temperature + coefficient * bulk.density * bulk.density,
                0.05)
        << strength;
  }
}

TEST(VanDerWaals, NeedsThreePressures) {
  EXPECT_THROW(fit_van_der_waals({1, 2}, {1, 2}, 1), std::invalid_argument);
  EXPECT_THROW(fit_van_der_waals({1, 2, 3}, {1, 2}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace dmf::tools
