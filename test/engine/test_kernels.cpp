// Every kernel against forces summed over all pairs in double precision, with no list, no cells, no lanes:
// only the formulas are shared, and those have tests of their own.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <string>

#include "engine/kernels/lanes-inl.h"
#include "engine/noise-inl.h"
#include "engine/pair_law-inl.h"
#include "engine/simulation.h"
#include "systems.h"

namespace dmf::engine {
namespace {

/// What the sums are over, one end of a pair: liquid, wall and microparticles alike.
struct End {
  Record at;
  Vector3d velocity = Vector3d::Zero();
  double density = 0;
  std::uint32_t key = 0;
  std::uint32_t species = 0;  ///< of liquid
};

/// Forces on the beads of one kind. `scale` is the sum of the absolute values of all contributions: what
/// rounding is relative to.
struct Exact {
  std::vector<double> density;
  std::vector<Vector3d> force, conservative, random, friction;
  std::vector<double> scale;
};

std::uint32_t bits(float value) {
  std::uint32_t result;
  std::memcpy(&result, &value, sizeof result);
  return result;
}

Vector3d apart(const Domain& domain, const Record& a, const Record& b) {
  return domain.nearest_image(Vector3d(double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z));
}

/// All ends of a system, with densities.
struct Ends {
  std::vector<End> liquid, wall, bodies;

  Ends(const System& system, const Sorted& sorted) : domain(system.parameters.domain) {
    const Beads& beads = system.beads;
    const BodyBeads& body_beads = sorted.bodies.beads();
    for (std::size_t i = 0; i < beads.size(); ++i) {
      const Record& v = beads.predicted[i];
      liquid.push_back(
          {beads.position[i], {v.x, v.y, v.z}, 0, bits(beads.position[i].w), beads.species_of(i)});
    }
    const BoundaryParameters& boundaries = system.parameters.boundaries;
    for (std::uint32_t k = 0; k < sorted.wall.size(); ++k) {
      const Record& at = sorted.wall.beads()[k];
      const bool lower = at.z <= domain.lower.z();
      const Eigen::Vector2d& along = lower ? boundaries.lower_velocity : boundaries.upper_velocity;
      wall.push_back({at, {along.x(), along.y(), 0}, 0, HWY_NAMESPACE::wall_key(k)});
    }
    for (std::uint32_t k = 0; k < body_beads.size(); ++k) {
      const Record& v = body_beads.moving[k];
      bodies.push_back({body_beads.position[k], {v.x, v.y, v.z}, 0, HWY_NAMESPACE::body_key(k)});
    }
    const double r_d = system.parameters.liquid.repulsion_radius;
    const double pi = std::acos(-1);
    // Of weights whose integrals over a disc or a sphere are 1.
    const double normalization =
        system.parameters.dimensions == 2 ? 6 / (pi * r_d * r_d) : 15 / (2 * pi * r_d * r_d * r_d);
    const auto count = [&](End& i, const std::vector<End>& others) {
      for (const End& j : others)
        if (&i != &j)
          i.density +=
              normalization * HWY_NAMESPACE::density_weight(apart(domain, i.at, j.at).norm(), 1 / r_d);
    };
    for (End& i : liquid) {
      count(i, liquid);
      count(i, bodies);
    }
    for (const Microparticle& particle : sorted.bodies.all()) {
      // Only the beads of its own body count.
      const std::vector<End> own(bodies.begin() + particle.first_bead,
                                 bodies.begin() + particle.first_bead + particle.bead_count());
      for (std::uint32_t k = 0; k < particle.bead_count(); ++k) {
        End& i = bodies[particle.first_bead + k];
        count(i, own);
        i.density -= normalization;  // itself, at distance 0
        count(i, liquid);
      }
    }
  }
  Domain domain;
};

/// Which law holds for the pair with an end.
using LawOf = std::function<const MdpdLaw<double>&(const End&)>;

/// Liu (18) to (20), piece by piece.
double spline_force(const SplineParameters& spline, double strength, double r) {
  const auto minus_slope = [r](double cutoff) {
    const double h = cutoff / 2, q = r / h;
    return q < 1 ? (3 * q - 2.25 * q * q) / h : q < 2 ? 0.75 * (2 - q) * (2 - q) / h : 0.0;
  };
  return strength * (spline.repulsion * minus_slope(spline.repulsion_radius) -
                     spline.attraction * minus_slope(spline.attraction_radius));
}

/// Adds the forces of `others` on one bead.
void add_forces(const Domain& domain, const LawOf& law_of, const End& i, const std::vector<End>& others,
                const std::function<double(const End&)>& attraction_of, std::size_t k, Exact& exact,
                const SplineParameters& spline = {}) {
  for (const End& j : others) {
    if (&i == &j) continue;
    const MdpdLaw<double>& law = law_of(j);
    const Vector3d d = apart(domain, i.at, j.at);
    const double r = d.norm();
    if (r >= law.range()) continue;
    const double attraction = attraction_of(j), density_sum = i.density + j.density;
    const double approach = (i.velocity - j.velocity).dot(d) / r;
    const double zeta = HWY_NAMESPACE::pair_noise<double>(i.key, j.key);
    // w_R = (1 - r/r_D)^(s/2)
    const double weight =
        std::pow(std::max(0.0, 1 - r * law.inverse_dissipation_radius), law.twice_dissipation_exponent / 4.0);
    const double conservative = spline.used ? spline_force(spline, attraction, r)
                                : r < 1 ? HWY_NAMESPACE::conservative_force(law, attraction, r, density_sum)
                                        : 0.0;
    const double random = law.random_amplitude * weight * zeta;
    const double friction = -law.friction * weight * weight * approach;
    exact.force[k] += (conservative + random + friction) / r * d;
    exact.conservative[k] += conservative / r * d;
    exact.random[k] += random / r * d;
    exact.friction[k] += friction / r * d;
    exact.scale[k] += std::abs(attraction) + law.repulsion * density_sum +
                      std::abs(law.random_amplitude * zeta) + law.friction * std::abs(approach);
  }
}

Exact nothing_yet(const std::vector<End>& of) {
  Exact exact;
  for (const End& end : of) exact.density.push_back(end.density);
  exact.force = exact.conservative = exact.random = exact.friction =
      std::vector<Vector3d>(of.size(), Vector3d::Zero());
  exact.scale.assign(of.size(), 0);
  return exact;
}

double own_attraction(const End& end) { return end.at.w; }

/// What the parameters say of two species, "wall" and "microparticle" being two.
MdpdLaw<double> law_between(const Parameters& parameters, const std::string& a, const std::string& b) {
  LiquidParameters liquid = parameters.liquid;
  const auto take = [&liquid](const PairCoefficients& law) {
    liquid.attraction = law.attraction;
    liquid.repulsion = law.repulsion;
    liquid.random_amplitude = law.random_amplitude;
  };
  for (const FurtherLiquid& one : parameters.mixture.liquids)
    if (a == one.name && b == one.name) take(one.own);
  for (const PairOfSpecies& pair : parameters.mixture.pairs)
    if ((pair.first == a && pair.second == b) || (pair.first == b && pair.second == a))
      take(pair.coefficients);
  return liquid_law(liquid, parameters.time_step);
}

std::vector<std::string> names_of_liquids(const Parameters& parameters) {
  std::vector<std::string> names{"liquid"};
  for (const FurtherLiquid& liquid : parameters.mixture.liquids) names.push_back(liquid.name);
  return names;
}

/// Of a liquid with microparticles, and whether it sees the attraction of each.
struct LawWithMicroparticles {
  MdpdLaw<double> law;
  bool of_each;
  double attraction(double own) const { return of_each ? own : law.attraction; }
};

/// Only the "oil" of mix() has a law of its own.
std::vector<LawWithMicroparticles> laws_with_microparticles(const Parameters& parameters) {
  std::vector<LawWithMicroparticles> laws;
  for (const std::string& name : names_of_liquids(parameters)) {
    MdpdLaw<double> law = liquid_law(parameters.liquid, parameters.time_step);
    law.repulsion = parameters.microparticles.liquid_repulsion;
    const bool alike = name == "oil";
    laws.push_back({alike ? law_between(parameters, name, "microparticle") : law, !alike});
  }
  return laws;
}

Exact sum_over_all_pairs(const System& system, const Sorted& sorted) {
  const Ends ends(system, sorted);
  const Parameters& parameters = system.parameters;
  const std::vector<LawWithMicroparticles> body_laws = laws_with_microparticles(parameters);
  const std::vector<std::string> names = names_of_liquids(parameters);
  std::vector<std::vector<MdpdLaw<double>>> laws(names.size());
  for (std::size_t a = 0; a < names.size(); ++a)
    for (std::size_t b = 0; b < names.size(); ++b)
      laws[a].push_back(law_between(parameters, names[a], names[b]));
  Exact exact = nothing_yet(ends.liquid);
  for (std::size_t i = 0; i < ends.liquid.size(); ++i) {
    const End& bead = ends.liquid[i];
    const auto law_with = [&](const End& j) -> const MdpdLaw<double>& {
      return laws[bead.species][j.species];
    };
    add_forces(
        ends.domain, law_with, bead, ends.liquid, [&](const End& j) { return law_with(j).attraction; }, i,
        exact, parameters.spline);
    const MdpdLaw<double> wall_law = law_between(parameters, names[bead.species], "wall");
    add_forces(
        ends.domain, [&](const End&) -> const MdpdLaw<double>& { return wall_law; }, bead, ends.wall,
        [&](const End& j) { return bead.species == 0 ? own_attraction(j) : wall_law.attraction; }, i, exact,
        parameters.spline);
    const LawWithMicroparticles& body_law = body_laws[bead.species];
    add_forces(
        ends.domain, [&](const End&) -> const MdpdLaw<double>& { return body_law.law; }, bead, ends.bodies,
        [&](const End& j) { return body_law.attraction(own_attraction(j)); }, i, exact);
  }
  return exact;
}

/// Forces of liquid and of wall on the beads of microparticles.
struct ExactOnBodies {
  Exact of_liquid, of_wall;
};

ExactOnBodies sum_over_all_body_pairs(const System& system, const Sorted& sorted) {
  const Ends ends(system, sorted);
  const MicroparticleParameters& model = system.parameters.microparticles;
  const std::vector<LawWithMicroparticles> laws = laws_with_microparticles(system.parameters);
  MdpdLaw<double> adhesion = laws[0].law;
  adhesion.repulsion = adhesion.friction = adhesion.random_amplitude = 0;
  ExactOnBodies exact{nothing_yet(ends.bodies), nothing_yet(ends.bodies)};
  for (std::size_t i = 0; i < ends.bodies.size(); ++i) {
    const End& bead = ends.bodies[i];
    add_forces(
        ends.domain, [&](const End& j) -> const MdpdLaw<double>& { return laws[j.species].law; }, bead,
        ends.liquid, [&](const End& j) { return laws[j.species].attraction(own_attraction(bead)); }, i,
        exact.of_liquid);
    add_forces(
        ends.domain, [&](const End&) -> const MdpdLaw<double>& { return adhesion; }, bead, ends.wall,
        [&](const End&) { return model.wall_attraction; }, i, exact.of_wall);
  }
  return exact;
}

/// Scatter stands for the rounding that AgreesWithTheSumOverAllPairs argues.
void expect_close(const AlignedVector<Record>& computed, const std::vector<Vector3d>& exact,
                  const std::vector<double>& scale, const char* what) {
  ASSERT_EQ(computed.size(), exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i)
    EXPECT_LT((Vector3d(computed[i].x, computed[i].y, computed[i].z) - exact[i]).norm(),
              1e-5 * (1 + scale[i]))
        << what << ", bead " << i;
}

class EveryKernel : public testing::TestWithParam<std::string> {};

TEST_P(EveryKernel, AgreesWithTheSumOverAllPairs) {
  for (System& system : all_systems()) {
    SCOPED_TRACE(system.name);
    Sorted sorted(system, GetParam());
    sorted.forces.density(system.beads, sorted.wall, sorted.bodies, sorted.pairs);
    sorted.forces.force(system.beads, sorted.wall, sorted.bodies, sorted.pairs);
    const Exact exact = sum_over_all_pairs(system, sorted);
    // A separation carries the rounding of coordinates up to 14 (2^-24 * 16 = 1e-6 absolute), which moves w
    // by 1/r_d of it: relative to the sum of absolute contributions a few 1e-6. 1e-5 leaves room for the
    // sums.
    for (std::size_t i = 0; i < system.beads.size(); ++i)
      EXPECT_NEAR(system.beads.predicted[i].w, exact.density[i], 1e-5 * (10 + exact.density[i]))
          << "bead " << i;
    expect_close(system.beads.force, exact.force, exact.scale, "on liquid");
    const ExactOnBodies on_bodies = sum_over_all_body_pairs(system, sorted);
    const BodyBeads& bodies = sorted.bodies.beads();
    for (std::size_t i = 0; i < bodies.size(); ++i)
      EXPECT_NEAR(bodies.moving[i].w, on_bodies.of_liquid.density[i],
                  1e-5 * (10 + on_bodies.of_liquid.density[i]))
          << "bead " << i << " of microparticles";
    expect_close(bodies.liquid_force, on_bodies.of_liquid.force, on_bodies.of_liquid.scale,
                 "of liquid on microparticles");
    expect_close(bodies.wall_force, on_bodies.of_wall.conservative, on_bodies.of_wall.scale,
                 "of the wall on microparticles");
  }
}

/// Puts two more liquids beside the first one that differ from it in nothing but the name.
void mix_with_itself(System& system) {
  const LiquidParameters& liquid = system.parameters.liquid;
  const PairCoefficients same{liquid.attraction, liquid.repulsion, liquid.random_amplitude};
  MixtureParameters& mixture = system.parameters.mixture;
  for (FurtherLiquid& further : mixture.liquids) further.own = same;
  for (PairOfSpecies& pair : mixture.pairs) pair.coefficients = same;
}

TEST_P(EveryKernel, GivesAMixtureOfOneAndTheSameLiquidTheForcesOfThatLiquidToTheBit) {
  for (System& system : all_systems()) {
    // Over a wall the first liquid sees the wettability of each bead, the others one number.
    if (system.parameters.domain.has_wall() || system.parameters.mixture.liquids.empty() ||
        system.parameters.spline.used)
      continue;
    SCOPED_TRACE(system.name);
    mix_with_itself(system);
    System plain = system;
    plain.parameters.mixture = {};
    const auto forces_of = [](System& one) {
      Sorted sorted(one, GetParam());
      sorted.forces.density(one.beads, sorted.wall, sorted.bodies, sorted.pairs);
      sorted.forces.force(one.beads, sorted.wall, sorted.bodies, sorted.pairs);
      return one.beads.force;
    };
    // The keys that the mixture reads its species from make the same noise in both.
    const AlignedVector<Record> mixed = forces_of(system), alone = forces_of(plain);
    ASSERT_EQ(mixed.size(), alone.size());
    for (std::size_t i = 0; i < mixed.size(); ++i)
      EXPECT_EQ(std::memcmp(&mixed[i], &alone[i], sizeof mixed[i]), 0) << "bead " << i;
  }
}

TEST_P(EveryKernel, GivesEachPartOfTheForceByItself) {
  for (System& system : all_systems()) {
    SCOPED_TRACE(system.name);
    Sorted sorted(system, GetParam());
    sorted.forces.density(system.beads, sorted.wall, sorted.bodies, sorted.pairs);
    const Exact exact = sum_over_all_pairs(system, sorted);
    AlignedVector<Record> to;
    const auto compute = [&](PairForce part) {
      sorted.forces.force(part, to, system.beads, sorted.wall, sorted.bodies, sorted.pairs);
    };
    compute(PairForce::conservative);
    expect_close(to, exact.conservative, exact.scale, "conservative");
    compute(PairForce::random);
    expect_close(to, exact.random, exact.scale, "random");
    compute(PairForce::friction);
    expect_close(to, exact.friction, exact.scale, "friction");
  }
}

TEST_P(EveryKernel, ConservesMomentumAmongLiquidAndMicroparticles) {
  for (System& system : all_systems()) {
    if (system.parameters.domain.has_wall()) continue;
    SCOPED_TRACE(system.name);
    Sorted sorted(system, GetParam());
    sorted.forces.density(system.beads, sorted.wall, sorted.bodies, sorted.pairs);
    sorted.forces.force(system.beads, sorted.wall, sorted.bodies, sorted.pairs);
    Vector3d total = Vector3d::Zero();
    double largest = 0;
    std::size_t count = 0;
    for (const AlignedVector<Record>* forces : {&system.beads.force, &sorted.bodies.beads().liquid_force})
      for (const Record& f : *forces) {
        total += Vector3d(f.x, f.y, f.z);
        largest = std::max(largest, Vector3d(f.x, f.y, f.z).norm());
        ++count;
      }
    // Every pair force is antisymmetric to the last bit; only the sums round: sqrt(N) times 2^-23 of the
    // largest.
    EXPECT_LE(total.norm(), 30 * largest * 1.2e-7 * std::sqrt(1.0 + static_cast<double>(count)));
  }
}

TEST_P(EveryKernel, SaysWhichRan) {
  const Simulation simulation(periodic_box(5), ContactAngleCurve::lan2016(), {1, GetParam()});
  EXPECT_EQ(simulation.kernel(), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Kernels, EveryKernel, testing::ValuesIn(available_kernels()),
                         [](const auto& info) { return info.param; });

TEST(Kernel, UnknownNameIsRefusedWithTheKnownOnes) {
  try {
    Simulation(periodic_box(5), ContactAngleCurve::lan2016(), {1, "cuda"});
    FAIL();
  } catch (const InvalidInput& problem) {
    EXPECT_NE(std::string(problem.what()).find("cuda"), std::string::npos);
    EXPECT_NE(std::string(problem.what()).find("reference"), std::string::npos);
  }
}

}  // namespace
}  // namespace dmf::engine
