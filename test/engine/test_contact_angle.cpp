// The angle meters against spherical caps filled with evenly scattered points, whose angle is known.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/observe/contact_angle.h"
#include "systems.h"
#include "yaml/units.h"

namespace dmf::engine {
namespace {

constexpr double density = 6;

/// Points of a cap with the given contact angle and sphere radius, standing on z = 0 at the origin.
template <class Visit>
void cap_points(double angle, double radius, std::uint32_t stream, Visit visit) {
  const double centre = -radius * std::cos(angle * degree);
  const double top = centre + radius;
  const std::uint32_t count = static_cast<std::uint32_t>(density * 4 * radius * radius * top);
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t index = 3 * (k + stream * 1000003u);
    const Vector3d p((2 * scatter(index) - 1) * radius, (2 * scatter(index + 1) - 1) * radius,
                     scatter(index + 2) * top);
    if ((p - Vector3d(0, 0, centre)).norm() < radius) visit(p);
  }
}

class KnownCap : public testing::TestWithParam<double> {};

TEST_P(KnownCap, SessileMeterFindsItsAngle) {
  const double radius = GetParam() < 60 ? 20 : 11;
  SessileAngle meter(1.3 * radius, 2.3 * radius);
  for (std::uint32_t look = 0; look < 40; ++look) {
    cap_points(GetParam(), radius, look, [&](const Vector3d& p) { meter.add(p.cast<float>()); });
    meter.count_sample();
  }
  ASSERT_TRUE(meter.angle(density));
  EXPECT_NEAR(*meter.angle(density), GetParam(), 1.0);
}

TEST_P(KnownCap, RunningMeterFindsBothItsAngles) {
  const double radius = GetParam() < 60 ? 16 : 8;
  RunningAngles meter;
  for (std::uint32_t look = 0; look < 60; ++look) {
    meter.begin_sample(0.2, 100);
    cap_points(GetParam(), radius, look, [&](const Vector3d& p) { meter.add(p); });
  }
  const auto angles = meter.angles(density);
  ASSERT_TRUE(angles);
  EXPECT_NEAR(angles->advancing, GetParam(), 3.0);
  EXPECT_NEAR(angles->receding, GetParam(), 3.0);
}

INSTANTIATE_TEST_SUITE_P(Angles, KnownCap, testing::Values(50.0, 70.0, 90.0, 110.0, 130.0, 145.0));

TEST(CircleFit, IsExactOnACircleAndRefusesALine) {
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k < 12; ++k) points.emplace_back(1 + 5 * std::cos(0.2 * k), 2 + 5 * std::sin(0.2 * k));
  const auto circle = fit_circle(points);
  ASSERT_TRUE(circle);
  EXPECT_NEAR(circle->s, 1, 1e-9);
  EXPECT_NEAR(circle->z, 2, 1e-9);
  EXPECT_NEAR(circle->radius, 5, 1e-9);
  points.resize(4);
  EXPECT_FALSE(fit_circle(points));
}

TEST(ContactAngle, OfCirclesThatTouchCutAndHalve) {
  EXPECT_NEAR(contact_angle_of({0, 5, 5}), 180, 1e-6);
  EXPECT_NEAR(contact_angle_of({0, 0, 5}), 90, 1e-9);
  EXPECT_NEAR(contact_angle_of({0, -2.5, 5}), 60, 1e-9);
}

TEST(RunningAngles, SaysNothingBeforeItHasSeenEnough) {
  RunningAngles meter;
  meter.begin_sample(0.2, 10);
  cap_points(90, 8, 1, [&](const Vector3d& p) { meter.add(p); });
  EXPECT_FALSE(meter.angles(density));
}

}  // namespace
}  // namespace dmf::engine
