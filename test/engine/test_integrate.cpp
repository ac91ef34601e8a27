#include <gtest/gtest.h>

#include "engine/integrate.h"
#include "systems.h"

namespace dmf::engine {
namespace {

/// One bead under a constant force.
System flying(const Vector3d& at, const Vector3d& velocity, const Vector3d& force,
              const Parameters& parameters) {
  System system{"flying", parameters, {}};
  add_bead(system, at);
  const Eigen::Vector3f v = velocity.cast<float>(), f = force.cast<float>();
  system.beads.velocity[0] = {v.x(), v.y(), v.z(), 0};
  system.beads.force[0] = {f.x(), f.y(), f.z(), 0};
  return system;
}

TEST(Integrator, FollowsAParabolaUnderConstantForceExactly) {
  const Vector3d at(2, 2, 2), v(0.5, -0.25, 0.1), f(1, 2, -0.5);
  Parameters parameters = periodic_box(20);
  System system = flying(at, v, f, parameters);
  for (std::uint64_t step = 0; step < 100; ++step) {
    drift(system.beads, parameters, step);
    finish(system.beads, parameters);
  }
  const double t = 100 * parameters.time_step;
  const Vector3d expected = at + v * t + 0.5 * f * t * t;
  const Record &p = system.beads.position[0], &u = system.beads.velocity[0];
  EXPECT_LT((Vector3d(p.x, p.y, p.z) - expected).norm(), 1e-4);
  EXPECT_LT((Vector3d(u.x, u.y, u.z) - (v + f * t)).norm(), 1e-5);
}

TEST(Integrator, ForcesSeeTheVelocityPredictedWithLambda) {
  Parameters parameters = periodic_box(20);
  parameters.integrator_lambda = 0.65;
  System system = flying({2, 2, 2}, {1, 0, 0}, {4, 0, 0}, parameters);
  drift(system.beads, parameters, 0);
  EXPECT_NEAR(system.beads.predicted[0].x, 1 + 0.65 * parameters.time_step * 4, 1e-6);
}

TEST(BounceBack, SendsABeadBackAlongItsPathWithReversedVelocity) {
  Parameters parameters = plate(20, 10);
  parameters.time_step = 0.1;
  // 0.05 above the plane, falling 0.1 and gliding 0.2 in the step: half of the way down, half back.
  System system = flying({5, 5, 0.05}, {2, 0, -1}, Vector3d::Zero(), parameters);
  drift(system.beads, parameters, 0);
  finish(system.beads, parameters);
  const Record &p = system.beads.position[0], &v = system.beads.velocity[0];
  EXPECT_NEAR(p.x, 5.0, 1e-5);
  EXPECT_NEAR(p.z, 0.05, 1e-5);
  EXPECT_NEAR(v.x, -2, 1e-6);
  EXPECT_NEAR(v.z, 1, 1e-6);
}

TEST(BounceBack, KeepsEveryBeadInsideWhateverItsWay) {
  Parameters parameters = plate(6, 6);
  for (int axis = 0; axis < 2; ++axis)
    parameters.domain.lower_side[axis] = parameters.domain.upper_side[axis] = Side::reflecting;
  parameters.time_step = 0.05;
  System system{"hot gas", parameters, {}};
  scatter_beads(system, 3, {0, 0, 0}, {6, 6, 6}, [](const Vector3d&) { return true; });
  for (Record& v : system.beads.velocity) v.x *= 4, v.y *= 4, v.z *= 4;
  for (std::uint64_t step = 0; step < 2000; ++step) {
    drift(system.beads, parameters, step);
    finish(system.beads, parameters);
    for (const Record& p : system.beads.position)
      ASSERT_TRUE(parameters.domain.contains(Vector3d(p.x, p.y, p.z)));
  }
}

TEST(Drift, ReportsABeadThatIsNotANumberOrTooFast) {
  Parameters parameters = periodic_box(20);
  System calm = flying({2, 2, 2}, {1, 0, 0}, Vector3d::Zero(), parameters);
  EXPECT_EQ(drift(calm.beads, parameters, 0).wild_bead, -1);
  System fast = flying({2, 2, 2}, {60, 0, 0}, Vector3d::Zero(), parameters);
  EXPECT_EQ(drift(fast.beads, parameters, 0).wild_bead, 0);
  System broken = flying({2, 2, 2}, {0, 0, 0}, {0, std::nan(""), 0}, parameters);
  EXPECT_EQ(drift(broken.beads, parameters, 0).wild_bead, 0);
}

}  // namespace
}  // namespace dmf::engine
