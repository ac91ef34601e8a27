// Microparticles and the solid of a label grid: faces, seams, edges, corners and holes.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/bodies/contact.h"
#include "engine/simulation.h"
#include "refusal.h"
#include "systems.h"

namespace dmf::engine {
namespace {

constexpr double mass = 612, hertz = 4.0 / 3.0 * 1e6;

void run(Simulation& simulation, int steps) {
  for (int k = 0; k < steps; ++k) simulation.step();
}

MicroparticleObservation only_one(const Simulation& simulation) {
  return simulation.observe()->microparticles.at(0);
}

/// How far a sphere of radius 1 is pressed in by a force.
double indentation(double force) { return std::pow(force / hertz, 2.0 / 3.0); }

/// A dry box of 10 r_c, closed but along y, with voxels of 0.2 r_c, solid where `is_solid` holds for their
/// middles. Nothing adheres.
template <class IsSolid>
Parameters box_with(IsSolid is_solid) {
  Parameters parameters = periodic_box(10);
  for (const int axis : {0, 2})
    parameters.domain.lower_side[axis] = parameters.domain.upper_side[axis] = Side::reflecting;
  auto grid = std::make_shared<LabelGrid>();
  grid->voxels = {50, 50, 50};
  grid->voxel_size = Vector3d::Constant(0.2);
  for (int z = 0; z < 50; ++z)
    for (int y = 0; y < 50; ++y)
      for (int x = 0; x < 50; ++x)
        grid->labels.push_back(is_solid(0.2 * Vector3d(x + .5, y + .5, z + .5)) ? LabelGrid::solid
                                                                                : LabelGrid::fluid);
  parameters.label_grid.grid = grid;
  parameters.microparticles.wall_attraction = 0;
  return parameters;
}

Parameters box_with_a_floor() {
  return box_with([](const Vector3d& p) { return p.z() < 2; });
}

/// Lan's microparticle; without friction.
MicroparticlePlacement slippery_at(const Vector3d& centre) {
  MicroparticlePlacement placement = sphere_at(centre.head<2>(), centre.z());
  placement.static_friction = placement.rolling_friction = 0;
  return placement;
}

/// A run of one microparticle.
class Dry : public Simulation {
 public:
  Dry(const Parameters& parameters, const MicroparticlePlacement& placement)
      : Simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"}) {
    add_microparticle(placement);
  }
};

TEST(SolidContact, RestsOnAFloorOfVoxelsAsOnAPlate) {
  // Voxels as large as the lattice of their beads, so that a layer of these lies in the face, as on a plate.
  constexpr double a = 0.874;
  Parameters parameters = plate(11 * a, 12 * a);
  parameters.domain.lower_side[2] = Side::reflecting;
  auto grid = std::make_shared<LabelGrid>();
  grid->voxels = {11, 11, 4};
  grid->labels.assign(11 * 11 * 3, LabelGrid::solid);
  grid->labels.resize(11 * 11 * 4, LabelGrid::fluid);
  parameters.label_grid.grid = grid;
  parameters.microparticles.contact_damping = 0.3;
  Dry simulation(parameters, sphere_at({5, 5}, 3 * a + 1));
  run(simulation, 1000);
  const MicroparticleObservation rested = only_one(simulation);
  EXPECT_EQ(rested.contact_fraction, 1);
  EXPECT_LT(rested.velocity.norm(), 1e-5);  // beads are where floats have them
  // The load is an integral; the sum over beads is some percent off, as on a plate.
  const double load = wall_adhesion(-1, 1, 612 / (4 * std::acos(-1)), WallParameters{});
  EXPECT_NEAR(rested.normal_force, load, 0.05 * load);
  EXPECT_NEAR(3 * a + 1 - rested.position.z(), indentation(rested.normal_force), 1e-6);
}

TEST(SolidContact, RollsOverTheSeamsOfVoxelsAsIfThereWereNone) {
  // Also along a seam, exactly above it: then two voxels are equally near, and only one may count.
  for (const double y : {5.03, 5.0}) {
    SCOPED_TRACE(y);
    Parameters parameters = box_with_a_floor();
    parameters.microparticles.contact = ContactModel::coulomb;
    MicroparticlePlacement placement = sphere_at({2, y}, 3 - indentation(mass * 1));
    placement.rolling_friction = 0;
    Dry simulation(parameters, placement);
    simulation.set_body_forces({{0.1, 0, -1}, Vector3d::Zero()});
    run(simulation, 800);
    const MicroparticleObservation rolled = only_one(simulation);
    // A shell that does not slide, on an arm of its radius less the indentation: a = 0.1 / (1 + 2/3 / arm^2).
    const double arm = 1 - indentation(mass), acceleration = 0.1 / (1 + 2.0 / 3 / (arm * arm));
    EXPECT_NEAR(rolled.velocity.x(), acceleration * 8, 1e-3);
    EXPECT_NEAR(rolled.position.x(), 2 + 0.5 * acceleration * 64, 5e-3);
    EXPECT_NEAR(rolled.angular_velocity.y() * arm, rolled.velocity.x(), 1e-3);
    EXPECT_NEAR(rolled.velocity.y(), 0, 1e-9);
    EXPECT_NEAR(rolled.normal_force, mass, 0.02 * mass);
  }
}

TEST(SolidContact, RestsInACornerOnBothOfItsFaces) {
  Parameters parameters = box_with([](const Vector3d& p) { return p.z() < 2 || p.x() < 2; });
  parameters.microparticles.contact_damping = 0.3;
  Dry simulation(parameters, slippery_at({3.1, 5, 3.2}));
  simulation.set_body_forces({{-0.3, 0, -0.5}, Vector3d::Zero()});
  run(simulation, 3000);
  const MicroparticleObservation rested = only_one(simulation);
  EXPECT_LT(rested.velocity.norm(), 1e-6);
  EXPECT_NEAR(rested.position.x(), 3 - indentation(0.3 * mass), 1e-5);
  EXPECT_NEAR(rested.position.z(), 3 - indentation(0.5 * mass), 1e-5);
  EXPECT_NEAR(rested.normal_force, 0.5 * mass, 0.01);  // what it stands on, not what it leans at
}

TEST(SolidContact, BouncesOffAnEdgeAboutTheNormalThere) {
  // Falls with its centre 0.6 beyond the edge of a floor: the normal is (0.6, 0, 0.8).
  const Parameters parameters = box_with([](const Vector3d& p) { return p.z() < 2 && p.x() < 5; });
  Dry simulation(parameters, slippery_at({5.6, 5, 3.2}));
  simulation.set_body_forces({{0, 0, -0.2}, Vector3d::Zero()});
  run(simulation, 100);
  simulation.set_body_forces({});
  run(simulation, 1);  // the last half kick
  const double before = -only_one(simulation).velocity.z();
  EXPECT_NEAR(before, 0.2, 0.01);
  run(simulation, 500);
  const MicroparticleObservation after = only_one(simulation);
  // v - 2 (v n) n. It is pressed in by (15/16 m v_n^2 / E)^(2/5), 0.01, and its centre comes down by as much
  // more, which turns the normal by some 0.02 meanwhile.
  EXPECT_NEAR(after.velocity.x(), 0.96 * before, 0.03 * before);
  EXPECT_NEAR(after.velocity.z(), 0.28 * before, 0.03 * before);
  EXPECT_NEAR(after.velocity.norm(), before, 0.005 * before);
  EXPECT_LT(after.angular_velocity.norm(), 1e-9);
}

/// A wall across x from 4 to 5 with a square hole around its middle.
Parameters box_with_a_hole(double half_width) {
  Parameters parameters = box_with([half_width](const Vector3d& p) {
    return p.x() > 4 && p.x() < 5 && std::max(std::abs(p.y() - 5), std::abs(p.z() - 5)) > half_width;
  });
  parameters.microparticles.contact_damping = 0.3;
  return parameters;
}

TEST(SolidContact, AHoleThatIsTooSmallHoldsItAtFourEdges) {
  MicroparticlePlacement placement = slippery_at({2, 5, 5});
  placement.magnetic = true;
  Dry simulation(box_with_a_hole(0.8), placement);
  simulation.set_body_forces({Vector3d::Zero(), {60, 0, 0}});
  run(simulation, 3000);
  const MicroparticleObservation held = only_one(simulation);
  // Edges 0.8 from the axis touch a sphere of radius 1 whose centre is 0.6 before them.
  EXPECT_NEAR(held.position.x(), 3.4, 0.005);
  EXPECT_NEAR(held.position.y(), 5, 1e-6);
  EXPECT_LT(held.velocity.norm(), 1e-6);
  // 4 * 0.6 * F = pull; one of the four is below it and pushes up with 0.8 F.
  EXPECT_NEAR(held.normal_force, 0.8 * 60 / 2.4, 0.2);
}

TEST(SolidContact, AHoleThatIsLargeEnoughLetsItThrough) {
  MicroparticlePlacement placement = slippery_at({2, 5.1, 5});
  placement.magnetic = true;
  Dry simulation(box_with_a_hole(1.2), placement);
  simulation.set_body_forces({Vector3d::Zero(), {60, 0, 0}});
  run(simulation, 1000);
  const MicroparticleObservation passed = only_one(simulation);
  EXPECT_NEAR(passed.position.x(), 2 + 0.5 * 60 / mass * 100, 0.01);
  EXPECT_EQ(passed.position.y(), 5.1);
}

TEST(SolidContact, FrictionHoldsItAtAWallAsLongAsItMay) {
  // Pressed against a face across x and pulled down: it slides when the weight is more than f_s times the
  // pressure, with what is left.
  const Parameters parameters = box_with([](const Vector3d& p) { return p.x() < 2; });
  for (const ContactModel model : {ContactModel::lan2016, ContactModel::coulomb})
    for (const double weight : {150.0, 300.0}) {
      SCOPED_TRACE(weight);
      Parameters pressed = parameters;
      pressed.microparticles.contact = model;
      MicroparticlePlacement placement = sphere_at({3 - indentation(1000), 5}, 8);
      placement.static_friction = 0.2;
      placement.rolling_friction = 10;  // so that it can't roll down
      placement.magnetic = true;
      Dry simulation(pressed, placement);
      simulation.set_body_forces({{0, 0, -weight / mass}, {-1000, 0, 0}});
      run(simulation, 500);
      const MicroparticleObservation seen = only_one(simulation);
      EXPECT_NEAR(8 - seen.position.z(), weight < 200 ? 0 : 0.5 * (weight - 200) / mass * 25, 0.02);
      EXPECT_NEAR(seen.friction_force.z(), std::min(weight, 200.0), 2);
      EXPECT_NEAR(seen.friction_force.x(), 0, 1e-9);
      EXPECT_EQ(seen.contact_fraction, 0);  // it leans, it does not stand
    }
}

TEST(SolidContact, TouchesAcrossAPeriodicSide) {
  Parameters parameters = box_with([](const Vector3d& p) { return p.y() < 1; });
  parameters.microparticles.contact_damping = 0.3;
  Dry simulation(parameters, slippery_at({5, 8.8, 5}));
  simulation.set_body_forces({{0, 0.2, 0}, Vector3d::Zero()});
  run(simulation, 2000);
  EXPECT_NEAR(only_one(simulation).position.y(), 9 + indentation(0.2 * mass), 1e-4);
}

TEST(SolidContact, GoesOnWithTheSameBitsAfterARestart) {
  const Parameters parameters = box_with([](const Vector3d& p) { return p.z() < 2 || p.x() < 2; });
  Dry simulation(parameters, sphere_at({3.02, 5}, 3.01));
  simulation.set_body_forces({{-0.3, 0.1, -0.5}, Vector3d::Zero()});
  run(simulation, 100);
  ASSERT_GT(only_one(simulation).normal_force, 0);
  Simulation restarted(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  restarted.load_state(simulation.save_state());
  run(simulation, 300);
  run(restarted, 300);
  EXPECT_EQ(*simulation.observe({false, true})->state_hash, *restarted.observe({false, true})->state_hash);
}

TEST(SolidContact, StopsTheRunWhenItsCentreGetsIntoTheSolid) {
  Parameters parameters = box_with_a_floor();
  parameters.microparticles.elastic_modulus = 1;
  Dry simulation(parameters, slippery_at({5, 5, 3}));
  simulation.set_body_forces({{0, 0, -1}, Vector3d::Zero()});
  try {
    run(simulation, 1000);
    FAIL() << "it sank without a word";
  } catch (const Instability& stopped) {
    EXPECT_TRUE(holds(stopped.what(), "microparticle 1 moves more than"));
    EXPECT_TRUE(holds(stopped.what(), "into the solid of the label grid"));
  }
}

}  // namespace
}  // namespace dmf::engine
