#include <gtest/gtest.h>

#include "engine/parameters.h"
#include "engine/simulation.h"
#include "engine/wettability.h"

namespace dmf::engine {
namespace {

TEST(Parameters, DefaultsAreSound) { EXPECT_TRUE(violations(Parameters{}).empty()); }

TEST(Parameters, EveryViolationIsNamedAtOnceWithValueAndAllowedRange) {
  Parameters parameters;
  parameters.liquid.attraction = 3;
  parameters.time_step = 0;
  parameters.integrator_lambda = std::nan("");
  parameters.list_skin = 7;
  parameters.domain.lower_side[0] = Side::periodic;
  const std::vector<std::string> found = violations(parameters);
  ASSERT_EQ(found.size(), 5u);
  const auto names = [&](const std::string& text) {
    for (const std::string& line : found)
      if (line.rfind(text, 0) == 0 && line.find("allowed:") != std::string::npos) return true;
    return false;
  };
  EXPECT_TRUE(names("liquid.attraction: 3"));
  EXPECT_TRUE(names("time_step: 0"));
  EXPECT_TRUE(names("integrator_lambda: nan"));
  EXPECT_TRUE(names("list_skin: 7"));
  EXPECT_TRUE(names("domain.sides.x"));
}

TEST(Parameters, APeriodicBoxMustHoldThreeCells) {
  Parameters parameters;
  parameters.domain.lower = {0, 0, 0};
  parameters.domain.upper = {3.5, 10, 10};
  parameters.domain.lower_side =
      parameters.domain.upper_side = {Side::periodic, Side::reflecting, Side::reflecting};
  EXPECT_EQ(violations(parameters).size(), 1u);
  parameters.domain.upper.x() = 3.76;
  EXPECT_TRUE(violations(parameters).empty());
}

TEST(Simulation, RefusesUnsoundParameters) {
  Parameters parameters;
  parameters.time_step = -1;
  EXPECT_THROW(Simulation(parameters, ContactAngleCurve::lan2016()), InvalidInput);
}

}  // namespace
}  // namespace dmf::engine
