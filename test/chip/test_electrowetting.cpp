#include <gtest/gtest.h>

#include <cmath>

#include "chip/electrowetting.h"

namespace dmf::chip {
namespace {

// Teflon on a thin dielectric. gamma = 72 mN/m, eps_r = 2, d = 1 um: eta = eps_0 eps_r V^2 / (2 gamma d), by
// hand 8.8541878e-12 * 2 * 60^2 / (2 * 0.072 * 1e-6) = 0.442709 at 60 V. cos 110 = -0.342020, so cos theta =
// 0.100689 and theta = 84.22114 degrees. Then at 40 V: eta = 0.196760, cos theta = -0.145260, theta
// = 98.35236 degrees.
TEST(Electrowetting, FollowsYoungAndLippmannWithADielectricsNumbers) {
  const Electrowetting law{110, 60, 84.22114, 55, 80};
  EXPECT_NEAR(law.number(60), 0.442709, 2e-6);
  EXPECT_NEAR(law.number(40), 0.196760, 2e-6);
  EXPECT_NEAR(law.contact_angle(40), 98.35236, 2e-5);
}

TEST(Electrowetting, MeetsItsEndsExactly) {
  const Electrowetting lan;  // 150 degrees at rest, 40 at 63 V
  EXPECT_EQ(lan.contact_angle(0), 150.0);
  EXPECT_NEAR(lan.contact_angle(63), 40.0, 1e-12);
  EXPECT_GE(lan.contact_angle(63), 40.0);
}

TEST(Electrowetting, OnlyTheSquareOfTheVoltageActs) {
  const Electrowetting law;
  EXPECT_EQ(law.contact_angle(-30), law.contact_angle(30));
  EXPECT_DOUBLE_EQ(law.number(40), 4 * law.number(20));
}

TEST(Electrowetting, NeverFallsBelowSaturation) {
  const Electrowetting law{110, 63, 60, 55, 500};
  EXPECT_EQ(law.contact_angle(100), 55.0);
  EXPECT_EQ(law.contact_angle(1e6), 55.0) << "cos theta would be far above 1";
  for (double voltage = 0; voltage < 100; voltage += 1) {
    EXPECT_LE(law.contact_angle(voltage + 1), law.contact_angle(voltage));
  }
}

TEST(Electrowetting, MembersOutOfRangeAreAllNamed) {
  EXPECT_TRUE(violations(Electrowetting{}).empty());
  EXPECT_EQ(violations(Electrowetting{190, -1, 200, 195, 0}).size(), 5u);
  EXPECT_EQ(violations(Electrowetting{NAN, 63, 60, 55, 80}).size(), 3u)
      << "the others have nothing to compare with";
  EXPECT_EQ(violations(Electrowetting{110, 63, 50, 55, 80}).front(),
            "reference_angle: 50, allowed: [55, 110) degrees, from saturation_angle to below rest_angle");
}

}  // namespace
}  // namespace dmf::chip
