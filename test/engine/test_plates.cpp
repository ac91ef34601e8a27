// Two plates: pancakes, and microparticles under the top plate. Their pressure: test/tools/test_pancake.cpp.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/simulation.h"
#include "refusal.h"
#include "systems.h"

namespace dmf::engine {
namespace {

Simulation between_plates(double size, double gap, const std::string& kernel = "auto", int threads = 1) {
  return Simulation(two_plates(size, gap), ContactAngleCurve::lan2016(), {threads, kernel});
}

TEST(Pancake, HoldsItsSpheresVolumeAndReachesBothPlates) {
  Simulation simulation = between_plates(24, 4);
  simulation.set_wettability([](double, double) { return 110.0; });  // as the top plate
  const double radius = 4.5;
  const std::size_t beads = simulation.add_droplet({{12, 12, 2}, radius});
  const double volume = 4.0 / 3.0 * M_PI * std::pow(radius, 3);
  EXPECT_NEAR(static_cast<double>(beads), 6.0 * volume, 1);
  for (int k = 0; k < 1000; ++k) simulation.step();
  const auto snapshot = simulation.observe();
  ASSERT_EQ(snapshot->droplets.size(), 1u);
  const DropletObservation& droplet = snapshot->droplets[0];
  EXPECT_GT(droplet.upper.z(), 3.0);
  EXPECT_LT(droplet.lower.z(), 1.0);
  // A rim that bulges or curves in lies within a gap of the cylinder's.
  const double pancake = pancake_radius({{12, 12, 2}, radius}, simulation.parameters());
  EXPECT_NEAR(0.5 * (droplet.upper.x() - droplet.lower.x()), pancake, 1.5);
  EXPECT_NEAR(droplet.centroid.z(), 2, 0.15);
  // A cap is what the angle is measured on; between two plates there is none.
  EXPECT_FALSE(droplet.contact_angle.has_value());
}

TEST(Pancake, ThatDoesNotFitBetweenTheSidesIsRefused) {
  Parameters parameters = two_plates(12, 3);
  parameters.domain.lower_side = {Side::reflecting, Side::reflecting, Side::wall};
  parameters.domain.upper_side = {Side::reflecting, Side::reflecting, Side::wall};
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  // A sphere of that radius would fit, but not the pancake of its volume.
  EXPECT_GT(pancake_radius({{6, 6, 1.5}, 5}, parameters), 6);
  EXPECT_THROW(simulation.add_droplet({{6, 6, 1.5}, 5}), InvalidInput);
  EXPECT_EQ(simulation.observe()->moving_beads, 0u);
  EXPECT_NO_THROW(simulation.add_droplet({{6, 6, 1.5}, 3}));
}

TEST(Droplet, SmallerThanTheGapIsASphereOnTheLowerPlate) {
  Simulation simulation = between_plates(16, 9);
  EXPECT_EQ(pancake_radius({{8, 8, 3}, 3}, simulation.parameters()), 0);
  simulation.add_droplet({{8, 8, 3}, 3});
  for (int k = 0; k < 200; ++k) simulation.step();
  EXPECT_LT(simulation.observe()->droplets.at(0).upper.z(), 7);
}

TEST(TopPlate, LeavesTheSameBitsForEveryInstructionSetThreadsAndARestart) {
  const auto hash_after = [](Simulation& simulation, int steps) {
    for (int k = 0; k < steps; ++k) simulation.step();
    return *simulation.observe({false, true})->state_hash;
  };
  Simulation first = between_plates(14, 3);
  first.add_droplet({{7, 7, 1.5}, 3});
  hash_after(first, 60);
  const std::string saved = first.save_state();
  const std::uint64_t expected = hash_after(first, 60);
  for (const std::string& kernel : available_kernels()) {
    if (kernel == "reference") continue;  // of another precision
    for (const int threads : {1, 2}) {
      Simulation other = between_plates(14, 3, kernel, threads);
      other.load_state(saved);
      EXPECT_EQ(hash_after(other, 60), expected) << kernel << ", " << threads;
    }
  }
}

TEST(TopPlate, AMicroparticleSlidesUnderItAsItDoesOnTheLowerOne) {
  // Gravity across the plates and along them: beyond the friction angle it slides and rolls. The world upside
  // down is the same world.
  for (const ContactModel model : {ContactModel::lan2016, ContactModel::coulomb}) {
    const auto slid = [model](double up) {
      Parameters parameters = two_plates(40, 6);
      parameters.microparticles.contact = model;
      parameters.microparticles.contact_damping = 0.3;
      Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
      MicroparticlePlacement placement = sphere_at({10, 10}, up > 0 ? 5.0 : 1.0);
      simulation.add_microparticle(placement);
      simulation.set_body_forces({{0.5, 0, up}, Vector3d::Zero()});
      for (int k = 0; k < 1000; ++k) simulation.step();
      return simulation.observe()->microparticles.at(0);
    };
    const MicroparticleObservation below = slid(-1), above = slid(+1);
    EXPECT_GT(below.position.x(), 15);
    EXPECT_LT(below.position.x(), 35);  // a free one would have come to 35
    EXPECT_NEAR(above.position.x(), below.position.x(), 1e-3);
    EXPECT_NEAR(above.position.z(), 6 - below.position.z(), 1e-4);
    EXPECT_NEAR(above.angular_velocity.y(), -below.angular_velocity.y(), 1e-3);
    EXPECT_NE(below.angular_velocity.y(), 0);
    // What it presses on is told of the lower plate only.
    EXPECT_GT(below.totals.steps_in_contact, 900u);
    EXPECT_EQ(above.totals.steps_in_contact, 0u);
  }
}

TEST(TopPlate, NeedsALowerOneAndAnAngleOfTheCalibration) {
  Parameters parameters = two_plates(14, 3);
  parameters.domain.lower_side[2] = Side::reflecting;
  EXPECT_FALSE(violations(parameters).empty());
  parameters = two_plates(14, 3);
  parameters.wall.top_contact_angle = 175;
  EXPECT_THROW(Simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"}), InvalidInput);
}

}  // namespace
}  // namespace dmf::engine
