// Closed sides: what each kind of reflection does to beads, and walls that move.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/integrate.h"
#include "engine/simulation.h"
#include "refusal.h"
#include "systems.h"

namespace dmf::engine {
namespace {

constexpr Reflection every_reflection[] = {
    Reflection::bounce_back, Reflection::bounce_forward, Reflection::specular,        Reflection::maxwellian,
    Reflection::thin_layer,  Reflection::symmetric,      Reflection::frozen_particles};

Parameters closed_box(double size, Reflection reflection) {
  Parameters parameters = periodic_box(size);
  parameters.domain.lower_side =
      parameters.domain.upper_side = {Side::reflecting, Side::reflecting, Side::reflecting};
  parameters.boundaries.lower_reflection = {reflection, reflection, reflection};
  parameters.boundaries.upper_reflection = {reflection, reflection, reflection};
  return parameters;
}

/// Closed in z, periodic along x and y.
Parameters slit(double size, double height, Reflection reflection) {
  Parameters parameters = closed_box(size, Reflection::bounce_back);
  parameters.domain.upper.z() = height;
  for (int axis = 0; axis < 2; ++axis)
    parameters.domain.lower_side[axis] = parameters.domain.upper_side[axis] = Side::periodic;
  parameters.boundaries.lower_reflection[2] = parameters.boundaries.upper_reflection[2] = reflection;
  return parameters;
}

void use_plain_dpd(Parameters& parameters) {
  parameters.liquid.attraction = 18.75;
  parameters.liquid.repulsion = 0;
  parameters.liquid.random_amplitude = 3;
  parameters.liquid.initial_density = parameters.liquid.bulk_density = 4;
  parameters.watchdog.evaporation = 1;
}

struct Bead {
  Vector3d at, velocity, seen;
};

/// Where a bead without forces is after one drift of 0.1 tau.
Bead after_a_drift(Parameters parameters, const Vector3d& at, const Vector3d& velocity) {
  parameters.time_step = 0.1;
  System system{"one", parameters, {}};
  add_bead(system, at);
  const Eigen::Vector3f v = velocity.cast<float>();
  system.beads.velocity[0] = {v.x(), v.y(), v.z(), 0};
  drift(system.beads, parameters, 0);
  const Record &p = system.beads.position[0], &u = system.beads.velocity[0], &w = system.beads.predicted[0];
  return {{p.x, p.y, p.z}, {u.x, u.y, u.z}, {w.x, w.y, w.z}};
}

void expect_near(const Vector3d& value, const Vector3d& expected) {
  EXPECT_LT((value - expected).norm(), 1e-5) << value.transpose() << " against " << expected.transpose();
}

// 0.05 above the side, falling 0.1 and gliding 0.2 in the step: it meets the side half-way.
const Vector3d start(5, 5, 0.05), falling(2, 0, -1);

TEST(Specular, TurnsTheNormalComponentRoundAndLeavesTheOthers) {
  const Bead bead = after_a_drift(slit(10, 10, Reflection::specular), start, falling);
  expect_near(bead.at, {5.2, 5, 0.05});
  expect_near(bead.velocity, {2, 0, 1});
  expect_near(bead.seen, {2, 0, 1});
}

TEST(BounceForward, GoesOnAlongTheSideWithTheVelocityOfABounceBack) {
  const Bead bead = after_a_drift(slit(10, 10, Reflection::bounce_forward), start, falling);
  expect_near(bead.at, {5.2, 5, 0.05});
  expect_near(bead.velocity, {-2, 0, 1});
  expect_near(bead.seen, {-2, 0, 1});
}

TEST(BounceBack, FromAMovingSideIsThatOfASideAtRestInItsFrame) {
  const Vector3d along(3, -1, 0);
  for (const Reflection reflection : {Reflection::bounce_back, Reflection::bounce_forward}) {
    Parameters parameters = slit(10, 10, reflection);
    const Bead at_rest = after_a_drift(parameters, start, falling);
    parameters.boundaries.lower_velocity = along.head<2>();
    const Bead moving = after_a_drift(parameters, start, falling + along);
    expect_near(moving.velocity, at_rest.velocity + along);
    expect_near(moving.seen, at_rest.seen + along);
    expect_near(moving.at, at_rest.at + along * 0.1);
  }
}

TEST(Reflection, InACornerMeetsOneSideAfterTheOther) {
  // Along x the side is met after 0.05 of 0.3, along z after 0.05 of 0.1.
  const Bead bead = after_a_drift(closed_box(10, Reflection::specular), {0.05, 5, 0.05}, {-3, 0, -1});
  expect_near(bead.at, {0.25, 5, 0.05});
  expect_near(bead.velocity, {3, 0, 1});
}

TEST(Reflection, LetsNoBeadThroughInAHundredThousandCollisions) {
  for (const Reflection reflection : every_reflection) {
    Parameters parameters = closed_box(6, reflection);
    parameters.time_step = 0.05;
    parameters.boundaries.lower_velocity = {1, 0};
    System system{"hot gas", parameters, {}};
    scatter_beads(system, 3, {0, 0, 0}, {6, 6, 6}, [](const Vector3d&) { return true; });
    parameters.liquid.temperature = 9;  // of sides that emit
    for (Record& v : system.beads.velocity) v.x *= 3, v.y *= 3, v.z *= 3;
    std::size_t collisions = 0;
    for (std::uint64_t step = 0; collisions < 100'000; ++step) {
      ASSERT_LT(step, 10'000u);
      const AlignedVector<Record> before = system.beads.velocity;
      drift(system.beads, parameters, step);
      finish(system.beads, parameters);
      for (std::size_t i = 0; i < before.size(); ++i) {
        const Record &p = system.beads.position[i], &v = system.beads.velocity[i];
        collisions += v.x != before[i].x || v.y != before[i].y || v.z != before[i].z;
        ASSERT_TRUE(parameters.domain.contains(Vector3d(p.x, p.y, p.z)));
      }
    }
  }
}

TEST(Maxwellian, MakesAFreeMolecularGasMaxwellianAtTheSidesTemperature) {
  // Velocities are uniform between -1.7 and 1.7 at first: <v^2> = 0.96, <v^4> = 1.67. Beads do not meet.
  Parameters parameters = slit(12, 4, Reflection::maxwellian);
  parameters.time_step = 0.05;
  parameters.liquid.temperature = 2;
  System system{"gas", parameters, {}};
  scatter_beads(system, 6, {0, 0, 0}, {12, 12, 4}, [](const Vector3d&) { return true; });
  Vector3d second = Vector3d::Zero(), fourth = Vector3d::Zero();
  double lower_half = 0, looks = 0;
  for (std::uint64_t step = 0; step < 6000; ++step) {
    drift(system.beads, parameters, step);
    finish(system.beads, parameters);
    if (step < 2000 || step % 20 != 0) continue;
    for (std::size_t i = 0; i < system.beads.size(); ++i) {
      const Record& v = system.beads.velocity[i];
      const Eigen::Array3d squared = Eigen::Array3d(v.x, v.y, v.z).square();
      second += squared.matrix();
      fourth += squared.square().matrix();
      lower_half += system.beads.position[i].z < 2;
      ++looks;
    }
  }
  // 3456 beads, each emitted some 70 times: 0.4 % of the second moments, 1 % of the fourth ones.
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(second[axis] / looks, 2, 0.03) << axis;
    EXPECT_NEAR(fourth[axis] / looks, 12, 0.4) << axis;
  }
  EXPECT_NEAR(lower_half / looks, 0.5, 0.005);
}

/// Mean of v_x in ten slabs from side to side, temperature and density in them.
struct Profile {
  std::array<double, 10> velocity{}, temperature{}, density{};
};

Profile profile_of(Simulation& simulation, double settle, double measure) {
  const Parameters& parameters = simulation.parameters();
  const Vector3d size = parameters.domain.size();
  const auto run = [&](double time) {
    for (int k = 0; k < static_cast<int>(std::lround(time / parameters.time_step)); ++k) simulation.step();
  };
  run(settle);
  Profile profile;
  std::array<double, 10> beads{}, squares{}, across{};
  const int looks = static_cast<int>(measure / 0.2);
  for (int look = 0; look < looks; ++look) {
    run(0.2);
    const auto snapshot = simulation.observe({true});
    for (std::size_t k = 0; k < snapshot->positions.size(); ++k) {
      const int slab = std::clamp(
          static_cast<int>(10 * (snapshot->positions[k].z() - parameters.domain.lower.z()) / size.z()), 0, 9);
      const Eigen::Vector3f& v = snapshot->velocities[k];
      beads[slab] += 1;
      profile.velocity[slab] += v.x();
      squares[slab] += v.x() * v.x();
      across[slab] += v.y() * v.y() + v.z() * v.z();
    }
  }
  for (int slab = 0; slab < 10; ++slab) {
    profile.velocity[slab] /= beads[slab];
    profile.temperature[slab] =
        (squares[slab] / beads[slab] - std::pow(profile.velocity[slab], 2) + across[slab] / beads[slab]) / 3;
    profile.density[slab] = beads[slab] / looks / (size.prod() / 10);
  }
  return profile;
}

TEST(Specular, LeavesTheTangentialMomentumOfALiquidAlone) {
  for (const auto& [reflection, keeps] :
       {std::pair{Reflection::specular, true}, {Reflection::bounce_back, false}}) {
    Parameters parameters = slit(5, 5, reflection);
    use_plain_dpd(parameters);
    Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
    simulation.fill_box();
    const double beads = static_cast<double>(simulation.observe()->moving_beads);
    simulation.set_body_forces({{1, 0, 0}, Vector3d::Zero()});
    for (int k = 0; k < 300; ++k) simulation.step();
    simulation.set_body_forces({});
    simulation.step();  // half a kick of the last forces was left
    const double pushed = simulation.observe()->momentum.x() / beads;
    if (keeps) {
      EXPECT_NEAR(pushed, 3, 1e-3);
    }
    for (int k = 0; k < 400; ++k) simulation.step();
    const double left = simulation.observe()->momentum.x() / beads;
    if (keeps)
      EXPECT_NEAR(left, pushed, 1e-3);
    else
      EXPECT_LT(left, 0.9 * pushed);
    // What moves at three times its thermal velocity is not hot, what the sides have slowed is.
    if (keeps) {
      EXPECT_NEAR(simulation.observe()->temperature, 1, 0.2);
    }
  }
}

/// Plain DPD between z sides 8 apart that move by -1 and 1 along x, dragged for 40 tau.
Profile between_moving_sides(Reflection reflection, bool wall_beads, double measure) {
  Parameters parameters = two_plates(6, 8);
  if (!wall_beads) parameters.domain.lower_side[2] = parameters.domain.upper_side[2] = Side::reflecting;
  use_plain_dpd(parameters);
  parameters.time_step = 0.02;
  parameters.wall.lattice_constant = 1;
  parameters.wall.attraction = 9.68;
  parameters.boundaries.lower_reflection[2] = parameters.boundaries.upper_reflection[2] = reflection;
  parameters.boundaries.lower_velocity = {-1, 0};
  parameters.boundaries.upper_velocity = {1, 0};
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill_box();
  return profile_of(simulation, 40, measure);
}

/// What the liquid lacks of the sides' velocity at them, by a line through the six slabs in the middle.
double slip_of(const Profile& profile) {
  double product = 0, squares = 0;
  for (int slab = 2; slab < 8; ++slab) {
    const double z = -3.6 + 0.8 * slab;
    product += z * profile.velocity[slab];
    squares += z * z;
  }
  return 1 - 4 * product / squares;
}

/// How much a wall may slip, of its velocity. Between it and the first collisions lies a mean free path of
/// thermal velocity over friction, 1 / (gamma rho [w_D] / 3) = 0.4 r_c: what leaves a diffuse wall knows
/// nothing of the liquid, so that by Maxwell's argument the profile goes on for about that length behind it,
/// 0.4 / 4.4 = 0.09 here, and up to half as much again by kinetic theory of gases. What bounces back takes
/// twice the momentum, and slips less.
class WallOfBeads : public ::testing::TestWithParam<std::pair<Reflection, double>> {};

TEST_P(WallOfBeads, DragsALinearProfileAndHasItsDensityAndTemperature) {
  const auto [reflection, most_slip] = GetParam();
  const Profile profile = between_moving_sides(reflection, true, 80);
  const double slip = slip_of(profile);  // good to 0.02
  EXPECT_GT(slip, -0.04);
  EXPECT_LT(slip, most_slip + 0.04);
  RecordProperty("slip", std::to_string(slip));
  for (int slab = 0; slab < 10; ++slab) {
    const double z = -3.6 + 0.8 * slab;
    EXPECT_NEAR(profile.velocity[slab], (1 - slip) * z / 4, 0.1) << z;
    EXPECT_NEAR(profile.temperature[slab], 1, 0.06) << z;
    EXPECT_NEAR(profile.density[slab], 4, 0.3) << z;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryReflectionWithFriction, WallOfBeads,
                         ::testing::Values(std::pair{Reflection::bounce_back, 0.06},
                                           std::pair{Reflection::bounce_forward, 0.06},
                                           std::pair{Reflection::maxwellian, 0.13},
                                           std::pair{Reflection::thin_layer, 0.13}));

TEST(Specular, SideWithoutBeadsDragsNothing) {
  const Profile profile = between_moving_sides(Reflection::specular, false, 20);
  EXPECT_NEAR(slip_of(profile), 1, 0.1);
  for (int slab = 0; slab < 10; ++slab) EXPECT_NEAR(profile.temperature[slab], 1, 0.08) << slab;
}

TEST(Wall, TakesAnAttractionInPlaceOfContactAngles) {
  Parameters parameters = two_plates(6, 6);
  use_plain_dpd(parameters);
  parameters.wall.attraction = 9.68;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  EXPECT_TRUE(holds(refusal([&] { simulation.set_wettability([](double, double) { return 90.0; }); }),
                    "attraction is given (9.68)"));
}

TEST(Boundaries, AreTheSameBitsWhateverTheThreadsAndAfterARestart) {
  for (const Integrator integrator : {Integrator::groot_warren, Integrator::baoab}) {
    Parameters parameters = slit(6, 6, Reflection::maxwellian);
    use_plain_dpd(parameters);
    parameters.integrator = integrator;
    parameters.boundaries.upper_reflection[2] = Reflection::thin_layer;
    parameters.boundaries.upper_velocity = {0.5, 0.25};
    const auto hash_after = [](Simulation& simulation, int steps) {
      for (int k = 0; k < steps; ++k) simulation.step();
      return *simulation.observe({false, true})->state_hash;
    };
    Simulation first(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
    first.fill_box();
    hash_after(first, 30);
    const std::string saved = first.save_state();
    const std::uint64_t expected = hash_after(first, 30);
    Simulation second(parameters, ContactAngleCurve::lan2016(), {2, "auto"});
    second.load_state(saved);
    EXPECT_EQ(hash_after(second, 30), expected);
  }
}

TEST(Boundaries, WhatDoesNotGoTogetherIsRefused) {
  const auto refused = [](auto change) {
    Parameters parameters = two_plates(10, 6);
    change(parameters);
    return refusal([&] { Simulation(parameters, ContactAngleCurve::lan2016()); });
  };
  EXPECT_TRUE(holds(refused([](Parameters& p) {
                      p.boundaries.lower_velocity = {20, 0};
                    }),
                    "boundaries.lower_velocity: (20, 0), allowed: up to 10 r_c / tau"));
  EXPECT_TRUE(holds(refused([](Parameters& p) {
                      p.boundaries.upper_velocity = {NAN, 0};
                    }),
                    "boundaries.upper_velocity: (nan, 0), allowed"));
  EXPECT_TRUE(holds(refused([](Parameters& p) { p.boundaries.upper_reflection[0] = Reflection::specular; }),
                    "boundaries.upper_x: a reflection on a periodic side"));
  EXPECT_TRUE(holds(refused([](Parameters& p) { p.boundaries.lower_reflection[2] = Reflection::symmetric; }),
                    "boundaries.lower_z: symmetric on a wall"));
  EXPECT_TRUE(holds(refused([](Parameters& p) { p.boundaries.layer_thickness = 0; }),
                    "boundaries.layer_thickness: 0, allowed"));
  EXPECT_TRUE(holds(refused([](Parameters& p) { p.boundaries.shear_rate = 0.1; }),
                    "boundaries.shear_rate: 0.1, allowed: 0 unless domain.sides x and z are periodic"));
  EXPECT_TRUE(
      holds(refused([](Parameters& p) { p.wall.attraction = 300; }), "wall.attraction: 300, allowed"));
  EXPECT_TRUE(holds(refused([](Parameters& p) { p.dimensions = 2; }), "dimensions: 2 with periodic y sides"));
  EXPECT_TRUE(holds(refused([](Parameters& p) { p.dimensions = 4; }), "dimensions: 4, allowed: 2 or 3"));
}

}  // namespace
}  // namespace dmf::engine
