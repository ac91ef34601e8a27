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

// The same plate from its dielectric: eta as above, and cos 55 - cos 110 = 0.915597 is reached at
// V = sqrt(0.915597 / (8.8541878e-12 * 2 / (2 * 0.072 * 1e-6))) = 86.2868 V.
TEST(Electrowetting, FollowsFromADielectric) {
  const Dielectric teflon{2, 1e-6};
  Electrowetting plate{110, 0, 0, 55, 100};
  const Electrowetting law = with_dielectric(plate, teflon, 0.072);
  EXPECT_NEAR(law.number(60), 0.442709, 2e-6);
  EXPECT_NEAR(law.contact_angle(40), 98.35236, 2e-5);
  EXPECT_NEAR(law.reference_voltage, 86.2868, 1e-4) << "where it saturates";
  EXPECT_EQ(law.reference_angle, 55);
  plate.max_voltage = 60;
  const Electrowetting limited = with_dielectric(plate, teflon, 0.072);
  EXPECT_EQ(limited.reference_voltage, 60) << "it does not get as far as saturation";
  EXPECT_NEAR(limited.reference_angle, 84.22114, 2e-5);
  EXPECT_NEAR(limited.contact_angle(40), 98.35236, 2e-5);
}

TEST(Electrowetting, ADielectricsCapacitanceComesBackFromItsLaw) {
  const Dielectric parylene{3, 5e-6};  // 8.8541878e-12 * 3 / 5e-6 = 5.31251e-6 F/m^2
  EXPECT_NEAR(parylene.capacitance(), 5.31251e-6, 1e-11);
  Electrowetting plate{115, 0, 0, 60, 300};
  for (const double threshold : {0.0, 50.0}) {
    plate.threshold_voltage = threshold;
    const Electrowetting law = with_dielectric(plate, parylene, 0.05);
    EXPECT_NEAR(law.dielectric_capacitance(0.05), 5.31251e-6, 1e-11) << threshold;
  }
}

// Between 25 V and 65 V lie 65^2 - 25^2 = 3600 = 60^2 of square: at sqrt(25^2 + 30^2) = 39.0512 V a quarter
// of the reference's eta acts.
TEST(Electrowetting, BelowTheThresholdNothingActsAndAboveItsSquareIsLost) {
  Electrowetting law{110, 65, 60, 55, 80};
  law.threshold_voltage = 25;
  EXPECT_EQ(law.contact_angle(25), 110.0);
  EXPECT_EQ(law.number(10), 0);
  EXPECT_NEAR(law.contact_angle(25.0001), 110.0, 1e-3) << "continuous";
  EXPECT_LT(law.contact_angle(26), 110.0);
  EXPECT_NEAR(law.contact_angle(65), 60, 1e-12) << "the reference point is met all the same";
  EXPECT_NEAR(law.number(std::sqrt(25. * 25 + 30 * 30)), law.number(65) / 4, 1e-12);
}

TEST(Electrowetting, AtTheCutoffFrequencyHalfOfTheSquareActs) {
  Electrowetting law{110, 63, 60, 55, 80};
  EXPECT_EQ(law.number(40, 5e4), law.number(40)) << "no roll-off unless it is asked for";
  law.cutoff_frequency = 1e3;
  EXPECT_EQ(law.number(40, 0), law.number(40));
  EXPECT_DOUBLE_EQ(law.number(40, 1e3), law.number(40) / 2);
  EXPECT_DOUBLE_EQ(law.number(40, 3e3), law.number(40) / 10);
  law.threshold_voltage = 40;
  EXPECT_GT(law.number(50, 0), 0);
  EXPECT_EQ(law.number(50, 1e3), 0) << "50 V act as 35 V";
}

TEST(Electrowetting, VoltageOfANumberIsItsInverse) {
  Electrowetting law{110, 63, 60, 55, 80};
  law.threshold_voltage = 20;
  law.cutoff_frequency = 2e3;
  for (const double voltage : {21.0, 40.0, 63.0}) {
    EXPECT_NEAR(law.voltage_of_number(law.number(voltage, 0), 0), voltage, 1e-10);
  }
  EXPECT_NEAR(law.voltage_of_number(law.number(60, 1e3), 1e3), 60, 1e-10);
  EXPECT_NEAR(law.voltage_of_number(0, 0), 20, 1e-10);
}

TEST(Electrowetting, MembersOutOfRangeAreAllNamed) {
  EXPECT_TRUE(violations(Electrowetting{}).empty());
  EXPECT_EQ(violations(Electrowetting{190, -1, 200, 195, 0}).size(), 5u);
  EXPECT_EQ(violations(Electrowetting{NAN, 63, 60, 55, 80}).size(), 3u)
      << "the others have nothing to compare with";
  EXPECT_EQ(violations(Electrowetting{110, 63, 50, 55, 80}).front(),
            "reference_angle: 50, allowed: [55, 110) degrees, from saturation_angle to below rest_angle");
  Electrowetting law;
  law.threshold_voltage = 63;
  EXPECT_EQ(violations(law).at(0),
            "threshold_voltage: 63, allowed: [0, 63) V, below reference_voltage and max_voltage");
  law.threshold_voltage = law.cutoff_frequency = law.breakdown_voltage = law.charging_time = -1;
  EXPECT_EQ(violations(law).size(), 4u);
}

}  // namespace
}  // namespace dmf::chip
