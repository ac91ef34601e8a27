// Several liquids in one run.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine/mixture.h"
#include "engine/simulation.h"
#include "engine/walls/walls.h"
#include "refusal.h"
#include "systems.h"

namespace dmf::engine {
namespace {

/// Plain DPD of Groot and Warren, three beads per r_c^3, and a second liquid that differs from it only in how
/// strongly the two repel each other.
Parameters two_liquids(const Vector3d& size, double repulsion_between) {
  Parameters parameters = periodic_box(1);
  parameters.domain.upper = size;
  LiquidParameters& liquid = parameters.liquid;
  liquid.attraction = 25;
  liquid.repulsion = 0;
  liquid.random_amplitude = 3;
  liquid.initial_density = liquid.bulk_density = 3;
  parameters.time_step = 0.02;
  parameters.mixture.liquids = {{"oil", {25, 0, 3}, 3, 3}};
  parameters.mixture.pairs = {{"liquid", "oil", {repulsion_between, 0, 3}}};
  parameters.watchdog.evaporation = 1;
  return parameters;
}

/// Liquid in the lower half, oil in the upper.
void fill_layers(Simulation& simulation) {
  const Domain& domain = simulation.parameters().domain;
  const double middle = 0.5 * (domain.lower.z() + domain.upper.z());
  simulation.fill({domain.lower, {domain.upper.x(), domain.upper.y(), middle}, 0});
  simulation.fill({{domain.lower.x(), domain.lower.y(), middle}, domain.upper, 1});
}

void run(Simulation& simulation, int steps) {
  for (int k = 0; k < steps; ++k) simulation.step();
}

/// Share of the other liquid within 2 r_c of the middles of both layers.
double share_of_strangers(const Simulation& simulation) {
  const auto snapshot = simulation.observe({true});
  const double height = simulation.parameters().domain.size().z();
  double strangers = 0, all = 0;
  for (std::size_t k = 0; k < snapshot->positions.size(); ++k) {
    const double z = snapshot->positions[k].z() / height - std::floor(snapshot->positions[k].z() / height);
    const bool lower = std::abs(z - 0.25) * height < 2, upper = std::abs(z - 0.75) * height < 2;
    if (!lower && !upper) continue;
    ++all;
    strangers += snapshot->bead_species[k] != (lower ? 0 : 1);
  }
  return strangers / all;
}

/// @param height  of both layers, lattice cells of 1.1 r_c.
double mean_share_of_strangers(double repulsion_between, int height) {
  // Whole lattice cells: exactly three beads per r_c^3.
  const double cell = std::cbrt(4.0 / 3);
  Simulation simulation(two_liquids({6 * cell, 6 * cell, height * cell}, repulsion_between),
                        ContactAngleCurve::lan2016(), {1, "auto"});
  fill_layers(simulation);
  run(simulation, 2500);
  double sum = 0;
  const int looks = 100;
  for (int look = 0; look < looks; ++look) {
    run(simulation, 40);
    sum += share_of_strangers(simulation);
  }
  return sum / looks;
}

TEST(TwoLiquids, DissolveInEachOtherAsFloryAndHugginsSay) {
  // Groot and Warren (1997): chi = 0.286 (a_AB - a_AA) at three beads per r_c^3, from this very measurement:
  // 4.29 at a_AB 40, where 1.5 % of each liquid is the other one. Of some 1,000 beads that are looked at 15
  // are strangers, who come and go in some 10 tau: 10 % of scatter over 80 tau, 0.1 in chi.
  const double share = mean_share_of_strangers(40, 16);
  const double chi = std::log((1 - share) / share) / (1 - 2 * share);
  EXPECT_NEAR(chi, 0.286 * 15, 0.35);
}

TEST(TwoLiquids, MixBelowTheCriticalRepulsion) {
  // chi = 0.86, less than the critical 2: one phase, half and half. Layers of four cells dissolve in
  // (8.8 r_c / 2 pi)^2 / D, some 10 tau.
  EXPECT_NEAR(mean_share_of_strangers(28, 8), 0.5, 0.05);
}

TEST(TwoLiquids, DemixFromAMixtureAboveTheCriticalRepulsion) {
  const Vector3d size(8, 8, 8);
  Simulation mixing(two_liquids(size, 25), ContactAngleCurve::lan2016(), {1, "auto"});
  fill_layers(mixing);
  run(mixing, 3000);
  const auto like_neighbours = [](const Simulation& simulation) {
    const auto snapshot = simulation.observe({true});
    double like = 0, all = 0;
    const Domain& domain = simulation.parameters().domain;
    for (std::size_t i = 0; i < snapshot->positions.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (domain.nearest_image((snapshot->positions[i] - snapshot->positions[j]).cast<double>()).norm() <
            1) {
          ++all;
          like += snapshot->bead_species[i] == snapshot->bead_species[j];
        }
    return like / all;
  };
  EXPECT_NEAR(like_neighbours(mixing), 0.5, 0.03);
  Simulation demixing(two_liquids(size, 55), ContactAngleCurve::lan2016(), {1, "auto"});
  demixing.load_state(mixing.save_state());
  run(demixing, 2000);
  // Domains as large as the box: only beads at their faces have strangers beside them.
  EXPECT_GT(like_neighbours(demixing), 0.8);
}

/// Three liquids whose every pair differs but in B, in a box: their force has a potential.
Parameters three_liquids(Integrator integrator, double time_step) {
  System system{"", periodic_box(7), {}};
  mix(system);
  for (FurtherLiquid& liquid : system.parameters.mixture.liquids) liquid.own.repulsion = 25;
  for (PairOfSpecies& pair : system.parameters.mixture.pairs) pair.coefficients.repulsion = 25;
  system.parameters.integrator = integrator;
  system.parameters.time_step = time_step;
  system.parameters.watchdog.evaporation = 1;
  return system.parameters;
}

void fill_thirds(Simulation& simulation) {
  for (std::uint32_t k = 0; k < 3; ++k) simulation.fill({{0, 0, 7 * k / 3.0}, {7, 7, 7 * (k + 1) / 3.0}, k});
}

TEST(ThreeLiquids, EachHaveTheTemperatureOfAllAndKeepTheirMomentum) {
  for (const auto& [integrator, time_step] :
       {std::pair{Integrator::groot_warren, 0.005}, {Integrator::baoab, 0.02}}) {
    Simulation simulation(three_liquids(integrator, time_step), ContactAngleCurve::lan2016(), {1, "auto"});
    fill_thirds(simulation);
    run(simulation, static_cast<int>(5 / time_step));
    std::array<double, 3> energy{}, count{};
    for (int look = 0; look < 50; ++look) {
      run(simulation, static_cast<int>(0.2 / time_step));
      const auto snapshot = simulation.observe({true});
      for (std::size_t k = 0; k < snapshot->velocities.size(); ++k) {
        energy[snapshot->bead_species[k]] += snapshot->velocities[k].cast<double>().squaredNorm();
        ++count[snapshot->bead_species[k]];
      }
    }
    // 700 beads of each, 50 looks some velocity memories apart: sqrt(2 / (3 * 700 * 50)) = 0.5 %, and up to
    // 1.5 % that a step of this length takes off.
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(energy[k] / (3 * count[k]), 1, 0.03) << "species " << k << ", step " << time_step;
    // Each of 2,000 beads has 1.7 r_c/tau; sums of floats round by 1e-7 of that a step.
    EXPECT_LT(simulation.observe()->momentum.norm(), 0.05);
  }
}

TEST(ThreeLiquids, GiveTheSameBitsForEveryInstructionSetThreadsAndAfterARestart) {
  const Parameters parameters = three_liquids(Integrator::groot_warren, 0.005);
  const auto start = [&](const std::string& kernel, int threads) {
    auto simulation =
        std::make_unique<Simulation>(parameters, ContactAngleCurve::lan2016(), Execution{threads, kernel});
    fill_thirds(*simulation);
    return simulation;
  };
  const auto hash_of = [](const Simulation& simulation) {
    return *simulation.observe({false, true})->state_hash;
  };
  const auto first = start("auto", 1);
  run(*first, 73);
  const std::string saved = first->save_state();
  run(*first, 77);
  const std::uint64_t hash = hash_of(*first);
  std::vector<std::string> kernels = available_kernels();
  kernels.pop_back();  // the double reference
  for (const std::string& kernel : kernels) {
    const auto other = start(kernel, 2);
    run(*other, 150);
    EXPECT_EQ(hash_of(*other), hash) << kernel;
  }
  Simulation restarted(parameters, ContactAngleCurve::lan2016(), {2, "auto"});
  restarted.load_state(saved);
  run(restarted, 77);
  EXPECT_EQ(hash_of(restarted), hash);
}

TEST(ThreeLiquids, AreTheirSpeciesWhateverTheOrderInStorage) {
  Simulation simulation(three_liquids(Integrator::groot_warren, 0.005), ContactAngleCurve::lan2016(),
                        {1, "auto"});
  fill_thirds(simulation);
  const auto before = simulation.observe({true});
  run(simulation, 200);
  const auto after = simulation.observe({true});
  EXPECT_EQ(before->bead_ids, after->bead_ids);
  EXPECT_EQ(before->bead_species, after->bead_species);
}

/// Oil all around a droplet of liquid on a wall: two that don't mix, both cohesive.
Parameters oil_bath() {
  Parameters parameters = plate(16, 12);
  parameters.time_step = 0.005;
  parameters.mixture.liquids = {{"oil", {-40, 25, 6}, 6, 6.06}};
  parameters.mixture.pairs = {{"liquid", "oil", {-10, 25, 6}}, {"oil", "wall", {-22, 25, 6}}};
  return parameters;
}

TEST(Droplets, OfTwoLiquidsThatTouchAreTwo) {
  Simulation simulation(oil_bath(), ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.set_wettability([](double, double) { return 130.0; });
  simulation.add_droplet({{8, 8, 3.5}, 3.5});
  const std::size_t oil = simulation.fill({{0, 0, 0}, {16, 16, 9}, 1});
  run(simulation, 100);
  const auto snapshot = simulation.observe();
  ASSERT_EQ(snapshot->droplets.size(), 2u);
  const DropletObservation &droplet = snapshot->droplets[0], &bath = snapshot->droplets[1];
  EXPECT_EQ(droplet.species, 0u);
  EXPECT_EQ(bath.species, 1u);
  EXPECT_GT(bath.beads, 0.98 * static_cast<double>(oil));
  EXPECT_LT((droplet.centroid - Vector3d(8, 8, 3.5)).norm(), 1.0);
  EXPECT_FALSE(bath.contact_angle) << "a bath from side to side has no edge";
}

TEST(WettedArea, IsThatOfTheFirstLiquidAlone) {
  Simulation simulation(oil_bath(), ContactAngleCurve::lan2016(), {1, "auto"});
  ObserveRequest request;
  request.wetted = true;
  const auto wet_cells = [&] {
    const WettedArea wetted = *simulation.observe(request)->wetted;
    return std::count(wetted.wet.begin(), wetted.wet.end(), true);
  };
  simulation.fill({{0, 0, 0}, {16, 16, 4}, 1});
  EXPECT_EQ(wet_cells(), 0);
  simulation.remove_droplet(1);
  simulation.fill({{0, 0, 0}, {8, 16, 4}, 0});
  simulation.fill({{8, 0, 0}, {16, 16, 4}, 1});
  EXPECT_EQ(wet_cells(), 8 * 16);
}

TEST(Fill, HasTheDensityOfItsLiquidAndLeavesOutWhereSomethingIs) {
  Parameters parameters = two_liquids({12, 12, 12}, 40);
  parameters.mixture.liquids[0].initial_density = 5;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  const auto droplet = static_cast<double>(simulation.add_droplet({{6, 6, 6}, 4}));
  const auto oil = static_cast<double>(simulation.fill({{0, 0, 0}, {12, 12, 12}, 1}));
  // The sphere grown by what two lattices keep from each other: at least nothing, at most their distance.
  const auto sphere = [](double radius) { return 4.0 / 3.0 * M_PI * std::pow(radius, 3); };
  EXPECT_LT(oil, 5 * (1728 - sphere(3.8)));
  EXPECT_GT(oil, 5 * (1728 - sphere(4.5)));
  const auto snapshot = simulation.observe({true});
  EXPECT_EQ(snapshot->positions.size(), static_cast<std::size_t>(droplet + oil));
  double nearest = 12;
  for (std::size_t i = 0; i < snapshot->positions.size(); ++i)
    for (std::size_t j = 0; j < static_cast<std::size_t>(droplet) && j < i; ++j)
      nearest = std::min(
          nearest,
          parameters.domain.nearest_image((snapshot->positions[i] - snapshot->positions[j]).cast<double>())
              .norm());
  EXPECT_GT(nearest, 0.4 * std::cbrt(4.0 / 5));
  EXPECT_TRUE(holds(refusal([&] { simulation.fill({{0, 0, 0}, {12, 12, 12}, 1}); }), "no free place"));
  EXPECT_TRUE(holds(refusal([&] { simulation.fill({{0, 0, 0}, {12, 12, 13}, 1}); }), "in the domain"));
  EXPECT_TRUE(holds(refusal([&] { simulation.fill({{0, 0, 0}, {12, 12, 12}, 2}); }), "species 2, allowed"));
}

TEST(Wall, OfTheMixturesAttractionIsTheSameEverywhereAndTakesNoContactAngle) {
  Parameters parameters = two_liquids({8, 8, 8}, 40);
  parameters.domain.lower_side[2] = Side::wall;
  parameters.domain.upper_side[2] = Side::reflecting;
  parameters.mixture.pairs.push_back({"wall", "liquid", {15, 0, 3}});
  parameters.mixture.pairs.push_back({"oil", "wall", {15, 0, 3}});
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  const std::uint64_t before = *simulation.observe({false, true})->state_hash;
  EXPECT_TRUE(holds(refusal([&] { simulation.set_wettability([](double, double) { return 90.0; }); }),
                    "attraction is given (15)"));
  EXPECT_EQ(*simulation.observe({false, true})->state_hash, before);
  Walls wall(parameters);
  wall.set_fixed_wettability(parameters, ContactAngleCurve::lan2016());
  for (const Record& bead : wall.beads()) ASSERT_EQ(bead.w, 15.f);
  parameters.wall.attraction = 10;
  EXPECT_TRUE(holds(refusal([&] { Simulation(parameters, ContactAngleCurve::lan2016()); }),
                    "wall.attraction: 10 beside pairs.liquid.wall"));
}

/// A microparticle beside a slab of one liquid, after a few steps without noise.
std::shared_ptr<const Snapshot> beside_a_slab(const Parameters& parameters, std::uint32_t species,
                                              bool smooth, double attraction) {
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill({{0, 0, 1}, {7, 7, 4}, species});
  MicroparticlePlacement placement = sphere_at({3.5, 3.5}, 5.6);
  placement.attraction = attraction;
  placement.smooth = smooth;
  simulation.add_microparticle(placement);
  run(simulation, 40);
  return simulation.observe({true});
}

TEST(Species, HasWithMicroparticlesTheLawOfThatPairWhateverTheirOwnAttraction) {
  // A liquid of another name but the first one's numbers moves as that one does around a microparticle that
  // attracts with what the pair has: without noise, since the keys tell the two apart.
  Parameters alone = periodic_box(7);
  alone.liquid.random_amplitude = 0;
  alone.watchdog.lowest_temperature = 0;
  alone.microparticles.liquid_repulsion = 7;
  Parameters mixed = alone;
  mixed.microparticles.liquid_repulsion = 3;
  const LiquidParameters& liquid = alone.liquid;
  mixed.mixture.liquids = {{"oil", {liquid.attraction, liquid.repulsion, 0}, 6, 6.06}};
  mixed.mixture.pairs = {{"liquid", "oil", {-10, liquid.repulsion, 0}},
                         {"oil", "microparticle", {-23, 7, 0}}};
  for (const bool smooth : {false, true}) {
    SCOPED_TRACE(smooth ? "smooth" : "shell");
    const auto as_oil = beside_a_slab(mixed, 1, smooth, -9), as_liquid = beside_a_slab(alone, 0, smooth, -23),
               weaker = beside_a_slab(alone, 0, smooth, -9);
    const MicroparticleObservation &one = as_oil->microparticles.at(0),
                                   &other = as_liquid->microparticles.at(0);
    EXPECT_EQ(one.position, other.position);
    EXPECT_LT(one.velocity.z(), weaker->microparticles.at(0).velocity.z());  // the stronger one draws it down
    ASSERT_EQ(as_oil->positions.size(), as_liquid->positions.size());
    for (std::size_t k = 0; k < as_oil->positions.size(); ++k)
      EXPECT_EQ(as_oil->positions[k], as_liquid->positions[k]) << "bead " << k;
  }
}

TEST(PairTable, ThatIsNotSoundIsRefusedByWhatIsWrong) {
  const auto refused = [](auto change) {
    Parameters parameters = oil_bath();
    change(parameters.mixture);
    return refusal([&] { Simulation(parameters, ContactAngleCurve::lan2016()); });
  };
  EXPECT_TRUE(holds(refused([](auto& m) { m.pairs.pop_back(); }), "pairs: no law for oil and wall, allowed"));
  EXPECT_TRUE(holds(refused([](auto& m) { m.pairs.erase(m.pairs.begin()); }), "no law for liquid and oil"));
  EXPECT_TRUE(holds(refused([](auto& m) {
                      m.liquids.push_back({"wax", {-30, 25, 6}, 6, 6});
                    }),
                    "no law for oil and wax"));
  EXPECT_TRUE(holds(refused([](auto& m) {
                      m.pairs.push_back({"oil", "liquid", {-10, 25, 6}});
                    }),
                    "pairs.oil.liquid: given twice, allowed: one law"));
  EXPECT_TRUE(holds(refused([](auto& m) {
                      m.pairs.push_back({"oil", "liquid", {-12, 25, 6}});
                    }),
                    "given twice, and an asymmetric table"));
  EXPECT_TRUE(holds(refused([](auto& m) {
                      m.pairs.push_back({"oil", "tar", {-12, 25, 6}});
                    }),
                    "pairs.oil.tar: unknown species tar, allowed: liquid, oil, wall, microparticle"));
  for (const char* name : {"liquid", "wall"})
    EXPECT_TRUE(holds(refused([name](auto& m) {
                        m.pairs.push_back({name, "microparticle", {-12, 3, 6}});
                      }),
                      std::string(name) + ".microparticle: allowed: a species that is listed"));
  EXPECT_TRUE(holds(refused([](auto& m) {
                      m.pairs.push_back({"oil", "oil", {-12, 25, 6}});
                    }),
                    "a species with itself"));
  EXPECT_TRUE(holds(refused([](auto& m) { m.liquids[0].name = "wall"; }), "species.wall: name, allowed"));
  EXPECT_TRUE(holds(refused([](auto& m) { m.pairs[0].coefficients.repulsion = 0; }),
                    "pairs.liquid.oil.attraction: -10, allowed: 0 to 200 with repulsion 0"));
  EXPECT_TRUE(
      holds(refused([](auto& m) { m.liquids[0].own.attraction = NAN; }), "species.oil.attraction: nan"));
  EXPECT_TRUE(
      holds(refused([](auto& m) { m.liquids[0].initial_density = 0; }), "initial_density: 0, allowed"));
  EXPECT_TRUE(holds(refused([](auto& m) {
                      for (int k = 0; k < 7; ++k)
                        m.liquids.push_back({std::to_string(k), {-30, 25, 6}, 6, 6});
                    }),
                    "species: 8 beside liquid, allowed: up to 7"));
}

TEST(PairTable, NeedsALawWithTheWallWhereTheOnlyWallIsTheSolidOfALabelGrid) {
  Parameters parameters = two_liquids({6, 6, 6}, 50);
  auto grid = std::make_shared<LabelGrid>();
  grid->voxel_size.setConstant(1);
  grid->voxels = {6, 6, 6};
  grid->labels.assign(216, LabelGrid::fluid);
  std::fill_n(grid->labels.begin(), 36, LabelGrid::solid);
  parameters.label_grid.grid = grid;
  parameters.label_grid.attraction = 20;
  EXPECT_TRUE(holds(refusal([&] { Simulation(parameters, ContactAngleCurve::lan2016()); }),
                    "pairs: no law for oil and wall, allowed"));
  parameters.mixture.pairs.push_back({"oil", "wall", {20, 0, 3}});
  EXPECT_NO_THROW(Simulation(parameters, ContactAngleCurve::lan2016()));
}

TEST(Notices, TellThatARepulsionThatDiffersHasNoPotential) {
  Parameters parameters = oil_bath();
  EXPECT_TRUE(notices(parameters).empty());
  parameters.mixture.pairs[1].coefficients.repulsion = 20;  // of the wall, which counts in no density
  EXPECT_TRUE(notices(parameters).empty());
  parameters.mixture.pairs[0].coefficients.repulsion = 20;
  ASSERT_EQ(notices(parameters).size(), 1u);
  EXPECT_TRUE(holds(notices(parameters)[0], "has no potential (Warren 2013)"));
}

}  // namespace
}  // namespace dmf::engine
