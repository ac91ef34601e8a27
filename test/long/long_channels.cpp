// Plain DPD in channels, against the papers' numbers and the solutions of Stokes' equation.
#include "runs.h"
#include "tools/study.h"

namespace dmf::tools {
namespace {

TEST(Poiseuille, HasLansLargestVelocityAndTheViscosityOfKineticTheory) {
  const Findings found = study_poiseuille(cases_of("poiseuille", {"3D"}));
  EXPECT_NEAR(value_of(found, "3D", "u_max"), 8.60, 0.03 * 8.60);
  // Lan (2.32) is 1.077 of 45 / (4 pi gamma) and its second term at four beads per r_c^3.
  EXPECT_NEAR(value_of(found, "3D", "viscosity"), 1.077, 0.03 * 1.077);
  EXPECT_LT(value_of(found, "3D", "slip"), 0.03 * 8.60);
}

TEST(SquareChannel, HasChensMassFlowAndTheProfileOfADuct) {
  const Findings found = study_square_channel(cases_of("square_channel", {"a_AW=9.68"}));
  EXPECT_NEAR(value_of(found, "a_AW=9.68", "mass_flow"), 3416, 0.02 * 3416);
  EXPECT_LT(value_of(found, "a_AW=9.68", "deviation"), 0.01);
  EXPECT_NEAR(value_of(found, "a_AW=9.68", "fitted_half_width"), 10, 0.15);
  EXPECT_NEAR(value_of(found, "a_AW=9.68", "temperature"), 1, 0.01);
}

}  // namespace
}  // namespace dmf::tools
