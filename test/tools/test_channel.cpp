// What is read off a profile, against profiles that are known.
#include <gtest/gtest.h>

#include <cmath>

#include "tools/channel.h"

namespace dmf::tools {
namespace {

ChannelProfile profile_of(double (*velocity)(double z)) {
  ChannelProfile profile;
  profile.half_width = 5;
  for (int slab = 0; slab < 20; ++slab) {
    const double z = -4.75 + 0.5 * slab;
    profile.z.push_back(z);
    profile.velocity.push_back(velocity(z));
    profile.density.push_back(std::abs(z) > 4.5 ? 3.6 : 4);
    profile.temperature.push_back(std::abs(z) > 4.5 ? 1.25 : 1);
  }
  return profile;
}

TEST(Channel, ShearGivesTheSlipAtTheWallsAndWhatStandsThere) {
  // At +-5 the line through the middle is at +-0.8 of the walls' 2; near them the profile bends off it.
  const ShearFlow flow =
      shear_of(profile_of([](double z) { return 0.32 * z + (std::abs(z) > 4 ? 0.1 : 0) * z; }), 2);
  EXPECT_NEAR(flow.slip, 0.2, 1e-12);
  EXPECT_NEAR(flow.density, 0.9, 1e-12);
  EXPECT_NEAR(flow.temperature, 1.25, 1e-12);
}

TEST(Channel, ParabolaGivesViscosityAndSlip) {
  // u = 3 - 0.1 z^2: mu = rho g / 0.2, and 0.5 is left at z = 5.
  const ChannelFlow flow = flow_of(profile_of([](double z) { return 3 - 0.1 * z * z; }), 0.05);
  EXPECT_NEAR(flow.fastest, 3, 1e-12);
  EXPECT_NEAR(flow.viscosity, 1, 1e-12);
  EXPECT_NEAR(flow.slip, 0.5, 1e-12);
  EXPECT_NEAR(flow.most_dense_at_wall, 1, 1e-12);
  EXPECT_NEAR(flow.hottest_at_wall, 1.25, 1e-12);
}

}  // namespace
}  // namespace dmf::tools
