// Walls of any shape: where their beads stand, that nothing gets in, and what flows and wets there.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/integrate.h"
#include "engine/memory.h"
#include "engine/simulation.h"
#include "engine/walls/solid_beads.h"
#include "refusal.h"
#include "systems.h"
#include "yaml/units.h"

namespace dmf::engine {
namespace {

constexpr double a = 0.874;  // lattice constant of walls

/// A grid over all of the domain, solid where `is_solid` holds for a voxel's middle.
template <class IsSolid>
void label(Parameters& parameters, const std::array<int, 3>& voxels, IsSolid is_solid) {
  auto grid = std::make_shared<LabelGrid>();
  grid->origin = parameters.domain.lower;
  grid->voxels = voxels;
  grid->voxel_size = parameters.domain.size().cwiseQuotient(Vector3d(voxels[0], voxels[1], voxels[2]));
  for (int z = 0; z < voxels[2]; ++z)
    for (int y = 0; y < voxels[1]; ++y)
      for (int x = 0; x < voxels[0]; ++x) {
        const Vector3d middle =
            grid->origin + grid->voxel_size.cwiseProduct(Vector3d(x + .5, y + .5, z + .5));
        grid->labels.push_back(is_solid(middle) ? LabelGrid::solid : LabelGrid::fluid);
      }
  parameters.label_grid.grid = grid;
}

/// A box of 11 lattice constants, periodic along x and y, z closed, with solid from z = 0 to 3 voxels.
Parameters floor_of_voxels() {
  Parameters parameters = plate(11 * a, 12 * a);
  parameters.domain.lower_side[2] = parameters.domain.upper_side[2] = Side::reflecting;
  label(parameters, {11, 11, 12}, [](const Vector3d& p) { return p.z() < 3 * a; });
  return parameters;
}

/// Pillars, an overhang and a ball: faces, edges and corners of both kinds.
Parameters rough_place() {
  Parameters parameters = plate(10, 10);
  parameters.domain.lower_side[2] = parameters.domain.upper_side[2] = Side::reflecting;
  label(parameters, {20, 20, 20}, [](const Vector3d& p) {
    const bool pillar = std::abs(p.x() - 2) < 1 && std::abs(p.y() - 2) < 1 && p.z() < 6;
    const bool table = std::abs(p.z() - 7.25) < 0.25 && p.x() < 6 && p.y() < 6;
    const bool ball = (p - Vector3d(7.5, 7.5, 3)).norm() < 2;
    const bool wall = p.y() > 9.5;
    return pillar || table || ball || wall;
  });
  return parameters;
}

TEST(LabelGrid, AFlatFloorOfVoxelsHasTheLayersOfAPlate) {
  const Parameters parameters = floor_of_voxels();
  std::map<int, int> layers;  // beads by height, in thousandths
  for (const Record& bead : solid_beads(parameters)) ++layers[static_cast<int>(std::lround(1000 * bead.z))];
  // On the face and half a lattice constant apart, as far as the liquid reaches; two beads a unit square.
  ASSERT_EQ(layers.size(), 3u);
  double expected = 3 * a;
  for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer, expected -= 0.5 * a) {
    EXPECT_NEAR(layer->first, 1000 * expected, 1);
    EXPECT_EQ(layer->second, 2 * 11 * 11);
  }
}

TEST(LabelGrid, BeadsStandWithinTheLiquidsRangeOfTheFluidAndTheirNumberIsKnownBefore) {
  const Parameters parameters = rough_place();
  const Solid solid(parameters);
  const AlignedVector<Record> beads = solid_beads(parameters);
  ASSERT_GT(beads.size(), 300u);
  EXPECT_EQ(count_solid_beads(parameters), beads.size());
  EXPECT_EQ(Walls(parameters).size(), beads.size());
  EXPECT_EQ(wall_beads(parameters), static_cast<double>(beads.size()));
  for (const Record& bead : beads) {
    const Eigen::Vector3f at(bead.x, bead.y, bead.z);
    // Places on a lattice of 0.09: a corner of the fluid at a distance of 1 is seen at up to 1.16.
    bool in_solid = false, fluid_near = false;
    for (int x = -13; x <= 13; ++x)
      for (int y = -13; y <= 13; ++y)
        for (int z = -13; z <= 13 && !(in_solid && fluid_near); ++z) {
          const Eigen::Vector3f way = Eigen::Vector3f(x, y, z) / 10.9f, place = at + way;
          in_solid |= solid.contains(at + 0.01f * way);
          fluid_near |= place.z() > 0 && place.z() < 10 && way.norm() < 1.16f && !solid.contains(place);
        }
    EXPECT_TRUE(in_solid) << at.transpose();
    EXPECT_TRUE(fluid_near) << at.transpose();
  }
}

TEST(LabelGrid, NormalsPointOutOfFlatFacesAndOfABall) {
  const Parameters flat = floor_of_voxels();
  EXPECT_NEAR((Solid(flat).normal({4, 4, 3 * a - 0.1}) - Vector3d::UnitZ()).norm(), 0, 1e-12);
  EXPECT_EQ(Solid(flat).normal({4, 4, 9 * a}).norm(), 0);
  Parameters round = periodic_box(20);
  label(round, {40, 40, 40}, [](const Vector3d& p) { return (p - Vector3d(10, 10, 10)).norm() < 7; });
  const Solid ball(round);
  double worst = 1;
  for (std::uint32_t k = 0; k < 500; ++k) {
    const Vector3d way =
        Vector3d(scatter(3 * k) - .5, scatter(3 * k + 1) - .5, scatter(3 * k + 2) - .5).normalized();
    worst = std::min(worst, ball.normal(Vector3d(10, 10, 10) + 7 * way).dot(way));
  }
  EXPECT_GT(worst, std::cos(25 * degree));  // single voxels' faces would be off by up to 55 degrees
}

TEST(LabelGrid, AFreeWayEndsOnTheFirstFace) {
  const Parameters parameters = rough_place();
  const Solid solid(parameters);
  EXPECT_FLOAT_EQ(solid.free_fraction({0.5f, 2, 3}, {1, 0, 0}), 0.5f);
  EXPECT_FLOAT_EQ(solid.free_fraction({0.5f, 2, 3}, {0.25f, 0, 0}), 1.f);
  EXPECT_NEAR(solid.free_fraction({3.1f, 2, 3}, {-0.4f, 0, 0}), 0.25f, 1e-6);
  // Over a periodic side: the wall at y > 9.5 stands behind y = 0, too.
  EXPECT_FLOAT_EQ(solid.free_fraction({5, 0.25f, 1}, {0, -0.5f, 0}), 0.5f);
  EXPECT_TRUE(solid.contains({5, -0.25f, 1}));
  // Through the table, which a step can jump.
  EXPECT_NEAR(solid.free_fraction({5, 5, 6.9f}, {0, 0, 0.8f}), 0.125f, 1e-6);
  EXPECT_FLOAT_EQ(solid.free_fraction({8, 8, 8}, {1, 0.5f, 0.3f}), 1.f);
}

TEST(LabelGrid, NoBeadGetsInHoweverFastAtFacesEdgesAndCorners) {
  // Free flight: no forces, random velocities of up to 0.4 r_c a step. A bead that got in would stay and be
  // found; one that went through the table or the wall would be on the wrong side of a sealed room.
  Parameters parameters = rough_place();
  parameters.time_step = 0.1;
  const Solid solid(parameters);
  Beads beads;
  for (std::uint32_t k = 0; k < 3000; ++k) {
    const Vector3d at(10 * scatter(7 * k), 10 * scatter(7 * k + 1), 10 * scatter(7 * k + 2));
    if (solid.contains(at.cast<float>())) continue;
    const Record moving{static_cast<float>(4.6 * scatter(7 * k + 3) - 2.3),
                        static_cast<float>(4.6 * scatter(7 * k + 4) - 2.3),
                        static_cast<float>(4.6 * scatter(7 * k + 5) - 2.3), 0};
    beads.add({static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z()), 0}, moving,
              k);
  }
  ASSERT_GT(beads.size(), 2000u);
  std::size_t turned = 0;
  for (int step = 0; step < 800; ++step) {
    const AlignedVector<Record> before = beads.velocity;
    ASSERT_LT(drift(beads, parameters, step, solid).wild_bead, 0);
    for (std::size_t i = 0; i < beads.size(); ++i) {
      Record& p = beads.position[i];
      ASSERT_FALSE(solid.contains({p.x, p.y, p.z})) << "step " << step << ", bead " << i;
      ASSERT_TRUE(p.z >= 0 && p.z <= 10);
      turned += beads.velocity[i].x != before[i].x;
      // Bounce-back keeps the speed to the bit.
      ASSERT_EQ(std::abs(beads.velocity[i].x), std::abs(before[i].x));
      // A new way now and then, so that a bead does not go to and fro on one line.
      if ((step + i) % 37 == 0) {
        Record& v = beads.velocity[i];
        v = {v.y, v.z, v.x, 0};
      }
      // What Pairs::rebuild does now and then.
      for (float* component : {&p.x, &p.y}) *component -= 10 * std::floor(*component / 10);
    }
  }
  EXPECT_GT(turned, 50'000u);
}

TEST(LabelGrid, NothingLeavesARoomWhoseWallsAreThinnerThanAStepIsLong) {
  // A closed shell of voxels of 0.25, half a step thick.
  Parameters parameters = periodic_box(10);
  parameters.time_step = 0.1;
  label(parameters, {40, 40, 40}, [](const Vector3d& p) {
    const double out = (p - Vector3d(5, 5, 5)).cwiseAbs().maxCoeff();
    return out > 3 && out < 3.25;
  });
  const Solid solid(parameters);
  Beads beads;
  for (std::uint32_t k = 0; k < 1000; ++k) {
    const auto place = [k](int n) { return static_cast<float>(2.1 + 5.8 * scatter(7 * k + n)); };
    const auto speed = [k](int n) { return static_cast<float>(5 * scatter(7 * k + n) - 2.5); };
    beads.add({place(0), place(1), place(2), 0}, {speed(3), speed(4), speed(5), 0}, k);
  }
  for (int step = 0; step < 1500; ++step) {
    drift(beads, parameters, step, solid);
    for (std::size_t i = 0; i < beads.size(); ++i)
      if ((step + i) % 41 == 0) {
        Record& v = beads.velocity[i];
        v = {v.z, v.x, v.y, 0};
      }
  }
  for (const Record& p : beads.position) {
    EXPECT_LE((Vector3d(p.x, p.y, p.z) - Vector3d(5, 5, 5)).cwiseAbs().maxCoeff(), 3.0001);
  }
}

TEST(LabelGrid, AFloorOfVoxelsPullsALiquidAsAPlateDoes) {
  // The same liquid over a plate and over a floor of voxels whose layers lie alike: the same lattice, shifted
  // along the face. Means over many beads must agree.
  const auto pull = [](bool voxels) {
    Parameters parameters = plate(11 * a, 9 * a);
    if (voxels) {
      parameters = floor_of_voxels();
      parameters.label_grid.contact_angle = 90;
    }
    Walls walls(parameters);
    walls.set_fixed_wettability(parameters, ContactAngleCurve::lan2016());
    walls.set_wettability([](double, double) { return 90.0; }, ContactAngleCurve::lan2016());
    Beads beads;
    const float bottom = voxels ? static_cast<float>(3 * a) : 0.f;
    for (std::uint32_t k = 0; k < 4000; ++k)
      beads.add({static_cast<float>(11 * a * scatter(3 * k)), static_cast<float>(11 * a * scatter(3 * k + 1)),
                 bottom + static_cast<float>(scatter(3 * k + 2)), 0},
                {}, k);
    // Only the wall acts: the liquid's own pairs are taken out by doing it twice.
    const auto forces_with = [&](const Walls& wall, Beads sorted) {
      Microparticles none(parameters);
      Pairs pairs(parameters);
      Forces forces(parameters, "reference");
      pairs.rebuild(sorted, wall);
      forces.density(sorted, wall, none, pairs);
      forces.force(PairForce::conservative, sorted.force, sorted, wall, none, pairs);
      double sum = 0;
      for (const Record& f : sorted.force) sum += f.z;
      return sum / static_cast<double>(sorted.size());
    };
    Parameters bare = parameters;
    bare.label_grid.grid = nullptr;
    bare.domain.lower_side[2] = Side::reflecting;
    return forces_with(walls, beads) - forces_with(Walls(bare), beads);
  };
  const double of_plate = pull(false);
  EXPECT_NEAR(pull(true), of_plate, 0.03 * std::abs(of_plate));
  EXPECT_NE(of_plate, 0);
}

TEST(LabelGrid, LiquidAroundItStaysOutAndLeavesTheSameBitsForAnyThreadsAndARestart) {
  Parameters parameters = rough_place();
  parameters.label_grid.attraction = -18;
  const auto start = [&](int threads, const std::string& kernel) {
    return std::make_unique<Simulation>(parameters, ContactAngleCurve::lan2016(), Execution{threads, kernel});
  };
  const auto hash_after = [](Simulation& simulation, int steps) {
    for (int k = 0; k < steps; ++k) simulation.step();
    return *simulation.observe({false, true})->state_hash;
  };
  const auto first = start(1, "auto");
  const std::size_t beads = first->fill_box();
  const Solid solid(parameters);
  hash_after(*first, 60);
  const std::string saved = first->save_state();
  const std::uint64_t expected = hash_after(*first, 60);
  for (const std::string& kernel : available_kernels()) {
    if (kernel == "reference") continue;
    const auto other = start(2, kernel);
    other->load_state(saved);
    EXPECT_EQ(hash_after(*other, 60), expected) << kernel;
  }
  const auto seen = first->observe({true, false});
  EXPECT_EQ(seen->moving_beads, beads);
  for (const Eigen::Vector3f& at : seen->positions) EXPECT_FALSE(solid.contains_deep(at, 1e-3f));
}

TEST(LabelGrid, ABodyForceThatPressesLiquidIntoAWallDoesNotGetItIn) {
  Parameters parameters = floor_of_voxels();
  parameters.label_grid.attraction = -20;
  parameters.observe_interval = 10;  // the watchdog looks for beads in the solid
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {2, "auto"});
  simulation.fill_slab({0, 0, 3 * a}, {11 * a, 11 * a, 8 * a});
  simulation.set_body_forces({{0, 0, -5}, Vector3d::Zero()});
  EXPECT_NO_THROW(for (int k = 0; k < 200; ++k) simulation.step());
}

TEST(LabelGrid, BaoabBouncesOffIt) {
  Parameters parameters = rough_place();
  parameters.integrator = Integrator::baoab;
  parameters.label_grid.attraction = -15;
  parameters.observe_interval = 10;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {2, "auto"});
  simulation.fill_box();
  EXPECT_NO_THROW(for (int k = 0; k < 200; ++k) simulation.step());
  EXPECT_NEAR(simulation.observe()->temperature, 1, 0.1);
}

TEST(LabelGrid, FillingLeavesTheSolidOut) {
  const Parameters parameters = floor_of_voxels();
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  const double volume = 11 * a * 11 * a * 9 * a;
  EXPECT_NEAR(static_cast<double>(simulation.fill_box()), 6 * volume, 0.06 * 6 * volume);
  const auto seen = simulation.observe({true, false});
  for (const Eigen::Vector3f& at : seen->positions) EXPECT_GE(at.z(), 3 * a - 1e-4);
}

TEST(LabelGrid, DropletsAndMicroparticlesThatDoNotGoWithItAreRefusedAndNothingChanges) {
  Simulation simulation(floor_of_voxels(), ContactAngleCurve::lan2016(), {1, "auto"});
  const std::uint64_t before = *simulation.observe({false, true})->state_hash;
  EXPECT_TRUE(holds(refusal([&] { simulation.add_droplet({{5, 5, 3 * a}, 2}); }), "in the solid"));
  EXPECT_TRUE(holds(refusal([&] { simulation.fill_slab({0, 0, 0}, {9, 9, 2}); }), "no fluid voxel"));
  EXPECT_TRUE(holds(refusal([&] {
                      simulation.add_microparticle(sphere_at({5, 5}, 3 * a + 0.9));
                    }),
                    "is 0.9 r_c from the label grid's solid, allowed: its radius of 1 or more"));
  EXPECT_TRUE(holds(refusal([&] {
                      simulation.add_microparticle(sphere_at({5, 5}, 1.5));
                    }),
                    "is 0 r_c from the label grid's solid"));
  EXPECT_EQ(*simulation.observe({false, true})->state_hash, before);
  EXPECT_NO_THROW(simulation.add_droplet({{5, 5, 3 * a + 2.1}, 2}));
}

TEST(LabelGrid, WhatDoesNotGoTogetherIsNamedAndRefused) {
  const auto refused = [](auto change) {
    Parameters parameters = floor_of_voxels();
    auto grid = std::make_shared<LabelGrid>(*parameters.label_grid.grid);
    change(*grid, parameters);
    parameters.label_grid.grid = grid;
    return refusal([&] { Simulation(parameters, ContactAngleCurve::lan2016()); });
  };
  using Grid = LabelGrid&;
  using All = Parameters&;
  EXPECT_TRUE(holds(refused([](Grid g, All) { std::fill(g.labels.begin(), g.labels.end(), 1); }),
                    "label_grid: no fluid voxel"));
  EXPECT_TRUE(holds(refused([](Grid g, All) { g.labels.pop_back(); }),
                    "label_grid.labels: 1451, allowed: 11 x 11 x 12 = 1452"));
  EXPECT_TRUE(holds(refused([](Grid g, All) { g.labels[7] = 2; }), "label_grid.labels: 2 for voxel 7"));
  EXPECT_TRUE(holds(refused([](Grid g, All) { g.voxel_size.z() = 0.1; }), "label_grid.voxel_size.z: 0.1"));
  EXPECT_TRUE(holds(refused([](Grid g, All) { g.voxel_size.z() = NAN; }), "label_grid.voxel_size.z: nan"));
  EXPECT_TRUE(holds(refused([](Grid g, All) { g.voxels[1] = 0; }), "label_grid.voxels.y: 0, allowed: 1 to"));
  EXPECT_TRUE(holds(refused([](Grid g, All) { g.origin.z() = 1; }), "along z, allowed: in the domain"));
  EXPECT_TRUE(holds(refused([](Grid g, All) { g.voxel_size.x() = 0.8; }), "allowed: all of the period"));
  EXPECT_TRUE(
      holds(refused([](Grid, All p) { p.label_grid.attraction = 5; }), "label_grid.attraction: 5, allowed"));
  EXPECT_TRUE(holds(refused([](Grid, All p) {
                      p.label_grid.attraction = -5;
                      p.liquid.attraction = 18.75;
                      p.liquid.repulsion = 0;
                    }),
                    "label_grid.attraction: -5, allowed: 0 to 200"));
  EXPECT_TRUE(holds(refused([](Grid, All p) { p.label_grid.contact_angle = 170; }), "contact angle: 170"));
  EXPECT_TRUE(holds(refused([](Grid, All p) { p.label_grid.lattice_constant = 0.1; }), "lattice_constant"));
}

TEST(LabelGrid, ASavedStateWithABeadInTheSolidIsRefused) {
  Parameters open = floor_of_voxels();
  auto grid = std::make_shared<LabelGrid>(*open.label_grid.grid);
  // The same number of wall beads, the other side up.
  std::reverse(grid->labels.begin(), grid->labels.end());
  Parameters upside_down = open;
  upside_down.label_grid.grid = grid;
  Simulation one(open, ContactAngleCurve::lan2016(), {1, "auto"});
  one.add_droplet({{5, 5, 9 * a}, 2});
  Simulation other(upside_down, ContactAngleCurve::lan2016(), {1, "auto"});
  EXPECT_TRUE(holds(refusal([&] { other.load_state(one.save_state()); }), "is in the solid"));
}

}  // namespace
}  // namespace dmf::engine
