#include "tools/van_der_waals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

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

TEST(VanDerWaals, NeedsThreePressures) {
  EXPECT_THROW(fit_van_der_waals({1, 2}, {1, 2}, 1), std::invalid_argument);
  EXPECT_THROW(fit_van_der_waals({1, 2, 3}, {1, 2}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace dmf::tools
