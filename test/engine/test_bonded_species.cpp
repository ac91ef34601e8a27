// Chains and membranes whose beads are not those of the liquid.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "engine/bonds/mesh.h"
#include "engine/bonds/spring.h"
#include "engine/simulation.h"
#include "refusal.h"
#include "systems.h"

namespace dmf::engine {
namespace {

/// A liquid, and heads and tails that differ from it in nothing but what `between` says of the two.
Parameters with_heads_and_tails(Parameters parameters, double attraction_between) {
  const LiquidParameters& liquid = parameters.liquid;
  const PairCoefficients same{liquid.attraction, liquid.repulsion, liquid.random_amplitude};
  parameters.mixture.liquids = {{"head", same}, {"tail", same}};
  PairCoefficients between = same;
  between.attraction = attraction_between;
  parameters.mixture.pairs = {{"liquid", "head", same},
                              {"liquid", "tail", same},
                              {"head", "tail", between},
                              {"head", "wall", same},
                              {"tail", "wall", same}};
  return parameters;
}

Parameters plain(double size, double repulsion) {
  Parameters parameters = periodic_box(size);
  parameters.liquid.attraction = repulsion;
  parameters.liquid.repulsion = 0;
  parameters.liquid.random_amplitude = 3;
  parameters.liquid.initial_density = parameters.liquid.bulk_density = 3;
  parameters.watchdog.evaporation = 1;
  return parameters;
}

ChainPlacement dimers(const Parameters& parameters, std::uint32_t count) {
  ChainPlacement placement;
  placement.spring.stiffness = 60;
  placement.spring.length = 0.6;
  placement.species = {1, 2};
  placement.count = count;
  placement.beads = 2;
  placement.bond_length = 0.6;
  placement.lower = parameters.domain.lower;
  placement.upper = parameters.domain.upper;
  return placement;
}

/// How many beads there are of each species.
std::vector<std::size_t> census(const Simulation& simulation) {
  std::vector<std::size_t> counts(simulation.parameters().mixture.liquids.size() + 1, 0);
  const auto snapshot = simulation.observe({true});
  for (const std::uint8_t species : snapshot->bead_species) ++counts[species];
  return counts;
}

TEST(BondedSpecies, StandInTheOrderInWhichTheyAreNamed) {
  const Parameters parameters = with_heads_and_tails(plain(6, 25), 25);
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill_box();
  ChainPlacement placement = dimers(parameters, 20);
  placement.beads = 4;
  placement.species = {2, 0, 1, 2};
  simulation.add_chains(placement);
  const auto snapshot = simulation.observe({true});
  for (const ChainObservation& chain : snapshot->chains)
    for (std::size_t k = 0; k < 4; ++k) {
      const auto at =
          std::lower_bound(snapshot->bead_ids.begin(), snapshot->bead_ids.end(), chain.beads.at(k));
      EXPECT_EQ(snapshot->bead_species.at(static_cast<std::size_t>(at - snapshot->bead_ids.begin())),
                placement.species[k]);
    }
}

TEST(BondedSpecies, FeelTheTableOfPairs) {
  // Heads and tails repel each other and nobody else: the bond of a dimer has the mean square length of its
  // spring and their repulsion together, r^2 exp(-(U_spring + a (1 - r)^2 / 2) / k_BT).
  const double repulsion = 40;
  const Parameters parameters = with_heads_and_tails(plain(6, 0), repulsion);
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill_box();
  const ChainPlacement placement = dimers(parameters, 25);
  simulation.add_chains(placement);
  double square = 0, samples = 0;
  for (int k = 0; k < 9000; ++k) {
    simulation.step();
    if (k < 500 || k % 10 != 0) continue;
    const auto snapshot = simulation.observe();
    for (const ChainObservation& chain : snapshot->chains) {
      square += chain.end_to_end.squaredNorm();
      ++samples;
    }
  }
  const auto mean_square = [&](double a) {
    const SpringLaw law = SpringLaw::of(placement.spring, 1);
    double sum = 0, all = 0;
    for (double r = 5e-5; r < 3; r += 1e-4) {
      const double overlap = std::max(0.0, 1 - r);
      const double weight = r * r * std::exp(-law.energy(r) - 0.5 * a * overlap * overlap);
      sum += r * r * weight;
      all += weight;
    }
    return sum / all;
  };
  // 25 dimers over some 250 times of their memory: a percent. The repulsion makes 40 %.
  EXPECT_GT(mean_square(repulsion) / mean_square(0), 1.3);
  EXPECT_NEAR(square / samples / mean_square(repulsion), 1, 0.03);
}

TEST(BondedSpecies, AreTakenFromWhateverLiquidIsThere) {
  Parameters parameters = with_heads_and_tails(plain(6, 25), 25);
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill({parameters.domain.lower, parameters.domain.upper, 2});
  const std::size_t all = simulation.observe()->moving_beads;
  ASSERT_EQ(census(simulation), (std::vector<std::size_t>{0, 0, all}));
  simulation.add_chains(dimers(parameters, 30));
  EXPECT_EQ(census(simulation), (std::vector<std::size_t>{0, 30, all - 30}));
  // A chain of the first liquid is of that liquid in any other, too.
  ChainPlacement of_liquid = dimers(parameters, 10);
  of_liquid.species = {};
  simulation.add_chains(of_liquid);
  EXPECT_EQ(census(simulation), (std::vector<std::size_t>{20, 30, all - 50}));
}

TEST(BondedSpecies, InTheVapourAreNewBeads) {
  Parameters parameters = with_heads_and_tails(plain(12, 25), 25);
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_chains(dimers(parameters, 5));
  EXPECT_EQ(census(simulation)[1], 5u);
  EXPECT_EQ(census(simulation)[2], 5u);
}

TEST(BondedSpecies, BelongToTheDropletThatTheyAreIn) {
  Parameters parameters = with_heads_and_tails(plate(18, 14), -40);
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.set_wettability([](double, double) { return 110.0; });
  simulation.add_droplet({{9, 9, 4.5}, 4.4});
  const std::size_t beads = simulation.observe()->moving_beads;
  ChainPlacement placement = dimers(parameters, 400);
  placement.lower = {6.5, 6.5, 2};
  placement.upper = {11.5, 11.5, 7};
  simulation.add_chains(placement);
  MembranePlacement membrane;
  TriangleMesh mesh = icosphere(1);
  for (Vector3d& vertex : mesh.vertices) vertex = Vector3d(9, 9, 4.5) + 1.2 * vertex;
  membrane.mesh = std::make_shared<const TriangleMesh>(mesh);
  membrane.species = 2;
  simulation.add_membrane(membrane);
  // 40 % of the droplet are surfactant: lost to the droplet they would be a fault of evaporation.
  ASSERT_GT(800 + mesh.vertices.size(), parameters.watchdog.evaporation * static_cast<double>(beads));
  for (int k = 0; k < 100; ++k) simulation.step();
  const auto snapshot = simulation.observe();
  ASSERT_EQ(snapshot->droplets.size(), 1u);
  EXPECT_EQ(snapshot->droplets[0].species, 0u);
  EXPECT_GE(snapshot->droplets[0].beads, beads - 10);
  simulation.remove_droplet(snapshot->droplets[0].id);
  EXPECT_LE(simulation.observe()->moving_beads, 10u);
  EXPECT_TRUE(simulation.observe()->membranes.empty());
}

TEST(BondedSpecies, OfTwoLiquidsThatTouchBelongToEachByWhatIsAroundThem) {
  // A surfactant between two layers does not make them one droplet.
  Parameters parameters = with_heads_and_tails(plain(8, 25), 80);
  parameters.mixture.liquids.push_back({"oil", {25, 0, 3}, 3, 3});
  for (const char* other : {"liquid", "head"}) parameters.mixture.pairs.push_back({other, "oil", {80, 0, 3}});
  parameters.mixture.pairs.push_back({"tail", "oil", {25, 0, 3}});
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill({{0, 0, 0}, {8, 8, 4}, 0});
  simulation.fill({{0, 0, 4}, {8, 8, 8}, 3});
  ChainPlacement placement = dimers(parameters, 60);
  placement.lower.z() = 3.5;
  placement.upper.z() = 4.5;
  simulation.add_chains(placement);
  for (int k = 0; k < 100; ++k) simulation.step();
  const auto snapshot = simulation.observe({true});
  ASSERT_EQ(snapshot->droplets.size(), 2u);
  EXPECT_EQ(snapshot->droplets[0].species + snapshot->droplets[1].species, 3u);
  EXPECT_EQ(snapshot->droplets[0].beads + snapshot->droplets[1].beads, snapshot->moving_beads);
}

TEST(BondedSpecies, GoOnFromASavedStateWhateverTheThreads) {
  const Parameters parameters = with_heads_and_tails(plain(7, 25), 60);
  const auto fresh = [&](int threads) {
    auto simulation =
        std::make_unique<Simulation>(parameters, ContactAngleCurve::lan2016(), Execution{threads, "auto"});
    simulation->fill_box();
    simulation->add_chains(dimers(parameters, 50));
    return simulation;
  };
  const ObserveRequest hash{false, true};
  const auto one = fresh(1), three = fresh(3);
  for (int k = 0; k < 60; ++k) {
    one->step();
    three->step();
  }
  EXPECT_EQ(*one->observe(hash)->state_hash, *three->observe(hash)->state_hash);
  const auto other =
      std::make_unique<Simulation>(parameters, ContactAngleCurve::lan2016(), Execution{2, "auto"});
  other->load_state(one->save_state());
  EXPECT_EQ(census(*other), census(*one));
  for (int k = 0; k < 60; ++k) {
    one->step();
    other->step();
  }
  EXPECT_EQ(*one->observe(hash)->state_hash, *other->observe(hash)->state_hash);
  // Who is a head and who a tail is part of the state.
  Simulation turned(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  turned.fill_box();
  ChainPlacement placement = dimers(parameters, 50);
  placement.species = {2, 1};
  turned.add_chains(placement);
  EXPECT_NE(*turned.observe(hash)->state_hash, *fresh(1)->observe(hash)->state_hash);
}

TEST(BondedSpecies, ThatCanNotBeAreRefusedWhole) {
  const Parameters parameters = with_heads_and_tails(plain(8, 25), 25);
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  ChainPlacement placement = dimers(parameters, 3);
  placement.species = {1, 2, 1};
  EXPECT_TRUE(holds(refusal([&] { simulation.add_chains(placement); }),
                    "species: 3 of them, allowed: 1, or 2, one a bead"));
  placement.species = {1, 3};
  EXPECT_TRUE(holds(refusal([&] { simulation.add_chains(placement); }), "species: 3, allowed: 0 to 2"));
  TriangleMesh mesh = icosphere(1);
  for (Vector3d& vertex : mesh.vertices) vertex += Vector3d(4, 4, 4);
  MembranePlacement membrane{std::make_shared<const TriangleMesh>(mesh), {}, 4};
  EXPECT_TRUE(holds(refusal([&] { simulation.add_membrane(membrane); }), "species: 4, allowed: 0 to 2"));
  EXPECT_EQ(simulation.observe()->moving_beads, 0u);
}

}  // namespace
}  // namespace dmf::engine
