// Sides of instantaneous frozen particles: what slips along them is set by one number.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/simulation.h"
#include "refusal.h"
#include "systems.h"

namespace dmf::engine {
namespace {

/// Plain DPD, closed in z by frozen particles.
Parameters slit(double size, double height, double lateral_friction) {
  Parameters parameters = periodic_box(size);
  parameters.domain.upper.z() = height;
  parameters.domain.lower_side[2] = parameters.domain.upper_side[2] = Side::reflecting;
  parameters.boundaries.lower_reflection[2] = parameters.boundaries.upper_reflection[2] =
      Reflection::frozen_particles;
  parameters.boundaries.frozen_particles.lateral_friction = lateral_friction;
  parameters.liquid.attraction = 18.75;
  parameters.liquid.repulsion = 0;
  parameters.liquid.random_amplitude = 3;
  parameters.liquid.initial_density = parameters.liquid.bulk_density = 4;
  parameters.watchdog.evaporation = 1;
  return parameters;
}

Vector3d vector_of(const Record& record) { return {record.x, record.y, record.z}; }

/// Part of the force on every bead, by id.
std::vector<Vector3d> forces_of(System& system, PairForce part) {
  const Walls wall = wall_of(system);
  Microparticles none(system.parameters);
  Pairs pairs(system.parameters);
  Forces forces(system.parameters, "auto");
  pairs.rebuild(system.beads, wall);
  forces.density(system.beads, wall, none, pairs);
  AlignedVector<Record> sums;
  forces.force(part, sums, system.beads, wall, none, pairs);
  std::vector<Vector3d> by_id(system.beads.size());
  for (std::size_t i = 0; i < by_id.size(); ++i) by_id[system.beads.id[i]] = vector_of(sums[i]);
  return by_id;
}

TEST(FrozenParticles, PushAndRubAsABeadAtTheFootOfThePerpendicular) {
  System system{"three", slit(6, 6, 7), {}};
  system.parameters.boundaries.frozen_particles.attraction = 12;
  system.parameters.boundaries.upper_velocity = {0.5, -0.25};
  const double heights[] = {0.3, 3, 5.6};  // near the lower side, in the middle, near the upper side
  for (const double z : heights) add_bead(system, {3, 3, z});
  const std::vector<Vector3d> push = forces_of(system, PairForce::conservative),
                              drag = forces_of(system, PairForce::friction);
  std::vector<Vector3d> velocity(3);
  for (std::size_t i = 0; i < 3; ++i) velocity[system.beads.id[i]] = vector_of(system.beads.predicted[i]);
  EXPECT_LT((push[0] - Vector3d(0, 0, 12 * 0.7)).norm(), 1e-5);
  EXPECT_EQ(push[1].norm(), 0);
  EXPECT_LT((push[2] - Vector3d(0, 0, -12 * 0.6)).norm(), 1e-5);
  // gamma 4.5 of the liquid along the normal, 7 along the side; w_D = (1 - h)^2.
  EXPECT_LT((drag[0] + 0.49 * velocity[0].cwiseProduct(Vector3d(7, 7, 4.5))).norm(), 1e-5);
  EXPECT_EQ(drag[1].norm(), 0);
  const Vector3d past = velocity[2] - Vector3d(0.5, -0.25, 0);
  EXPECT_LT((drag[2] + 0.36 * past.cwiseProduct(Vector3d(7, 7, 4.5))).norm(), 1e-5);
}

TEST(FrozenParticles, HaveTheManyBodyRepulsionOfALiquidThatHasOne) {
  System system{"cluster", slit(6, 6, 0), {}};
  system.parameters.liquid.attraction = -40;
  system.parameters.liquid.repulsion = 25;
  system.parameters.boundaries.frozen_particles.attraction = -20;
  add_bead(system, {3, 3, 0.2});
  add_bead(system, {3, 3.5, 0.2});
  const std::vector<Vector3d> push = forces_of(system, PairForce::conservative);
  const double density = 15 / (2 * M_PI * std::pow(0.75, 3)) * std::pow(1 - 0.5 / 0.75, 2);
  const double expected = -20 * 0.8 + 25 * density * (1 - 0.2 / 0.75);
  EXPECT_NEAR(push[0].z(), expected, 1e-3);
  EXPECT_NEAR(push[1].z(), expected, 1e-3);
}

TEST(FrozenParticles, HaveNoiseAndFrictionOfEveryComponentInBalance) {
  // Fluctuation and dissipation: of a force -gamma w_D v the variance of the noise is 2 gamma w_D k_BT / dt.
  // Beads too far apart to feel each other.
  System system{"gas", slit(60, 8, 6), {}};
  system.parameters.liquid.temperature = 2;
  system.parameters.time_step = 0.01;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) add_bead(system, {3.0 * i, 3.0 * j, 0.1});
  const auto friction = [&] { return forces_of(system, PairForce::friction); };
  Vector3d drag = Vector3d::Zero(), square = Vector3d::Zero();
  for (int key = 0; key < 25; ++key) {
    for (std::size_t i = 0; i < system.beads.size(); ++i) {
      const std::uint32_t bits = bead_key(step_key(9, key, Stream::pair), system.beads.id[i]);
      std::memcpy(&system.beads.position[i].w, &bits, sizeof bits);
      system.beads.predicted[i] = {1, 1, 1, 0};
    }
    for (const Vector3d& noise : forces_of(system, PairForce::random)) square += noise.cwiseAbs2() / 1e4;
    if (key == 0)
      for (const Vector3d& force : friction()) drag += force / 400;
  }
  // phi^2 / dt = 2 gamma k_BT / dt, of 10^4 uniform numbers: <z^4> - 1 = 0.8, so 0.9 % of each.
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(square[axis] * 0.01 / (-2 * drag[axis] * 2), 1, 0.03) << axis;
}

TEST(FrozenParticles, NoiseOfAComponentKnowsNothingOfAnothersNorOfTheOtherSides) {
  System system{"gas", slit(60, 4, 4.5), {}};
  system.parameters.domain.upper.z() = 4;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) add_bead(system, {3.0 * i, 3.0 * j, 0.1});
  std::vector<std::array<double, 6>> samples;
  for (int key = 0; key < 25; ++key) {
    std::vector<Vector3d> noise[2];
    for (const bool above : {false, true}) {
      for (std::size_t i = 0; i < system.beads.size(); ++i) {
        const std::uint32_t bits = bead_key(step_key(9, key, Stream::pair), system.beads.id[i]);
        std::memcpy(&system.beads.position[i].w, &bits, sizeof bits);
        system.beads.position[i].z = above ? 3.9f : 0.1f;
      }
      noise[above] = forces_of(system, PairForce::random);
    }
    for (std::size_t i = 0; i < noise[0].size(); ++i)
      samples.push_back({noise[0][i].x(), noise[0][i].y(), noise[0][i].z(), noise[1][i].x(), noise[1][i].y(),
                         noise[1][i].z()});
  }
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b < a; ++b) {
      double product = 0, first = 0, second = 0;
      for (const auto& sample : samples) {
        product += sample[a] * sample[b];
        first += sample[a] * sample[a];
        second += sample[b] * sample[b];
      }
      EXPECT_LT(std::abs(product / std::sqrt(first * second)), 0.045) << a << " " << b;  // 0.01 a pair
    }
}

constexpr int rows = 10;  ///< of equal height within range of a side

struct Sheared {
  double slip;  ///< what the liquid lacks of the sides' velocity at them, from its slope in the middle
  std::array<double, 6> temperature{}, density{};
  std::array<double, rows> near_sides{};  ///< density in the rows
};

/// Between sides 6 apart that move by -2 and 2.
Sheared shear(double lateral_friction) {
  Parameters parameters = slit(6, 6, lateral_friction);
  parameters.time_step = 0.02;
  parameters.boundaries.lower_velocity = {-2, 0};
  parameters.boundaries.upper_velocity = {2, 0};
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill_box();
  for (int k = 0; k < 1000; ++k) simulation.step();
  std::array<double, 6> beads{}, across{};
  Sheared result{};
  double product = 0, places = 0;
  const int looks = 300;
  for (int look = 0; look < looks; ++look) {
    for (int k = 0; k < 10; ++k) simulation.step();
    const auto snapshot = simulation.observe({true});
    for (std::size_t i = 0; i < snapshot->positions.size(); ++i) {
      const double z = snapshot->positions[i].z(), height = std::min(z, 6 - z);
      EXPECT_GE(height, 0);
      const Eigen::Vector3f& v = snapshot->velocities[i];
      if (height > 1) product += (z - 3) * v.x(), places += (z - 3) * (z - 3);
      if (height < 1) result.near_sides[static_cast<int>(rows * height)] += rows / (2 * 36.0 * looks);
      const int slab = std::clamp(static_cast<int>(z), 0, 5);
      beads[slab] += 1;
      across[slab] += (v.y() * v.y() + v.z() * v.z()) / 2;
    }
  }
  result.slip = 1 - 3 * product / places / 2;
  for (int slab = 0; slab < 6; ++slab) {
    result.temperature[slab] = across[slab] / beads[slab];
    result.density[slab] = beads[slab] / looks / 36;
  }
  return result;
}

/// The same by Stokes' equation between sides 2 half apart, eta u'' = rho gamma_l (1 - h)^2 (u - u_side),
/// without stress at the sides themselves.
double slip_by_stokes(double half, double viscosity, double lateral_friction,
                      const std::array<double, rows>& density) {
  const int steps = 20000;
  const double dz = half / steps;
  // From the middle, where u = 0, outwards. Linear in its slope there and in the side's velocity.
  const auto slope_at_side = [&](double slope, double side) {
    double u = 0;
    for (int k = 0; k < steps; ++k) {
      const double h = half - (k + 0.5) * dz;
      if (h < 1)
        slope += dz * density[static_cast<int>(rows * h)] * lateral_friction * (1 - h) * (1 - h) *
                 (u + 0.5 * dz * slope - side) / viscosity;
      u += dz * slope;
    }
    return slope;
  };
  return 1 + half * slope_at_side(0, 1) / slope_at_side(1, 0);
}

TEST(FrozenParticles, SlipFallsWithTheLateralFrictionAsStokesSays) {
  double before = 1;
  for (const double friction : {0.0, 0.3, 6.0}) {
    const Sheared found = shear(friction);
    // 1.08: what `dmf_study poiseuille` and the sheared box of test_ghosts.cpp find of this liquid. Stokes
    // knows nothing of the mean free path, thermal velocity over friction or 0.4 r_c, over which beads carry
    // what they got from the side: up to half of that, as a slip length.
    const double expected = slip_by_stokes(3, 1.08, friction, found.near_sides);
    EXPECT_NEAR(found.slip, expected, 0.06) << friction;
    if (friction > 0) {
      EXPECT_LT(found.slip, before - 0.2) << friction;
    }
    before = found.slip;
    for (int slab = 0; slab < 6; ++slab) {
      // The bands of the other sides in test_boundaries.cpp.
      EXPECT_NEAR(found.temperature[slab], 1, 0.06) << friction << ", slab " << slab;
      EXPECT_NEAR(found.density[slab], 4, 0.3) << friction << ", slab " << slab;
    }
  }
}

TEST(FrozenParticles, AreTheSameBitsWhateverTheThreadsAndAfterARestart) {
  for (const Integrator integrator : {Integrator::groot_warren, Integrator::baoab}) {
    Parameters parameters = slit(6, 6, 2);
    parameters.integrator = integrator;
    parameters.boundaries.upper_velocity = {0.5, 0};
    parameters.mixture.liquids = {{"other", {18.75, 0, 3}, 4, 4}};
    parameters.mixture.pairs = {{"liquid", "other", {56.25, 0, 3}}};
    const auto hash_after = [](Simulation& simulation, int steps) {
      for (int k = 0; k < steps; ++k) simulation.step();
      return *simulation.observe({false, true})->state_hash;
    };
    Simulation first(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
    first.fill({{0, 0, 0}, {3, 6, 6}, 0});
    first.fill({{3, 0, 0}, {6, 6, 6}, 1});
    hash_after(first, 30);
    const std::string saved = first.save_state();
    const std::uint64_t expected = hash_after(first, 30);
    Simulation second(parameters, ContactAngleCurve::lan2016(), {2, "auto"});
    second.load_state(saved);
    EXPECT_EQ(hash_after(second, 30), expected);
  }
}

TEST(FrozenParticles, OutOfRangeOrOnAWallOfBeadsAreRefused) {
  const auto refused = [](auto change) {
    Parameters parameters = slit(6, 6, 1);
    change(parameters);
    return refusal([&] { Simulation(parameters, ContactAngleCurve::lan2016()); });
  };
  EXPECT_TRUE(holds(refused([](Parameters& p) { p.boundaries.frozen_particles.lateral_friction = -1; }),
                    "boundaries.frozen_particles.lateral_friction: -1, allowed: 0 to 1000"));
  EXPECT_TRUE(holds(refused([](Parameters& p) { p.boundaries.frozen_particles.lateral_friction = NAN; }),
                    "nan, allowed"));
  EXPECT_TRUE(holds(refused([](Parameters& p) { p.boundaries.frozen_particles.attraction = 300; }),
                    "boundaries.frozen_particles.attraction: 300, allowed: -200 to 200"));
  EXPECT_TRUE(holds(refused([](Parameters& p) { p.domain.lower_side[2] = Side::wall; }),
                    "boundaries.lower_z: frozen_particles on a wall of beads"));
}

}  // namespace
}  // namespace dmf::engine
