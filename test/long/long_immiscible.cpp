// Two liquids that don't mix: their tension, and the angle at which they meet on a wall.
#include "runs.h"
#include "tools/study.h"

namespace dmf::tools {
namespace {

TEST(ImmiscibleLiquids, HaveChensTensionAndMeetAWallAtYoungsAngle) {
  const Findings found = study_young(cases_of("young", {"a_wA=14"}));
  EXPECT_NEAR(value_of(found, "liquids", "tension"), 5.25, 0.05 * 5.25);
  for (const Finding& finding : found) {
    if (finding.of != "a_wA=14" || finding.quantity != "angle") continue;
    // Young's equation with our own tensions; one run is good to some three degrees.
    EXPECT_NEAR(finding.mean().mean, std::stod(finding.theory.value), 5);
    EXPECT_NEAR(std::stod(finding.theory.value), 124, 6);  // with Chen's
  }
}

}  // namespace
}  // namespace dmf::tools
