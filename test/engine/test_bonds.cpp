// Springs and chains of moving beads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>

#include "engine/bonds/spring.h"
#include "engine/simulation.h"
#include "refusal.h"
#include "systems.h"

namespace dmf::engine {
namespace {

Spring harmonic(double stiffness, double length) {
  Spring spring;
  spring.kind = SpringKind::harmonic;
  spring.stiffness = stiffness;
  spring.length = length;
  return spring;
}
Spring wlc(double max_length, double persistence_length) {
  Spring spring;
  spring.kind = SpringKind::wlc;
  spring.max_length = max_length;
  spring.persistence_length = persistence_length;
  return spring;
}
Spring fene(double stiffness, double max_length) {
  Spring spring;
  spring.kind = SpringKind::fene;
  spring.stiffness = stiffness;
  spring.max_length = max_length;
  return spring;
}

/// A periodic box for beads that feel no potential but that of their bonds: friction and noise alone keep
/// their temperature, so that all static averages are those of the springs.
Parameters ideal_box(double size, Integrator integrator = Integrator::groot_warren) {
  Parameters parameters = periodic_box(size);
  parameters.liquid.attraction = parameters.liquid.repulsion = 0;
  parameters.liquid.random_amplitude = 3;
  parameters.integrator = integrator;
  parameters.watchdog.evaporation = 1;
  return parameters;
}

ChainPlacement chains_in(const Parameters& parameters, const Spring& spring, std::uint32_t count,
                         std::uint32_t beads) {
  ChainPlacement placement;
  placement.spring = spring;
  placement.count = count;
  placement.beads = beads;
  placement.bond_length = usual_bond_length(spring);
  placement.lower = parameters.domain.lower;
  placement.upper = parameters.domain.upper;
  return placement;
}

TEST(Springs, TensionIsTheSlopeOfTheEnergyAndSlopeThatOfTheTension) {
  for (const SpringLaw& law :
       {SpringLaw::of(harmonic(80, 0.5), 1), SpringLaw::of(wlc(1.2, 0.3), 1.5),
        SpringLaw::of(fene(40, 0.9), 1), SpringLaw::worm_like_with_repulsion(0.4, 50, 2.2)})
    for (const double r : {0.1, 0.4, 0.7, 0.85}) {
      const double h = 1e-5;
      EXPECT_NEAR(law.tension(r), (law.energy(r + h) - law.energy(r - h)) / (2 * h),
                  1e-6 * (1 + std::abs(law.tension(r))));
      EXPECT_NEAR(law.slope(r), (law.tension(r + h) - law.tension(r - h)) / (2 * h),
                  1e-6 * (1 + std::abs(law.slope(r))));
    }
}

TEST(Springs, PullAsLiuWritesThem) {
  // Eq. 26 at half the length: k_BT / (4 lambda) (4 + 2 - 1); eq. 27 there: H r / (3/4).
  EXPECT_NEAR(SpringLaw::of(wlc(2, 0.25), 1.5).tension(1), 1.5 / (4 * 0.25) * 5, 1e-12);
  EXPECT_NEAR(SpringLaw::of(fene(30, 2), 1).tension(1), 30 / 0.75, 1e-12);
  EXPECT_NEAR(SpringLaw::of(harmonic(30, 0.6), 1).tension(1), 12, 1e-12);
}

TEST(Springs, OfAMembraneAreAtRestWhereTheyShouldWithFedosovsShearModulus) {
  // Fedosov, Caswell, Karniadakis 2010, eq. 11 with m = 2, of a hexagonal net.
  const double rest = 0.45, stiffness = 70, ratio = 2.2;
  const SpringLaw law = SpringLaw::worm_like_with_repulsion(rest, stiffness, ratio);
  EXPECT_NEAR(law.tension(rest), 0, 1e-10);
  EXPECT_NEAR(law.rest_length(), rest, 1e-9);
  const double x = 1 / ratio, root3 = std::sqrt(3.0);
  const double modulus = root3 * law.stiffness / (law.length * x) *
                             (x / (2 * std::pow(1 - x, 3)) - 1 / (4 * std::pow(1 - x, 2)) + 0.25) +
                         root3 * 3 * law.repulsion / (4 * std::pow(rest, 3));
  EXPECT_NEAR(modulus, root3 / 4 * stiffness, 1e-9 * modulus);
}

/// Mean of g(r) over bonds in thermal equilibrium, r^2 exp(-U/k_BT), by quadrature.
double thermal_mean(const SpringLaw& law, double temperature, const std::function<double(double)>& weight,
                    const std::function<double(double)>& g) {
  const double longest = std::isfinite(law.max_length()) ? law.max_length() : law.length + 20;
  double sum = 0, all = 0;
  const int n = 200'000;
  for (int k = 0; k < n; ++k) {
    const double r = (k + 0.5) * longest / n;
    const double w = weight(r) * r * r * std::exp(-law.energy(r) / temperature);
    sum += g(r) * w;
    all += w;
  }
  return sum / all;
}

TEST(Chains, BondsOfEverySpringHaveTheirThermalLength) {
  for (const Spring& spring : {harmonic(60, 0.6), wlc(1.2, 0.1), fene(20, 1.1)})
    for (const Integrator integrator : {Integrator::groot_warren, Integrator::baoab}) {
      Parameters parameters = ideal_box(6, integrator);
      parameters.liquid.temperature = 1.3;
      Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
      simulation.add_chains(chains_in(parameters, spring, 330, 2));
      double square = 0, samples = 0;
      for (int k = 0; k < 4000; ++k) {
        simulation.step();
        if (k < 1000 || k % 20 != 0) continue;
        const auto snapshot = simulation.observe();
        for (const ChainObservation& chain : snapshot->chains) {
          square += chain.end_to_end.squaredNorm();
          ++samples;
        }
      }
      const SpringLaw law = SpringLaw::of(spring, parameters.liquid.temperature);
      const double expected = thermal_mean(
          law, parameters.liquid.temperature, [](double) { return 1.0; }, [](double r) { return r * r; });
      // 330 bonds over some 30 times of their memory: one part in a hundred, and the steps' own error.
      EXPECT_NEAR(square / samples / expected, 1, 0.03)
          << static_cast<int>(spring.kind) << ", integrator " << static_cast<int>(integrator);
    }
}

TEST(Chains, ThatArePulledReachAsFarAsTheirPartitionFunctionSays) {
  // Of one bond under the force f: <z> = <r L(f r)>, weighted with sinh(f r) / (f r), L(y) = coth y - 1/y.
  const Spring spring = wlc(1.5, 0.15);
  Parameters parameters = ideal_box(7);
  ChainPlacement placement = chains_in(parameters, spring, 100, 6);
  placement.stretching_force = {4, 0, 3};
  placement.bond_length = 0.9;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_chains(placement);
  double along = 0, samples = 0;
  for (int k = 0; k < 8000; ++k) {
    simulation.step();
    if (k < 3000 || k % 50 != 0) continue;
    const auto snapshot = simulation.observe();
    for (const ChainObservation& chain : snapshot->chains) {
      along += chain.end_to_end.dot(Vector3d(0.8, 0, 0.6)) / 5;
      ++samples;
    }
  }
  const double f = 5;
  const double expected = thermal_mean(
      SpringLaw::of(spring, 1), 1, [f](double r) { return std::sinh(f * r) / (f * r); },
      [f](double r) { return r * (1 / std::tanh(f * r) - 1 / (f * r)); });
  EXPECT_NEAR(along / samples / expected, 1, 0.02);
}

TEST(Chains, ThatAreIdealSpreadAsRandomWalks) {
  // <R^2> = (N - 1) <b^2>, <R_g^2> = <b^2> (N^2 - 1) / (6 N).
  const Spring spring = harmonic(60, 0.6);
  Parameters parameters = ideal_box(7);
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_chains(chains_in(parameters, spring, 150, 7));
  double square = 0, gyration = 0, samples = 0;
  for (int k = 0; k < 9000; ++k) {
    simulation.step();
    if (k < 1000 || k % 100 != 0) continue;
    const auto snapshot = simulation.observe();
    for (const ChainObservation& chain : snapshot->chains) {
      square += chain.end_to_end.squaredNorm();
      gyration += chain.radius_of_gyration * chain.radius_of_gyration;
      ++samples;
    }
  }
  const double bond = thermal_mean(
      SpringLaw::of(spring, 1), 1, [](double) { return 1.0; }, [](double r) { return r * r; });
  // 150 chains over some ten times of their memory: two parts in a hundred.
  EXPECT_NEAR(square / samples / (6 * bond), 1, 0.06);
  EXPECT_NEAR(gyration / samples / (bond * 48 / 42), 1, 0.05);
}

TEST(Chains, WithoutFrictionKeepTheirEnergyAndMomentum) {
  Parameters parameters = ideal_box(9);
  parameters.liquid.random_amplitude = 0;
  parameters.time_step = 0.002;
  // Of the thermal velocities only the relative ones are left, and it starts stretched.
  ChainPlacement placement = chains_in(parameters, wlc(1.5, 0.2), 1, 12);
  placement.bond_length = 0.9;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_chains(placement);
  const auto energy = [&] {
    const auto snapshot = simulation.observe();
    return 1.5 * 12 * snapshot->temperature + snapshot->chains.at(0).energy;
  };
  // The first half kick comes without forces.
  simulation.step();
  const double before = energy();
  double largest = 0;
  for (int k = 0; k < 3000; ++k) {
    simulation.step();
    largest = std::max(largest, std::abs(energy() - before));
  }
  EXPECT_LT(largest / before, 2e-3);
  EXPECT_LT(simulation.observe()->momentum.norm(), 1e-4);
}

TEST(Chains, TakeThePlacesOfLiquidBeads) {
  Parameters parameters = periodic_box(6);
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill_box();
  const auto before = simulation.observe();
  ChainPlacement placement = chains_in(parameters, harmonic(50, 0.5), 8, 5);
  EXPECT_EQ(simulation.add_chains(placement), 1u);
  const auto after = simulation.observe();
  EXPECT_EQ(after->moving_beads, before->moving_beads);
  EXPECT_EQ(after->momentum, before->momentum);
  EXPECT_NEAR(after->temperature, before->temperature, 1e-6);  // another order of the sum
  ASSERT_EQ(after->chains.size(), 8u);
  for (const ChainObservation& chain : after->chains) {
    EXPECT_NEAR(chain.contour_length, 4 * 0.5, 1e-5);
    EXPECT_NEAR(chain.longest_bond, 0.5, 1e-5);
  }
  EXPECT_EQ(simulation.add_chains(placement), 9u);
  EXPECT_EQ(simulation.observe()->moving_beads, before->moving_beads);
}

TEST(Chains, GoWithTheDropletTheyAreIn) {
  Parameters parameters = plate(16, 12);
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_droplet({{8, 8, 3}, 3});
  ChainPlacement placement;
  placement.spring = harmonic(50, 0.5);
  // Its tail stands out of the droplet.
  for (int k = 0; k < 9; ++k) placement.points.push_back({8 + 0.5 * k, 8, 4});
  simulation.add_chains(placement);
  simulation.step();
  simulation.remove_droplet(1);
  EXPECT_EQ(simulation.observe()->moving_beads, 0u);
  EXPECT_TRUE(simulation.observe()->chains.empty());
  for (int k = 0; k < 5; ++k) simulation.step();
}

TEST(Chains, AreTheSameWhateverTheThreadsAndGoOnFromASavedState) {
  Parameters parameters = periodic_box(6);
  const auto fresh = [&](int threads) {
    auto simulation =
        std::make_unique<Simulation>(parameters, ContactAngleCurve::lan2016(), Execution{threads, "auto"});
    simulation->fill_box();
    simulation->add_chains(chains_in(parameters, wlc(1.2, 0.2), 40, 6));
    return simulation;
  };
  const ObserveRequest hash{false, true};
  const auto one = fresh(1), three = fresh(3);
  for (int k = 0; k < 30; ++k) {
    one->step();
    three->step();
  }
  EXPECT_EQ(*one->observe(hash)->state_hash, *three->observe(hash)->state_hash);
  const auto other = fresh(2);
  other->load_state(one->save_state());
  EXPECT_EQ(*one->observe(hash)->state_hash, *other->observe(hash)->state_hash);
  for (int k = 0; k < 30; ++k) {
    one->step();
    other->step();
  }
  EXPECT_EQ(*one->observe(hash)->state_hash, *other->observe(hash)->state_hash);
  EXPECT_EQ(other->add_chains(chains_in(parameters, wlc(1.2, 0.2), 1, 6)), 41u);
}

TEST(Chains, CountInTheHashByWhoIsBoundToWhomAndHow) {
  Parameters parameters = periodic_box(6);
  const auto hash = [&](const Spring& spring, bool bound) {
    Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
    ChainPlacement placement;
    placement.spring = spring;
    placement.points = {{1, 1, 1}, {1.5, 1, 1}, {2, 1, 1}};
    simulation.add_chains(placement);
    if (bound) {
      placement.points = {{4, 4, 4}, {4.4, 4, 4}};
      simulation.add_chains(placement);
    }
    return *simulation.observe({false, true})->state_hash;
  };
  EXPECT_EQ(hash(harmonic(50, 0.5), false), hash(harmonic(50, 0.5), false));
  EXPECT_NE(hash(harmonic(50, 0.5), false), hash(harmonic(51, 0.5), false));
  EXPECT_NE(hash(harmonic(50, 0.5), false), hash(harmonic(50, 0.5), true));
}

TEST(Chains, ThatOverstretchStopTheRunWithBondBeadsAndLength) {
  Parameters parameters = ideal_box(12);
  ChainPlacement placement;
  placement.spring = fene(20, 1);
  placement.points = {{3, 3, 3}, {3.4, 3, 3}, {3.8, 3, 3}};
  placement.stretching_force = {2200, 0, 0};
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_chains(placement);
  std::string told;
  try {
    for (int k = 0; k < 50; ++k) simulation.step();
  } catch (const Instability& instability) {
    told = instability.what();
  }
  EXPECT_TRUE(holds(told, "of chain 1, of beads"));
  EXPECT_TRUE(holds(told, "allowed: less than 1;"));
  EXPECT_THROW(simulation.step(), Instability);
}

TEST(Chains, ThatCanNotBeAreRefusedWhole) {
  Parameters parameters = periodic_box(9);
  parameters.domain.lower_side[2] = parameters.domain.upper_side[2] = Side::reflecting;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  const auto refused = [&](auto change) {
    ChainPlacement placement = chains_in(parameters, wlc(1, 0.1), 2, 5);
    change(placement);
    const std::string text = refusal([&] { simulation.add_chains(placement); });
    EXPECT_EQ(simulation.observe()->moving_beads, 0u);
    return text;
  };
  EXPECT_TRUE(
      holds(refused([](auto& p) { p.bond_length = 1.1; }),
            "bond_length: 1.1, chain beads farther apart than the spring's maximum, allowed: less than 1"));
  EXPECT_TRUE(
      holds(refused([](auto& p) {
              p.count = 1;
              p.points = {{1, 1, 1}, {1.5, 1, 1}, {3, 1, 1}};
            }),
            "points[2]: 1.5 r_c from the one before, chain beads farther apart than the spring's maximum"));
  EXPECT_TRUE(holds(refused([](auto& p) {
                      p.count = 1;
                      p.points = {{1, 1, 8.8}, {1.5, 1, 9.1}};
                    }),
                    "points[1]: (1.5, 1, 9.1), allowed: within"));
  EXPECT_TRUE(holds(refused([](auto& p) { p.spring.persistence_length = 0; }),
                    "spring.persistence_length: 0, allowed: above 0"));
  EXPECT_TRUE(holds(refused([](auto& p) { p.beads = 1; }), "beads: 1, allowed: 2 to 100000"));
  EXPECT_TRUE(holds(refused([](auto& p) { p.upper.x() = 10; }), "box: (0, 0, 0) to (10, 9, 9), allowed:"));
  EXPECT_TRUE(holds(refused([](auto& p) {
                      p.spring = harmonic(50, 3.5);
                      p.bond_length = 3.5;
                    }),
                    "allowed: less than 3, a third of a periodic side"));
  EXPECT_TRUE(holds(refused([](auto& p) {
                      p.shape = ChainShape::straight;
                      p.beads = 30;
                      p.direction = {0, 0, 1};
                    }),
                    "find no room in the box"));
  // A spring too stiff for the time step: the number that is allowed works.
  const std::string stiff = refused([](auto& p) {
    p.spring = harmonic(40000, 0.5);
    p.bond_length = 0.5;
  });
  EXPECT_TRUE(holds(stiff, "too fast for time_step 0.01, allowed: a time_step of up to 0.00125"));
  parameters.time_step = 0.00125;
  Simulation finer(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  finer.add_chains(chains_in(parameters, harmonic(40000, 0.5), 2, 5));
}

TEST(SavedBonds, ThatAreForgedAreRefusedOrRun) {
  Parameters parameters = periodic_box(6);
  Simulation good(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  good.fill_box();
  good.add_chains(chains_in(parameters, wlc(1.2, 0.1), 3, 5));
  TriangleMesh mesh = icosphere(0);
  for (Vector3d& v : mesh.vertices) v += Vector3d(3, 3, 3);
  MembraneStiffness short_springs;
  short_springs.max_stretch = 1.5;
  good.add_membrane({std::make_shared<const TriangleMesh>(mesh), short_springs});
  good.step();
  const std::string state = good.save_state();
  // Chains and membranes stand at its end.
  const std::size_t of_chain = 4 + 4 + 4 * 8 + 3 * 8 + 8 + 5 * 4, of_membrane = 4 + 16 + 12 * 24 + 20 * 12;
  const std::size_t tail = 24 + 3 * of_chain + of_membrane + 4 + 1 + 7 * 8 + 8 + 12 * 4;
  std::uint32_t draw = 0;
  const auto below = [&draw](std::size_t n) {
    return static_cast<std::size_t>(scatter(draw++) * static_cast<double>(n));
  };
  int refused = 0, ran = 0;
  for (int k = 0; k < 1500; ++k) {
    std::string forged = state;
    const std::size_t at = forged.size() - 1 - below(tail);
    if (k % 3 == 0) {
      forged[at] = static_cast<char>(below(256));
    } else {
      const std::uint32_t evil[] = {0u, 1u, 2u, 0x7fc00000u, 0xffffffffu, 0x7ff80000u, 0x80000000u, 1u << 20};
      const std::uint32_t word = evil[below(8)];
      std::memcpy(&forged[std::min(at, forged.size() - 4)], &word, 4);
    }
    Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
    try {
      simulation.load_state(forged);
    } catch (const InvalidInput&) {
      ++refused;
      continue;
    }
    try {
      for (int step = 0; step < 2; ++step) simulation.step();
    } catch (const Instability&) {
    }
    simulation.observe({true, true});
    ++ran;
  }
  EXPECT_GT(refused, 500);
  EXPECT_GT(ran, 100);
  std::string short_one = state;
  short_one.resize(state.size() - 5);
  EXPECT_TRUE(holds(refusal([&] { good.load_state(short_one); }), "saved state: ends early"));
}

TEST(Chains, CountInMemory) {
  Parameters parameters = periodic_box(9);
  parameters.max_memory = 12;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  EXPECT_TRUE(
      holds(refusal([&] { simulation.add_chains(chains_in(parameters, harmonic(50, 0.5), 1000, 10)); }),
            "moving beads in all"));
  // Before so many places are worked out.
  EXPECT_TRUE(holds(
      refusal([&] { simulation.add_chains(chains_in(parameters, harmonic(50, 0.5), 1'000'000, 100'000)); }),
      "moving beads in all"));
}

}  // namespace
}  // namespace dmf::engine
