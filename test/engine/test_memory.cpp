#include <gtest/gtest.h>

#include <malloc.h>

#include <cmath>
#include <fstream>
#include <string>

#include "engine/memory.h"
#include "engine/simulation.h"
#include "refusal.h"
#include "systems.h"

namespace dmf::engine {
namespace {

/// Peak resident memory since the last forget_peak(), MB.
double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) * 1024 / bytes_per_megabyte;
  return NAN;
}
/// What was freed before goes back to the system, so that it is not taken anew unseen.
void forget_peak() {
  ::malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

/// A small run of the same kind: what of the program it needs counts as resident from its first use on, some
/// of it only when the system has not read that part of the file ahead.
void touch_program(Parameters parameters) {
  parameters.domain.upper = parameters.domain.lower + Vector3d::Constant(9);
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_droplet({parameters.domain.lower + Vector3d::Constant(4.5), 3});
  while (simulation.steps() < parameters.observe_interval) simulation.step();
}

Parameters wide_plate(double side, double height) {
  Parameters parameters = plate(side, height);
  for (int axis = 0; axis < 2; ++axis)
    parameters.domain.lower_side[axis] = parameters.domain.upper_side[axis] = Side::reflecting;
  return parameters;
}

TEST(Memory, KnowsTheBeadsOfEveryWall) {
  for (const Parameters& parameters :
       {plate(14, 12), two_plates(33.3, 5), periodic_box(9), wide_plate(3, 3)}) {
    const Walls wall(parameters);
    EXPECT_EQ(wall_beads(parameters), static_cast<double>(wall.size()));
  }
}

TEST(Memory, OfAWallIsWhatAProcessTakes) {
  const Parameters parameters = wide_plate(700, 12);
  touch_program(parameters);
  forget_peak();
  const double before = peak_memory();
  const Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  const double taken = peak_memory() - before;
  const double told = memory_need(parameters, 0, 0).wall / bytes_per_megabyte;
  EXPECT_GT(told, 0.95 * taken);
  EXPECT_LT(told, 1.4 * taken);
}

TEST(Memory, OfTheLiquidIsWhatAProcessTakes) {
  for (const Integrator integrator : {Integrator::groot_warren, Integrator::baoab}) {
    Parameters parameters = periodic_box(32);
    parameters.integrator = integrator;
    touch_program(parameters);
    forget_peak();
    const double before = peak_memory();
    Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
    const std::size_t beads = simulation.add_droplet({{16, 16, 16}, 14});
    while (simulation.steps() < parameters.observe_interval) simulation.step();
    const double taken = peak_memory() - before;
    const double told = memory_need(parameters, static_cast<double>(beads), 0).liquid / bytes_per_megabyte;
    EXPECT_GT(told, 0.95 * taken);
    EXPECT_LT(told, 1.4 * taken);
  }
}

TEST(Memory, OfMicroparticlesInLiquidIsWhatAProcessTakes) {
  // Dry ones take less: nobody is in range of their beads.
  Parameters parameters = periodic_box(20);
  touch_program(parameters);
  forget_peak();
  const double before = peak_memory();
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  MicroparticlePlacement one = sphere_at({0, 0});
  double of_bodies = 0;
  for (const double x : {2.5, 7.5, 12.5, 17.5})
    for (const double y : {2.5, 7.5, 12.5, 17.5})
      for (const double z : {2.5, 7.5, 12.5, 17.5}) {
        one.center = {x, y};
        one.z = z;
        simulation.add_microparticle(one);
        of_bodies += 612;
      }
  const auto of_liquid =
      static_cast<double>(simulation.fill({parameters.domain.lower, parameters.domain.upper}));
  while (simulation.steps() < parameters.observe_interval) simulation.step();
  const double taken = peak_memory() - before;
  const MemoryNeed need = memory_need(parameters, of_liquid, of_bodies);
  const double told = (need.liquid + need.bodies) / bytes_per_megabyte;
  EXPECT_GT(told, 0.95 * taken);
  EXPECT_LT(told, 1.4 * taken);
}

TEST(Memory, RefusesADomainThatDoesNotFitWithOneThatDoes) {
  Parameters parameters = wide_plate(4000, 62.5);  // 10^9 r_c^3
  const auto found = violations(parameters);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(holds(found[0], "domain: 4000 x 4000 x 62.5 r_c"));
  EXPECT_TRUE(holds(found[0], "allowed: 4000 MB (max_memory)"));
  parameters.domain.upper = parameters.domain.lower + largest_domain(parameters);
  EXPECT_TRUE(violations(parameters).empty());
  parameters.domain.upper *= 1.01;
  EXPECT_EQ(violations(parameters).size(), 1u);
}

TEST(Memory, RefusesAWallOfBillionsOfBeads) {
  Parameters parameters = wide_plate(4000, 10);
  parameters.domain.upper_side[2] = Side::wall;
  parameters.wall.layers = 8;
  parameters.wall.lattice_constant = 0.5;
  ASSERT_GT(wall_beads(parameters), 2e9);
  EXPECT_EQ(violations(parameters).size(), 1u);
  EXPECT_THROW(Simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"}), InvalidInput);
}

TEST(Memory, RefusesMoreLiquidThanFitsBeforeAnyOfItIsPlaced) {
  Parameters parameters = periodic_box(3000);
  parameters.max_memory = 1e6;
  parameters.max_beads = 100'000'000;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  forget_peak();
  const double before = peak_memory();
  for (const double radius : {200.0, 1000.0, 1490.0})
    EXPECT_THROW(simulation.add_droplet({{1500, 1500, 1500}, radius}), InvalidInput);
  EXPECT_THROW(simulation.fill_box(), InvalidInput);
  EXPECT_LT(peak_memory() - before, 1);
}

TEST(Memory, TellsHowManyBeadsWouldFit) {
  Parameters parameters = periodic_box(30);
  parameters.max_memory = 12;
  const std::uint64_t most = most_moving_beads(parameters, 0);
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  EXPECT_TRUE(holds(refusal([&] {
                      simulation.add_droplet({{15, 15, 15}, 8});
                    }),
                    "allowed: " + std::to_string(most) + " moving beads"));
  EXPECT_NO_THROW(require_memory(parameters, static_cast<double>(most), 0));
  EXPECT_THROW(require_memory(parameters, static_cast<double>(most + 1), 0), InvalidInput);
  // And what is there counts.
  const std::uint64_t placed = simulation.add_droplet({{8, 8, 8}, 5});
  const std::string said = refusal([&] { simulation.add_droplet({{22, 22, 22}, 7}); });
  EXPECT_TRUE(holds(said, "max_memory 12 MB"));
  EXPECT_EQ(simulation.observe()->moving_beads, placed);
}

}  // namespace
}  // namespace dmf::engine
