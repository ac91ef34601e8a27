#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/observe/temperature.h"
#include "engine/observe/watchdog.h"
#include "engine/simulation.h"
#include "refusal.h"
#include "systems.h"

namespace dmf::engine {
namespace {

/// What stopped the run, empty when it went on to the end.
std::string fault_within(Simulation& simulation, int steps) {
  try {
    for (int k = 0; k < steps; ++k) simulation.step();
  } catch (const Instability& instability) {
    return instability.what();
  }
  return "";
}

/// A run with a droplet in the middle of the domain.
class DropletRun : public Simulation {
 public:
  explicit DropletRun(const Parameters& parameters)
      : Simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"}) {
    const Vector3d middle = 0.5 * (parameters.domain.lower + parameters.domain.upper);
    add_droplet({middle, 4});
  }
};

TEST(Watchdog, LetsASoundRunGoOn) {
  DropletRun simulation(plate(16, 14));
  EXPECT_EQ(fault_within(simulation, 2000), "");
}

TEST(Watchdog, StopsALiquidOutsideItsTemperatureBand) {
  System system{"droplet", plate(14, 12), {}};
  scatter_beads(system, 6, {2, 2, 0}, {12, 12, 8},
                [](const Vector3d& p) { return (p - Vector3d(7, 7, 3)).norm() < 4; });
  Sorted sorted(system, "reference");
  const DropletTracker tracker(system.parameters);
  const auto fault_at = [&](double scale) {
    Beads beads = system.beads;
    const auto scaled = [scale](float v) { return static_cast<float>(scale) * v; };
    for (Record& v : beads.velocity) v = {scaled(v.x), scaled(v.y), scaled(v.z), 0};
    return find_fault(system.parameters, beads, kinetic_temperature(beads, 3), sorted.bodies, tracker, {});
  };
  // Velocities are uniform in (-1.7, 1.7): a kinetic temperature of 1.7^2 / 3 = 0.96 times scale^2.
  EXPECT_EQ(fault_at(1), "");
  EXPECT_TRUE(holds(fault_at(0.5), "temperature 0.2"));
  EXPECT_TRUE(holds(fault_at(2), "temperature 3."));
  EXPECT_TRUE(holds(fault_at(2), "time_step (0.01)"));
  EXPECT_TRUE(holds(fault_at(2), "watchdog.temperature"));
  EXPECT_TRUE(holds(fault_at(std::nan("")), "temperature nan"));
  system.parameters.watchdog.lowest_temperature = 0.2;
  system.parameters.watchdog.highest_temperature = 5;
  EXPECT_EQ(fault_at(0.5), "");
  EXPECT_EQ(fault_at(2), "");
}

TEST(Watchdog, ForgivesWhatSoFewBeadsFluctuateBy) {
  // Of chi squared with 60 degrees of freedom more than 2.5 times its mean is six standard deviations, one
  // look in 10^9; three beads of the vapour are no sample of a temperature at all.
  System system{"few", plate(14, 12), {}};
  for (int k = 0; k < 3; ++k) add_bead(system, {3.0 + 3 * k, 5, 5});
  Sorted sorted(system, "reference");
  const DropletTracker tracker(system.parameters);
  for (Record& v : system.beads.velocity) v = {0.01f, 0, 0, 0};
  EXPECT_EQ(find_fault(system.parameters, system.beads, kinetic_temperature(system.beads, 3), sorted.bodies,
                       tracker, {}),
            "");
}

class BeadThroughAWall : public ::testing::TestWithParam<std::tuple<Vector3d, std::string>> {};

TEST_P(BeadThroughAWall, IsNamedWithItsPlace) {
  Parameters parameters = two_plates(14, 10);
  parameters.domain.lower_side[0] = parameters.domain.upper_side[0] = Side::reflecting;
  System system{"planted", parameters, {}};
  scatter_beads(system, 6, {2, 2, 0}, {12, 12, 8},
                [](const Vector3d& p) { return (p - Vector3d(7, 7, 3)).norm() < 3; });
  Sorted sorted(system, "reference");
  const DropletTracker tracker(system.parameters);
  ASSERT_EQ(
      find_fault(parameters, system.beads, kinetic_temperature(system.beads, 3), sorted.bodies, tracker, {}),
      "");
  const auto& [at, said] = GetParam();
  Record& bead = system.beads.position[17];
  bead = {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z()), bead.w};
  const std::string fault =
      find_fault(parameters, system.beads, kinetic_temperature(system.beads, 3), sorted.bodies, tracker, {});
  EXPECT_TRUE(holds(fault, "bead " + std::to_string(system.beads.id[17]) + " of"));
  EXPECT_TRUE(holds(fault, said));
  EXPECT_TRUE(holds(fault, "time_step"));
}

INSTANTIATE_TEST_SUITE_P(
    Everywhere, BeadThroughAWall,
    ::testing::Values(std::make_tuple(Vector3d(7, 7, -0.001), "through the plate"),
                      std::make_tuple(Vector3d(7, 7, 10.01), "through the top plate"),
                      std::make_tuple(Vector3d(-0.01, 7, 5), "beyond the lower side of x"),
                      std::make_tuple(Vector3d(14.01, 7, 5), "beyond the upper side of x"),
                      std::make_tuple(Vector3d(7, std::nan(""), 5), "nowhere")));

TEST(Watchdog, StopsAMicroparticleThatIsPushedThroughThePlate) {
  // A contact that gives way, and gravity ten thousand times what it carries.
  Parameters parameters = plate(12, 12);
  parameters.microparticles.elastic_modulus = 1;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_microparticle(sphere_at({6, 6}));
  simulation.set_body_forces({{0, 0, -5}, {0, 0, 0}});
  const std::string fault = fault_within(simulation, 3000);
  EXPECT_TRUE(holds(fault, "microparticle 1"));
  EXPECT_TRUE(holds(fault, "through the plate"));
  EXPECT_TRUE(holds(fault, "elastic_modulus (1)"));
}

/// A microparticle that sinks into a droplet, and whose shell can't keep the liquid out.
std::string fault_of_leaking(std::uint32_t allowed) {
  Parameters parameters = periodic_box(16);
  parameters.microparticles.liquid_repulsion = 0.05;
  parameters.watchdog.leak = allowed;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_droplet({{8, 8, 8}, 3.5});
  MicroparticlePlacement placement = sphere_at({8, 8}, 12.8);
  placement.attraction = -19.5;
  placement.beads = 312;
  simulation.add_microparticle(placement);
  return fault_within(simulation, 4000);
}

TEST(Watchdog, StopsWhenLiquidLeaksIntoAShell) {
  const std::string fault = fault_of_leaking(0);
  EXPECT_TRUE(holds(fault, "microparticle 1"));
  EXPECT_TRUE(holds(fault, "liquid beads inside, allowed: 0"));
  EXPECT_TRUE(holds(fault, "liquid_repulsion (0.05)"));
}

TEST(Watchdog, LetsLeakWhatTheSceneAllows) { EXPECT_EQ(fault_of_leaking(1'000'000), ""); }

/// A droplet that boils: its attraction is too weak for its temperature.
Parameters boiling() {
  Parameters parameters = periodic_box(20);
  parameters.liquid.attraction = -8;
  parameters.watchdog.highest_temperature = 100;  // of what it releases at first
  return parameters;
}

TEST(Watchdog, StopsADropletThatEvaporates) {
  DropletRun simulation(boiling());
  const std::string fault = fault_within(simulation, 5000);
  EXPECT_TRUE(holds(fault, "droplet 1"));
  EXPECT_TRUE(holds(fault, "beads have evaporated, allowed: 20 %"));
  EXPECT_TRUE(holds(fault, "attraction (-8)"));
}

TEST(Watchdog, StopsAtTheSameStepWhenTheRunIsSavedAndLoaded) {
  DropletRun whole(boiling()), first(boiling());
  const std::string expected = fault_within(whole, 5000);
  ASSERT_NE(expected, "");
  const int half = static_cast<int>(whole.steps() / 2);
  ASSERT_EQ(fault_within(first, half), "");
  Simulation second(boiling(), ContactAngleCurve::lan2016(), {1, "auto"});
  second.load_state(first.save_state());
  EXPECT_EQ(fault_within(second, 5000), expected);
}

TEST(Watchdog, DoesNotMissADropletThatWasTakenOffTheChip) {
  Parameters parameters = boiling();
  parameters.watchdog.evaporation = 0.9;
  DropletRun simulation(parameters);
  ASSERT_EQ(fault_within(simulation, 150), "");
  ASSERT_GT(simulation.observe()->vapour_beads, fewest_evaporated);
  const auto snapshot = simulation.observe();
  for (const DropletObservation& droplet : snapshot->droplets) simulation.remove_droplet(droplet.id);
  // What is left is vapour, all of what there is of the droplet.
  EXPECT_EQ(fault_within(simulation, 50), "");
}

TEST(Beads, OfADropletThatWasTakenOutLeaveTheirIdsToTheNext) {
  Simulation simulation(periodic_box(14), ContactAngleCurve::lan2016(), {1, "auto"});
  std::size_t beads = 0;
  for (std::uint32_t droplet = 1; droplet <= 5; ++droplet) {
    beads = simulation.add_droplet({{7, 7, 7}, 3});
    simulation.step();
    const auto snapshot = simulation.observe({true});
    ASSERT_EQ(snapshot->bead_ids.size(), beads);
    EXPECT_EQ(snapshot->bead_ids.front(), 0u);
    EXPECT_EQ(snapshot->bead_ids.back(), beads - 1);
    EXPECT_EQ(std::count(snapshot->bead_droplets.begin(), snapshot->bead_droplets.end(), droplet),
              static_cast<std::ptrdiff_t>(beads));
    simulation.remove_droplet(droplet);
  }
}

}  // namespace
}  // namespace dmf::engine
