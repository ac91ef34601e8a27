// Microparticles in the engine: what holds in free flight, in liquid and on the wall.
#include <gtest/gtest.h>

#include <cmath>

#include "droplet_on_wall.h"
#include "engine/bodies/contact.h"
#include "engine/simulation.h"
#include "refusal.h"
#include "systems.h"

namespace dmf::engine {
namespace {

MicroparticleObservation only_one(const Simulation& simulation) {
  return simulation.observe()->microparticles.at(0);
}

void run(Simulation& simulation, int steps) {
  for (int k = 0; k < steps; ++k) simulation.step();
}

Simulation box(double size, std::uint64_t seed = 1, const std::string& kernel = "auto", int threads = 1) {
  Parameters parameters = periodic_box(size);
  parameters.seed = seed;
  return Simulation(parameters, ContactAngleCurve::lan2016(), {threads, kernel});
}

TEST(Microparticle, FallsFreelyAndKeepsItsSpinWithoutLiquid) {
  Simulation simulation = box(20);
  simulation.add_microparticle(sphere_at({10, 10}, 10.0));
  simulation.set_body_forces({{0, 0, -0.01}, {5, 0, 0}});
  run(simulation, 1000);
  const MicroparticleObservation fallen = only_one(simulation);
  // g t^2 / 2; the magnet pulls on magnetic ones only.
  EXPECT_NEAR(fallen.position.z(), 10 - 0.005 * 100, 1e-3);
  EXPECT_NEAR(fallen.position.x(), 10, 1e-12);
  EXPECT_NEAR(fallen.velocity.z(), -0.1, 1e-4);  // nothing pulls in the first half step
}

TEST(Microparticle, MagnetPullsMagneticOnesAndLetsGo) {
  Simulation simulation = box(20);
  MicroparticlePlacement magnetic = sphere_at({5, 5}, 10.0);
  magnetic.magnetic = true;
  simulation.add_microparticle(magnetic);
  simulation.add_microparticle(sphere_at({15, 15}, 10.0));
  simulation.set_body_forces({Vector3d::Zero(), {6.12, 0, 0}});
  run(simulation, 1000);
  simulation.set_body_forces({});
  run(simulation, 1000);
  const auto snapshot = simulation.observe();
  EXPECT_NEAR(snapshot->microparticles[0].velocity.x(), 0.1, 1e-9);  // the last half step outlasts it
  EXPECT_EQ(snapshot->microparticles[1].velocity.norm(), 0);
}

/// Momentum and angular momentum about `origin` of liquid and microparticles together.
std::pair<Vector3d, Vector3d> all_momentum(const Simulation& simulation, const Vector3d& origin) {
  ObserveRequest request;
  request.beads = true;
  const auto snapshot = simulation.observe(request);
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
  for (std::size_t i = 0; i < snapshot->positions.size(); ++i) {
    const Vector3d velocity = snapshot->velocities[i].cast<double>();
    linear += velocity;
    angular += (snapshot->positions[i].cast<double>() - origin).cross(velocity);
  }
  for (const MicroparticleObservation& one : snapshot->microparticles) {
    linear += one.mass * one.velocity;
    angular += one.mass * (one.position - origin).cross(one.velocity) +
               2.0 / 3.0 * one.mass * one.radius * one.radius * one.angular_velocity;
  }
  return {linear, angular};
}

TEST(Microparticle, ExchangesMomentumAndAngularMomentumWithAFreeDropletAndLosesNone) {
  Simulation simulation = box(16);
  simulation.add_droplet({{8, 8, 8}, 3.5});
  MicroparticlePlacement placement = sphere_at({8, 8}, 12.8);
  placement.attraction = -19.5;  // is swallowed
  simulation.add_microparticle(placement);
  const auto [linear, angular] = all_momentum(simulation, {8, 8, 8});
  run(simulation, 3000);
  const MicroparticleObservation swallowed = only_one(simulation);
  const auto [linear_after, angular_after] = all_momentum(simulation, {8, 8, 8});
  EXPECT_GT(swallowed.immersion, 0.9);
  EXPECT_GT(swallowed.velocity.norm() * swallowed.mass, 1.0);
  // Rounding: the liquid alone drifts by a few thousandths in this time.
  EXPECT_LT((linear_after - linear).norm(), 0.05);
  EXPECT_LT((angular_after - angular).norm(), 0.5);
}

TEST(Microparticle, HasTheTemperatureOfTheLiquidAroundIt) {
  // A light one, so that it forgets its velocity fast. In a droplet at rest of M beads a body of mass m has
  // m <v^2> = 3 k_BT M / (M + m), and I <w^2> = 3 k_BT.
  double translation = 0, rotation = 0;
  int looks = 0;
  for (const std::uint64_t seed : {1u, 2u}) {
    Simulation simulation = box(16, seed);
    simulation.add_droplet({{8, 8, 8}, 3.5});
    MicroparticlePlacement placement = sphere_at({8, 8}, 12.8);
    placement.attraction = -19.5;
    placement.mass = 60;
    simulation.add_microparticle(placement);
    run(simulation, 3000);
    const double beads = static_cast<double>(simulation.observe()->moving_beads);
    for (int look = 0; look < 250; ++look, ++looks) {
      run(simulation, 20);
      const MicroparticleObservation seen = only_one(simulation);
      translation += 60 * seen.velocity.squaredNorm() * (beads + 60) / beads;
      rotation += 40 * seen.angular_velocity.squaredNorm();
    }
  }
  // 500 looks, one in some ten of them new: 3 components give 8 % of spread.
  EXPECT_NEAR(translation / looks, 3, 0.6);
  EXPECT_NEAR(rotation / looks, 3, 0.6);
}

TEST(Microparticle, KeepsTheLiquidOutAtTheStrongestAttractionOfThePaper) {
  Simulation simulation = box(16);
  simulation.add_droplet({{8, 8, 8}, 3.5});
  MicroparticlePlacement placement = sphere_at({8, 8}, 12.8);
  placement.attraction = -19.5;
  placement.beads = 312;
  simulation.add_microparticle(placement);
  EXPECT_NO_THROW(run(simulation, 4000));  // a leak stops the run
  EXPECT_GT(only_one(simulation).immersion, 0.9);
}

TEST(Microparticle, StopsTheRunWhenLiquidGetsIn) {
  Parameters parameters = periodic_box(16);
  parameters.microparticles.liquid_repulsion = 0.05;
  Simulation simulation(parameters, ContactAngleCurve::lan2016());
  simulation.add_droplet({{8, 8, 8}, 3.5});
  MicroparticlePlacement placement = sphere_at({8, 8}, 12.8);
  placement.attraction = -19.5;
  placement.beads = 312;
  simulation.add_microparticle(placement);
  try {
    run(simulation, 10000);
    FAIL() << "nothing got in";
  } catch (const Instability& stopped) {
    EXPECT_TRUE(holds(stopped.what(), "microparticle 1"));
    EXPECT_TRUE(holds(stopped.what(), "liquid_repulsion (0.05)"));
  }
}

/// A dry plate.
Parameters dry_plate(ContactModel model) {
  Parameters parameters = plate(16, 14);
  parameters.microparticles.contact = model;
  return parameters;
}

TEST(Contact, SinksToWhereHertzBalancesTheAdhesionOfTheWall) {
  Simulation simulation(dry_plate(ContactModel::lan2016), ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_microparticle(sphere_at({8, 8}));
  run(simulation, 20000);
  const MicroparticleTotals totals = only_one(simulation).totals;
  const double load = wall_adhesion(-1, 1, 612 / (4 * M_PI), WallParameters{});
  const double indentation = std::pow(load / (4.0 / 3.0 * 1e6), 2.0 / 3.0);
  // Without liquid nothing damps it: it swings around that place, and the mean force is the load. The load is
  // an integral; the sum over beads above this place of the lattice is 3 % less.
  const double steps = static_cast<double>(totals.steps);
  EXPECT_NEAR(totals.normal_force / steps, load, 0.05 * load);
  EXPECT_NEAR(totals.height / steps, 1 - indentation, 0.15 * indentation);
  EXPECT_NEAR(load, 298, 1);
}

TEST(Contact, DampingBringsItToRestWhereHertzBalancesTheAdhesion) {
  Parameters parameters = dry_plate(ContactModel::lan2016);
  parameters.microparticles.contact_damping = 0.3;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_microparticle(sphere_at({8, 8}));
  run(simulation, 1000);
  const MicroparticleObservation rested = only_one(simulation);
  EXPECT_EQ(rested.contact_fraction, 1);
  EXPECT_LT(rested.velocity.norm(), 1e-6);
  EXPECT_NEAR(hertz_force(1e6, 1, 1 - rested.position.z()), rested.normal_force, 0.01);
}

TEST(Contact, StaysWhereItIsOnAPlateTiltedBelowTheFrictionAngleAndSlidesBeyond) {
  // Adhesion adds to the weight: it starts to slide at f_s (load + weight) = pull.
  for (const double pull : {50.0, 100.0}) {
    Simulation simulation(dry_plate(ContactModel::lan2016), ContactAngleCurve::lan2016(), {1, "auto"});
    MicroparticlePlacement placement = sphere_at({8, 8});
    placement.z = 1 - std::pow(298 / (4.0 / 3.0 * 1e6), 2.0 / 3.0);  // in balance from the start
    simulation.add_microparticle(placement);
    simulation.set_body_forces({{pull / 612, 0, 0}, Vector3d::Zero()});
    run(simulation, 1000);
    const double travelled = only_one(simulation).position.x() - 8;
    if (pull < 0.2 * 298)
      EXPECT_EQ(travelled, 0);
    else
      EXPECT_NEAR(travelled, 0.5 * (pull - 0.2 * 298) / 612 * 100, 0.3);
  }
}

TEST(Contact, RollsDownATiltedPlateWithThreeFifthsOfTheAcceleration) {
  Simulation simulation(dry_plate(ContactModel::coulomb), ContactAngleCurve::lan2016());
  MicroparticlePlacement placement = sphere_at({8, 8});
  placement.rolling_friction = 0;
  simulation.add_microparticle(placement);
  simulation.set_body_forces({{0.1, 0, 0}, Vector3d::Zero()});
  run(simulation, 500);
  const MicroparticleObservation rolled = only_one(simulation);
  EXPECT_NEAR(rolled.velocity.x(), 0.6 * 0.1 * 5, 0.01);
  EXPECT_NEAR(rolled.angular_velocity.y(), rolled.velocity.x(), 0.01);
}

TEST(Contact, APlateThatMovesTakesItAlong) {
  // Friction gives the impulse that ends the sliding: v = u / (1 + m R^2 / I), and turns it by the rest of u.
  // Without a torque it stops when it is as fast as the plate.
  for (const ContactModel model : {ContactModel::coulomb, ContactModel::lan2016}) {
    Parameters parameters = dry_plate(model);
    parameters.boundaries.lower_velocity = {0.3, -0.1};
    parameters.microparticles.wall_attraction = 0;  // the lattice would pull sideways
    Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
    MicroparticlePlacement placement = sphere_at({8, 8});
    placement.rolling_friction = 0;
    simulation.add_microparticle(placement);
    simulation.set_body_forces({{0, 0, -0.3}, Vector3d::Zero()});
    run(simulation, 3000);
    const MicroparticleObservation moved = only_one(simulation);
    const double share = model == ContactModel::coulomb ? 1 / (1 + 1.5) : 1;
    EXPECT_NEAR(moved.velocity.x(), 0.3 * share, 1e-3);
    EXPECT_NEAR(moved.velocity.y(), -0.1 * share, 1e-3);
    EXPECT_NEAR(moved.angular_velocity.y(), -0.3 * (1 - share), 1e-3);
  }
}

TEST(Contact, TwoMicroparticlesBounceAndKeepMomentumAndEnergy) {
  Simulation simulation = box(20);
  MicroparticlePlacement first = sphere_at({5, 10}, 10.0), second = sphere_at({9, 10.5}, 10.0);
  first.magnetic = true;
  second.radius = 1.5;
  simulation.add_microparticle(first);
  simulation.add_microparticle(second);
  simulation.set_body_forces({Vector3d::Zero(), {612, 0, 0}});
  run(simulation, 50);
  simulation.set_body_forces({});
  const auto state = [&] {
    const auto snapshot = simulation.observe();
    Vector3d momentum = Vector3d::Zero();
    double energy = 0;
    for (const auto& one : snapshot->microparticles) {
      momentum += one.mass * one.velocity;
      energy += 0.5 * one.mass * one.velocity.squaredNorm() +
                one.mass / 3 * one.radius * one.radius * one.angular_velocity.squaredNorm();
    }
    return std::make_pair(momentum, energy);
  };
  run(simulation, 1);  // the magnet's last half kick
  const auto [momentum, energy] = state();
  run(simulation, 700);
  const auto [momentum_after, energy_after] = state();
  EXPECT_GT(simulation.observe()->microparticles[1].velocity.norm(), 0.1);
  EXPECT_LT((momentum_after - momentum).norm(), 1e-9 * momentum.norm());
  EXPECT_NEAR(energy_after, energy, 0.02 * energy);
}

TEST(Contact, AdhesionHoldsTwoMicroparticlesTogether) {
  Parameters parameters = periodic_box(20);
  parameters.microparticles.particle_adhesion = 50;
  Simulation simulation(parameters, ContactAngleCurve::lan2016());
  MicroparticlePlacement first = sphere_at({8, 10}, 10.0);
  first.magnetic = true;
  simulation.add_microparticle(first);
  simulation.add_microparticle(sphere_at({10.001, 10}, 10.0));
  simulation.set_body_forces({Vector3d::Zero(), {-20, 0, 0}});
  run(simulation, 2000);
  const auto held = simulation.observe();
  EXPECT_LT((held->microparticles[1].position - held->microparticles[0].position).norm(), 2.1);
  EXPECT_LT(held->microparticles[1].position.x(), 9.5);  // drawn along
}

TEST(SmoothSphere, IsSwallowedAsAShellIsAndKeepsMomentum) {
  Simulation simulation = box(16);
  simulation.add_droplet({{8, 8, 8}, 3.5});
  MicroparticlePlacement placement = sphere_at({8, 8}, 12.8);
  placement.attraction = -19.5;
  placement.smooth = true;
  simulation.add_microparticle(placement);
  const Vector3d before = all_momentum(simulation, {8, 8, 8}).first;
  run(simulation, 4000);
  const MicroparticleObservation after = only_one(simulation);
  EXPECT_GT(after.immersion, 0.85);
  EXPECT_EQ(after.mass, 612);
  EXPECT_EQ(after.angular_velocity.norm(), 0);
  EXPECT_LT((all_momentum(simulation, {8, 8, 8}).first - before).norm(), 0.05);
}

TEST(SmoothSphere, RestsOnTheWallWithTheAdhesionOfAShell) {
  Simulation simulation(dry_plate(ContactModel::lan2016), ContactAngleCurve::lan2016(), {1, "auto"});
  MicroparticlePlacement placement = sphere_at({8, 8});
  placement.smooth = true;
  simulation.add_microparticle(placement);
  run(simulation, 20000);
  const MicroparticleTotals totals = only_one(simulation).totals;
  EXPECT_NEAR(totals.normal_force / static_cast<double>(totals.steps), 298, 0.05 * 298);
}

TEST(Body, OfPointsKeepsItsShapeAndTurnsInALiquid) {
  // A tripod of four beads.
  Simulation simulation = box(16);
  simulation.add_droplet({{8, 8, 8}, 3.0});
  MicroparticlePlacement placement;
  placement.points = {{0, 0, 0}, {1.4, 0, 0}, {0, 1.4, 0}, {0, 0, 1.4}};
  placement.radius = 0.5;
  placement.center = {8, 8};
  placement.z = 12.1;
  placement.attraction = -30;
  simulation.add_microparticle(placement);
  const Eigen::Quaterniond before = only_one(simulation).orientation;
  run(simulation, 4000);
  const MicroparticleObservation after = only_one(simulation);
  EXPECT_NEAR(after.orientation.norm(), 1, 1e-12);
  EXPECT_GT(after.orientation.angularDistance(before), 0.1);
  EXPECT_EQ(after.beads, 4u);
}

void start_wet_microparticle(Simulation& simulation) {
  simulation.set_wettability([](double x, double) { return 120.0 - 4.0 * std::abs(x - 8.0); });
  simulation.add_microparticle(sphere_at({0.2, 8}));  // over a periodic side
  simulation.add_droplet({{4.4, 8, 3}, 3.0});
}

TEST(Microparticle, LeavesTheSameBitsForEveryInstructionSetThreadsAndARestart) {
  Simulation first = droplet_on_wall(1);
  start_wet_microparticle(first);
  run(first, 137);
  const std::string saved = first.save_state();
  const std::uint64_t expected = hash_after(first, 263);
  EXPECT_GT(only_one(first).immersion, 0.1);
  std::vector<std::string> kernels = available_kernels();
  kernels.pop_back();  // the double reference
  for (const std::string& kernel : kernels) {
    Simulation second = droplet_on_wall(2, kernel);
    start_wet_microparticle(second);
    EXPECT_EQ(hash_after(second, 400), expected) << kernel;
    Simulation restarted = droplet_on_wall(3, kernel);
    restarted.load_state(saved);
    EXPECT_EQ(hash_after(restarted, 263), expected) << kernel << ", restarted";
  }
}

TEST(Microparticle, IsPickedUpAndDroppedWithAnEventEach) {
  Simulation simulation(plate(20, 12), ContactAngleCurve::lan2016(), {1, "auto"});
  MicroparticlePlacement placement = sphere_at({6, 10});
  placement.magnetic = true;
  const std::uint32_t id = simulation.add_microparticle(placement);
  simulation.add_droplet({{11, 10, 3}, 3.4});
  simulation.set_wettability([](double, double) { return 60.0; });
  run(simulation, 1500);
  auto events = simulation.take_microparticle_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, MicroparticleEvent::Kind::picked_up);
  EXPECT_EQ(events[0].microparticle, id);
  EXPECT_EQ(events[0].droplet, only_one(simulation).droplet);
  EXPECT_NE(only_one(simulation).place, MicroparticlePlace::dry);
  // A magnet tears it out again.
  simulation.set_body_forces({Vector3d::Zero(), {-150, 0, 400}});
  run(simulation, 2000);
  events = simulation.take_microparticle_events();
  ASSERT_GE(events.size(), 1u);
  EXPECT_EQ(events[0].kind, MicroparticleEvent::Kind::dropped_off);
}

/// A small droplet set on a microparticle on the wall, after 40 tau.
double height_in_a_droplet(double attraction, double& immersion) {
  Simulation simulation(plate(20, 12), ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.set_wettability([](double, double) { return 100.0; });
  MicroparticlePlacement placement = sphere_at({10, 10});
  placement.attraction = attraction;
  simulation.add_microparticle(placement);
  simulation.add_droplet({{10.5, 10, 5.95}, 3.4});
  run(simulation, 4000);
  immersion = only_one(simulation).immersion;
  return only_one(simulation).position.z();
}

TEST(Wetting, HydrophobicMicroparticlesStayOnTheWallAndHydrophilicOnesLiftOff) {
  // Lan 4.1.2: in contact for A_ls -15 to -17, swallowed for -18 to -19.5.
  double immersion = 0;
  EXPECT_NEAR(height_in_a_droplet(-15, immersion), 1, 0.03);
  EXPECT_GT(immersion, 0.3);
  EXPECT_GT(height_in_a_droplet(-20, immersion), 1.3);
  EXPECT_GT(immersion, 0.9);
}

TEST(BadMicroparticle, IsRefusedWithWhatWouldWorkAndChangesNothing) {
  Simulation simulation = droplet_on_wall(1);
  start_droplet(simulation);
  const std::string before = simulation.save_state();
  const auto refused = [&](auto change) {
    MicroparticlePlacement placement = sphere_at({2, 2});
    change(placement);
    return refusal([&] { simulation.add_microparticle(placement); });
  };
  EXPECT_TRUE(holds(refused([](auto& p) { p.radius = 0.1; }), "radius: 0.1, allowed: 0.5 to 20"));
  EXPECT_TRUE(holds(refused([](auto& p) { p.beads = 600; }), "the nearest is 612"));
  EXPECT_TRUE(holds(refused([](auto& p) { p.radius = 2, p.beads = 312; }), "allowed: 1248 or more"));
  EXPECT_TRUE(holds(refused([](auto& p) { p.mass = 0; }), "mass: 0, allowed: above 0"));
  EXPECT_TRUE(holds(refused([](auto& p) { p.mass = 1; }), "elastic_modulus 1e+06, allowed: up to"));
  EXPECT_TRUE(holds(refused([](auto& p) { p.mass = 1; }), "or time_step up to"));
  EXPECT_TRUE(holds(refused([](auto& p) { p.static_friction = -1; }), "static_friction: -1"));
  EXPECT_TRUE(
      holds(refused([](auto& p) { p.kinetic_friction = 0.5; }), "allowed: 0 to static_friction (0.2)"));
  EXPECT_TRUE(holds(refused([](auto& p) { p.attraction = 3; }), "attraction is negative"));
  EXPECT_TRUE(holds(refused([](auto& p) { p.center.x() = NAN; }), "finite"));
  EXPECT_TRUE(holds(refused([](auto& p) { p.z = 0.5; }), "center's z 0.5, allowed: 1 to 13"));
  EXPECT_TRUE(holds(refused([](auto& p) { p.center = {8, 8}; }), "from its surface to the liquid"));
  EXPECT_TRUE(holds(refused([](auto& p) { p.radius = -1, p.mass = -1; }), "mass: -1"));
  EXPECT_EQ(simulation.save_state(), before);

  simulation.add_microparticle(sphere_at({2, 2}));
  EXPECT_TRUE(
      holds(refused([](auto& p) { p.center.x() = 3.5; }), "1.5 r_c from microparticle 1, allowed: 2"));
  EXPECT_TRUE(holds(refusal([&] { simulation.add_droplet({{2.5, 2, 3}, 1.5}); }), "microparticle at (2, 2"));
  EXPECT_TRUE(holds(refusal([&] { simulation.remove_microparticle(7); }), "microparticles are [1]"));
  EXPECT_TRUE(holds(refusal([&] { simulation.set_body_forces({{0, 0, 1e3}, {}}); }), "body_forces.gravity"));
  simulation.remove_microparticle(1);
  EXPECT_TRUE(simulation.observe()->microparticles.empty());
}

TEST(BadMicroparticle, NeedsTheIntegratorThatKnowsIt) {
  Parameters parameters = plate(16, 14);
  parameters.integrator = Integrator::baoab;
  Simulation simulation(parameters, ContactAngleCurve::lan2016());
  EXPECT_TRUE(holds(refusal([&] {
                      simulation.add_microparticle(sphere_at({8, 8}));
                    }),
                    "integrator: baoab, allowed: groot_warren"));
}

}  // namespace
}  // namespace dmf::engine
