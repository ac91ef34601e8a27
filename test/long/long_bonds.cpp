// Chains and membranes against statistics in closed form.
#include "runs.h"
#include "tools/study.h"

namespace dmf::tools {
namespace {

double reference_of(const Findings& findings, const std::string& of, const std::string& quantity) {
  for (const Finding& finding : findings)
    if (finding.of == of && finding.quantity == quantity) return std::stod(finding.theory.value);
  return NAN;
}

TEST(Chains, AreRandomWalksWithoutRepulsionAndGiveWayToAPullAsTheirPartitionFunctionSays) {
  const Findings found = study_chain(cases_of("chain", {"ideal=10", "ideal=20", "pulled=10", "pulled=20"}));
  for (const std::string chain : {"ideal=10", "ideal=20"}) {
    // Boltzmann's mean over a bond, by quadrature.
    EXPECT_NEAR(value_of(found, chain, "bond_square"), 0.4419, 0.01 * 0.4419);
    EXPECT_NEAR(value_of(found, chain, "end_to_end_square"), 1, 0.05);  // of (N - 1) <b^2>
    EXPECT_NEAR(value_of(found, chain, "gyration_square"), 1, 0.05);    // of (N^2 - 1) <b^2> / 6 N
  }
  // Four times as slow for a chain twice as long (Rouse) is the most, 2^1.5 (Zimm) what momentum that is kept
  // makes of it; short chains have less.
  const double slower = value_of(found, "ideal=20", "relaxation") / value_of(found, "ideal=10", "relaxation");
  EXPECT_GT(slower, 2);
  EXPECT_LT(slower, 4);
  for (const std::string chain : {"pulled=10", "pulled=20"})
    EXPECT_NEAR(value_of(found, chain, "extension"), reference_of(found, chain, "extension"),
                0.01 * reference_of(found, chain, "extension"));
}

TEST(TightMembranes, KeepTheirLiquidAreaAndVolume) {
  const Findings found = study_membrane(cases_of("membrane", {"tight_sphere2", "tight_red_cell"}));
  for (const std::string membrane : {"tight_sphere2", "tight_red_cell"}) {
    EXPECT_EQ(value_of(found, membrane, "crossed"), 0);
    EXPECT_NEAR(value_of(found, membrane, "area"), 1, 0.02);
    EXPECT_NEAR(value_of(found, membrane, "volume"), 1, 0.03);
  }
}

}  // namespace
}  // namespace dmf::tools
