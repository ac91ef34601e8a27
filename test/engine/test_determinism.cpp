// Same scene, seed and steps, same bits: whatever the threads, the instruction set and the level of
// optimisation. Compiled twice, at -O2 and at -O3.
#include <gtest/gtest.h>

#include <cmath>

#include "droplet_on_wall.h"

namespace dmf::engine {
namespace {

/// Half of it stands beyond a periodic side, on a gradient.
void start(Simulation& simulation) {
  simulation.set_wettability([](double x, double) { return 120.0 - 4.0 * std::abs(x - 8.0); });
  simulation.add_droplet({{0.5, 8, 3}, 3.5});
}

std::vector<std::string> kernels_in_lanes() {
  std::vector<std::string> kernels = available_kernels();
  kernels.pop_back();  // the double reference
  return kernels;
}

/// Made by this test on 2026-11-22, at version 0.2.0. Changes when, and only when, the arithmetic of a step
/// or of the placement changes: then say so in CHANGELOG.rst, because recorded runs no longer repeat.
constexpr std::uint64_t hash_after_400_steps = 7140333763808663901u;

TEST(Bits, AreTheSameForEveryInstructionSet) {
  for (const std::string& kernel : kernels_in_lanes()) {
    Simulation simulation = droplet_on_wall(1, kernel);
    start(simulation);
    EXPECT_EQ(hash_after(simulation, 400), hash_after_400_steps) << kernel;
  }
}

TEST(Bits, AreTheSameForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 3, 4}) {
    Simulation simulation = droplet_on_wall(threads);
    start(simulation);
    EXPECT_EQ(hash_after(simulation, 400), hash_after_400_steps) << threads << " threads";
  }
}

TEST(Bits, AreTheSameAfterARestartWithOtherThreadsAndAnotherInstructionSet) {
  Simulation first = droplet_on_wall(1);
  start(first);
  hash_after(first, 137);  // between two sorts and two looks of the tracker
  const std::string saved = first.save_state();
  for (const std::string& kernel : kernels_in_lanes()) {
    Simulation second = droplet_on_wall(2, kernel);
    second.load_state(saved);
    EXPECT_EQ(hash_after(second, 263), hash_after_400_steps) << kernel;
  }
}

}  // namespace
}  // namespace dmf::engine
