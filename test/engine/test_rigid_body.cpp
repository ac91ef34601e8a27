// Shells, free turning, contact and friction against closed forms of rigid-body mechanics.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/bodies/contact.h"
#include "engine/bodies/rigid_body.h"
#include "engine/bodies/shell.h"
#include "engine/bodies/smooth_sphere.h"

namespace dmf::engine {
namespace {

TEST(Shell, CountsAreThoseOfTheDividedIcosahedron) {
  for (const std::uint32_t count : {12u, 32u, 42u, 72u, 312u, 612u, 1242u})
    EXPECT_TRUE(is_shell_count(count)) << count;
  for (const std::uint32_t count : {0u, 1u, 2u, 600u, 611u, 1243u})
    EXPECT_FALSE(is_shell_count(count)) << count;
  EXPECT_EQ(nearest_shell_count(600), 612u);
  EXPECT_EQ(nearest_shell_count(0), 12u);
}

TEST(Shell, SpreadsItsBeadsEvenly) {
  for (const std::uint32_t count : {12u, 312u, 612u, 1242u}) {
    const std::vector<Vector3d> points = shell_points(count);
    ASSERT_EQ(points.size(), count);
    Vector3d centroid = Vector3d::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    double closest = 10, farthest = 0;
    for (const Vector3d& point : points) {
      EXPECT_NEAR(point.norm(), 1, 1e-12);
      centroid += point / count;
      second += point * point.transpose() / count;
      double nearest = 10;
      for (const Vector3d& other : points)
        if (&other != &point) nearest = std::min(nearest, (other - point).norm());
      closest = std::min(closest, nearest);
      farthest = std::max(farthest, nearest);
    }
    // The symmetry of the icosahedron: no direction is preferred, so I = 2/3 m R^2 about every axis.
    EXPECT_LT(centroid.norm(), 1e-12) << count;
    EXPECT_LT((second - Eigen::Matrix3d::Identity() / 3).norm(), 1e-12) << count;
    // Each of N caps of equal area, packed in hexagons, would be this far from the next.
    const double even = std::sqrt(8 * M_PI / (std::sqrt(3.0) * count));
    EXPECT_GT(closest, 0.88 * even) << count;
    EXPECT_LT(farthest, 1.08 * even) << count;
  }
}

TEST(SmoothShell, GivesTheSumsOverTheBeadsOfAFineShell) {
  // The integrals against a shell of some 5,000 beads, averaged over directions.
  const std::uint32_t count = nearest_shell_count(5000);
  const std::vector<Vector3d> points = shell_points(count);
  for (const double radius : {1.0, 2.5}) {
    const SmoothShell smooth(radius, count / (4 * M_PI * radius * radius), 0.75);
    for (const double distance : {radius + 0.1, radius + 0.3, radius + 0.6, radius + 0.95, 0.8 * radius}) {
      double weight = 0, density = 0;
      const int directions = 60;
      for (int k = 0; k < directions; ++k) {
        const double z = 2 * (k + 0.5) / directions - 1, turn = 2.399963 * k;
        const Vector3d out(std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z);
        for (const Vector3d& point : points) {
          const Vector3d d = distance * out - radius * point;
          const double r = d.norm();
          if (r < 1) weight += (1 - r) * d.dot(out) / r / directions;
          if (r < 0.75) density += 15 / (2 * M_PI * 0.421875) * (1 - r / 0.75) * (1 - r / 0.75) / directions;
        }
      }
      EXPECT_NEAR(smooth.weight(distance, 1.0), weight, 0.01 * std::abs(weight) + 0.02) << distance;
      EXPECT_NEAR(smooth.density(distance), density, 0.01 * density + 0.02) << distance;
    }
  }
}

TEST(Shell, PatchesHoldAllBeadsAndAreSmall) {
  std::vector<Vector3d> points = shell_points(612);
  const std::vector<std::uint32_t> ends = order_in_patches(points, 24);
  EXPECT_EQ(ends.back(), 612u);
  std::uint32_t begin = 0;
  for (const std::uint32_t end : ends) {
    EXPECT_LE(end - begin, 24u);
    // 24 of 612 beads cover a disc of radius 0.4; a patch is at worst a few times as long as wide.
    for (std::uint32_t i = begin; i < end; ++i) EXPECT_LT((points[i] - points[begin]).norm(), 1.2);
    begin = end;
  }
}

RigidBody top(double a, double b, double c) {
  RigidBody body;
  body.mass = 3;
  body.inertia = {a, b, c};
  return body;
}

TEST(FreeTurning, KeepsAngularMomentumAndEnergyOfAnAsymmetricBody) {
  RigidBody body = top(1, 2, 3.5);
  body.angular_momentum = {0.3, 2, -0.7};
  const Vector3d before = body.angular_momentum;
  const auto energy = [&body] { return 0.5 * body.angular_momentum.dot(body.angular_velocity()); };
  const double energy_before = energy();
  double largest = 0;
  for (int k = 0; k < 100000; ++k) {
    body.turn(0.01);
    largest = std::max(largest, std::abs(energy() / energy_before - 1));
  }
  EXPECT_EQ(body.angular_momentum, before);
  EXPECT_LT(largest, 1e-4);  // second order in the step, without drift: 1000 turns
  EXPECT_NEAR(body.orientation.norm(), 1, 1e-12);
}

TEST(FreeTurning, PrecessesAsASymmetricTopDoes) {
  // The axis of a free symmetric top circles the angular momentum at the rate L / I_perpendicular.
  RigidBody body = top(2, 2, 3);
  body.angular_momentum = 1.5 * Vector3d(std::sin(0.4), 0, std::cos(0.4));
  body.orientation = Eigen::Quaterniond::Identity();
  const Vector3d along = body.angular_momentum.normalized();
  const double rate = body.angular_momentum.norm() / 2;
  const double time = 37.3;
  const int steps = 3730;
  for (int k = 0; k < steps; ++k) body.turn(time / steps);
  const Vector3d expected = Eigen::AngleAxisd(rate * time, along) * Vector3d::UnitZ();
  EXPECT_LT((body.orientation * Vector3d::UnitZ() - expected).norm(), 1e-4);
}

TEST(FreeTurning, CanBeReversed) {
  RigidBody body = top(1, 2, 3.5);
  body.angular_momentum = {1.3, 2, -0.7};
  for (int k = 0; k < 1000; ++k) body.turn(0.02);
  body.angular_momentum = -body.angular_momentum;
  for (int k = 0; k < 1000; ++k) body.turn(0.02);
  EXPECT_LT(body.orientation.angularDistance(Eigen::Quaterniond::Identity()), 1e-10);
}

/// Lan's microparticle in steady contact with the wall.
struct Rolling {
  RigidBody body;
  std::vector<WallContact> contacts;
  static constexpr double load = 300, time_step = 0.01;

  Rolling() {
    body.mass = 612;
    body.inertia = Vector3d::Constant(2.0 / 3.0 * 612);
    contacts = {{{0, 0, -1}, {0, 0, 1}, 1.0, load, Vector3d::Zero()}};
  }
  Vector3d velocity_at_contact() const {
    return body.velocity + body.angular_velocity().cross(contacts[0].arm);
  }
  void pull(const Vector3d& force, ContactModel model, const Friction& friction, int steps) {
    for (int k = 0; k < steps; ++k) {
      body.velocity += time_step / body.mass * force;
      apply_friction(model, friction, contacts, time_step, body);
    }
  }
};

TEST(CoulombFriction, HoldsAPulledSphereOnlyByRolling) {
  // Rolling without sliding: a = F / (m + I / R^2) = 0.6 F / m for a shell, friction 0.4 F.
  Rolling rolling;
  rolling.pull({50, 0, 0}, ContactModel::coulomb, {0.2, 0.2, 0}, 1000);
  EXPECT_NEAR(rolling.body.velocity.x(), 0.6 * 50 / 612 * 10, 1e-9);
  EXPECT_NEAR(rolling.velocity_at_contact().norm(), 0, 1e-12);
}

TEST(CoulombFriction, LetsAHardPulledSphereSlide) {
  // Friction needed to roll is 0.4 F = 80 > f N = 60: it slides, with a = (F - f N) / m, and turns with
  // f N R / I.
  Rolling rolling;
  rolling.pull({200, 0, 0}, ContactModel::coulomb, {0.2, 0.2, 0}, 1000);
  EXPECT_NEAR(rolling.body.velocity.x(), (200 - 60) / 612.0 * 10, 1e-9);
  EXPECT_NEAR(rolling.body.angular_velocity().y(), 60 / 408.0 * 10, 1e-9);
}

TEST(CoulombFriction, TurnsASlidingSphereIntoARollingOne) {
  // Angular momentum about the contact is kept: v = v_0 / (1 + I / (m R^2)) = 0.6 v_0.
  Rolling rolling;
  rolling.body.velocity = {0, 0.5, 0};
  rolling.pull(Vector3d::Zero(), ContactModel::coulomb, {0.2, 0.2, 0}, 2000);
  EXPECT_NEAR(rolling.body.velocity.y(), 0.3, 1e-9);
  EXPECT_NEAR(rolling.velocity_at_contact().norm(), 0, 1e-12);
}

TEST(LanFriction, HoldsWhatIsPulledWithLessThanTheStaticLimit) {
  Rolling rolling;
  rolling.pull({59, 0, 0}, ContactModel::lan2016, {0.2, 0.2, 0.1}, 1000);
  EXPECT_EQ(rolling.body.velocity.norm(), 0);
  rolling.pull({61, 0, 0}, ContactModel::lan2016, {0.2, 0.2, 0.1}, 1000);
  EXPECT_NEAR(rolling.body.velocity.x(), 1.0 / 612 * 10, 1e-9);
}

TEST(LanFriction, KineticLimitActsOnceTheStaticOneIsPassed) {
  Rolling rolling;
  rolling.pull({61, 0, 0}, ContactModel::lan2016, {0.2, 0.1, 0.1}, 1000);
  EXPECT_NEAR(rolling.body.velocity.x(), (61 - 30) / 612.0 * 10, 1e-9);
}

TEST(LanFriction, MakesNoTorqueAndRollingMovesTheCentre) {
  Rolling rolling;
  rolling.body.velocity = {0.2, 0, 0};
  rolling.body.angular_momentum = {0, 40.8, 0};  // 0.1 a time unit about y: rolls along +x
  const FrictionReport report = apply_friction(ContactModel::lan2016, {0.2, 0.2, 0}, rolling.contacts,
                                               Rolling::time_step, rolling.body);
  EXPECT_NEAR(rolling.body.angular_velocity().y(), 0.1, 1e-12);
  EXPECT_NEAR(report.rolling.x(), 0.1, 1e-12);
  EXPECT_NEAR(report.force.x(), -60, 1e-9);
}

TEST(RollingFriction, SlowsTurningByItsTorqueAndStopsIt) {
  for (const ContactModel model : {ContactModel::lan2016, ContactModel::coulomb}) {
    Rolling rolling;
    rolling.body.angular_momentum = {0, 4.08, 7};
    rolling.pull(Vector3d::Zero(), model, {0, 0, 0.1}, 5);  // 30 torque, 1.5 in five steps
    EXPECT_NEAR(rolling.body.angular_momentum.y(), 4.08 - 1.5, 1e-9);
    rolling.pull(Vector3d::Zero(), model, {0, 0, 0.1}, 100);
    EXPECT_NEAR(rolling.body.angular_momentum.y(), 0, 1e-12);
    EXPECT_NEAR(rolling.body.angular_momentum.z(), 7, 1e-12);  // spin about the normal goes on
  }
}

TEST(Hertz, ForceAndStiffnessAreThoseOfTheClosedForm) {
  EXPECT_NEAR(hertz_force(1e6, 1, 0.0025), 4.0 / 3.0 * 1e6 * std::pow(0.0025, 1.5), 1e-9);
  // Lan's contact under the load of its adhesion, 298: d = 0.00368, k = 2 E sqrt(R d) = 1.2e5, 14 radians a
  // time unit. The limit is where the frequency times the step is 0.5.
  const double largest = largest_elastic_modulus(612, 1, 298, 0.01);
  const double indentation = std::pow(298 / (4.0 / 3.0 * largest), 2.0 / 3.0);
  EXPECT_NEAR(std::sqrt(2 * largest * std::sqrt(indentation) / 612) * 0.01, 0.5, 1e-6);
}

}  // namespace
}  // namespace dmf::engine
