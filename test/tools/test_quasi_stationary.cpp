#include "tools/quasi_stationary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>

namespace dmf::tools {
namespace {

/// A small droplet on a short box that is periodic along its way: a gradient so steep that it runs at once.
chip::Scene runway() {
  return chip::parse_scene(R"(
domain: {lower: [-12, -8, 0], upper: [12, 8, 10], sides: {x: periodic, y: periodic, z: wall}}
wettability: {rest_angle: 110}
droplets: [{center: [-4, 0], radius: 3}]
settle_time: 1
schedule:
  - {at: 0, set_wettability: {positions: [-12, 12], contact_angles: [140, 60]}}
)",
                           "runway.yaml");
}

QuasiStationaryRun short_run(const std::string& name) {
  QuasiStationaryRun run;
  run.slide = 1;
  run.settle = 10;
  run.measure = 20;
  run.flow = true;
  run.folder = testing::TempDir() + "dmf_quasi_stationary_" + name;
  std::filesystem::remove_all(run.folder);
  run.key = name;
  return run;
}

struct Killed {};

TEST(QuasiStationary, HeldDropletRunsTowardsTheWettingSideAndItsLiquidWithIt) {
  const QuasiStationary held = run_quasi_stationary(runway(), 1, short_run("runs"));
  EXPECT_GT(held.velocity, 0.01);
  double beads = 0, momentum = 0;
  std::istringstream cells(held.flow.as_csv());
  std::string line;
  std::getline(cells, line);
  EXPECT_EQ(line, "plane,s,z,density,v_s,v_z");
  while (std::getline(cells, line)) {
    double s, z, density, v_s, v_z;
    char plane[3];
    ASSERT_EQ(std::sscanf(line.c_str(), "%2[^,],%lf,%lf,%lf,%lf,%lf", plane, &s, &z, &density, &v_s, &v_z),
              6);
    if (std::string(plane) == "xz") beads += density, momentum += density * v_s;
  }
  // The slab through the droplet's middle against the whole droplet: near, not equal.
  EXPECT_NEAR(momentum / beads, held.velocity, 0.5 * held.velocity);
}

TEST(QuasiStationary, FlowIsLookedAtAsOftenAsAsked) {
  QuasiStationaryRun run = short_run("often");
  run.measure = 5;
  const QuasiStationary often = run_quasi_stationary(runway(), 1, run);
  run.key = "seldom";
  run.flow_every = 50;
  const QuasiStationary seldom = run_quasi_stationary(runway(), 1, run);
  EXPECT_EQ(often.flow.looks(), 50);
  EXPECT_EQ(seldom.flow.looks(), 10);
}

TEST(QuasiStationary, KilledEndsWithTheNumbersOfAnUninterruptedRun) {
  const QuasiStationary whole = run_quasi_stationary(runway(), 2, short_run("whole"));
  QuasiStationaryRun run = short_run("killed");
  run.save_every = 0;
  run.after_look = [](double time) {
    if (time > 20) throw Killed{};  // in the middle of the measurement
  };
  EXPECT_THROW(run_quasi_stationary(runway(), 2, run), Killed);
  EXPECT_TRUE(std::filesystem::exists(run.folder + "/killed.state"));
  run.after_look = nullptr;
  const QuasiStationary resumed = run_quasi_stationary(runway(), 2, run);
  EXPECT_EQ(resumed.velocity, whole.velocity);
  EXPECT_EQ(resumed.droplet_ahead, whole.droplet_ahead);
  EXPECT_EQ(resumed.flow.as_csv(), whole.flow.as_csv());
  EXPECT_FALSE(std::filesystem::exists(run.folder + "/killed.state"));
}

TEST(QuasiStationary, DropletDragsTheMicroparticleThatTheWallHoldsBack) {
  chip::Scene scene = runway();
  engine::MicroparticlePlacement body;
  body.center = {1.1, 0};
  body.attraction = -16;
  scene.microparticles.push_back(body);
  QuasiStationaryRun run = short_run("drags");
  run.flow = false;
  run.ahead = 0.3;
  run.measure = 60;
  const QuasiStationary held = run_quasi_stationary(scene, 3, run);
  ASSERT_TRUE(std::isfinite(held.velocity)) << "not picked up";
  EXPECT_GT(held.droplet_ahead, 0);
  EXPECT_GT(held.drive_x, 0);
  EXPECT_LT(held.friction_x, 0);
  EXPECT_GT(held.normal_force, 0);
  EXPECT_NEAR(held.height, 1, 0.05);
}

TEST(QuasiStationary, RefusesASceneWithoutAGradient) {
  chip::Scene scene = runway();
  scene.schedule.clear();
  EXPECT_THROW(run_quasi_stationary(scene, 1, short_run("none")), std::runtime_error);
}

TEST(FlowField, SumsBeadsIntoBothPlanesAndLeavesOthersOut) {
  FlowField flow;
  flow.add({2.1, 0, 0.3}, {0.5, 0.25, -0.5});  // in x-z; too far off for y-z
  flow.add({2.2, 0.1, 0.3}, {1.5, 0, 0.5});    // the same cell
  flow.add({9, 9, 3}, {1, 1, 1});              // in neither
  flow.count_look();
  EXPECT_EQ(flow.as_csv(), "plane,s,z,density,v_s,v_z\nxz,2.25,0.25,4,1,0\n");
}

TEST(FlowField, MeansOverARectangleWeighEveryBeadAlike) {
  FlowField flow;
  flow.add({0.5, 1.2, 0.3}, {9, 3, 0});
  flow.add({0.5, 1.7, 0.3}, {9, 0, 3});
  flow.add({0.5, 1.7, 0.4}, {9, 0, 3});
  flow.add({0.5, 1.7, 2.3}, {9, 9, 9});   // above it
  flow.add({0.5, -1.2, 0.3}, {9, 9, 9});  // on the other side
  const auto mean = [&flow](double from, double to) {
    return flow.mean_velocity(FlowField::Plane::across, {Eigen::Vector2d(from, 0), Eigen::Vector2d(to, 2)});
  };
  EXPECT_EQ(mean(1, 2), Eigen::Vector2d(1, 2));
  EXPECT_TRUE(std::isnan(mean(3, 4).x()));
}

}  // namespace
}  // namespace dmf::tools
