// Every kernel against forces summed over all pairs in double precision, with no list, no cells, no lanes:
// only the formulas are shared, and those have tests of their own.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>
#include <cstring>

#include "engine/kernels/lanes-inl.h"
#include "engine/noise-inl.h"
#include "engine/pair_law-inl.h"
#include "engine/simulation.h"
#include "systems.h"

namespace dmf::engine {
namespace {

struct Exact {
  std::vector<double> density, density_scale;
  std::vector<Vector3d> force, conservative, random, friction;
  std::vector<double>
      scale;  ///< sum of the absolute values of all contributions: what rounding is relative to
};

std::uint32_t bits(float value) {
  std::uint32_t result;
  std::memcpy(&result, &value, sizeof result);
  return result;
}

Vector3d apart(const Domain& domain, const Record& a, const Record& b) {
  Vector3d d(double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z);
  for (int axis = 0; axis < 3; ++axis)
    if (domain.periodic(axis)) d[axis] -= domain.size()[axis] * std::nearbyint(d[axis] / domain.size()[axis]);
  return d;
}

Exact sum_over_all_pairs(const System& system, const PlaneWall& wall) {
  const Beads& beads = system.beads;
  const MdpdLaw<double> law = liquid_law(system.parameters.liquid, system.parameters.time_step);
  const double r_d = system.parameters.liquid.repulsion_radius;
  const auto velocity = [&](std::size_t i) {
    return Vector3d(beads.predicted[i].x, beads.predicted[i].y, beads.predicted[i].z);
  };
  Exact exact;
  for (std::size_t i = 0; i < beads.size(); ++i) {
    double density = 0;
    for (std::size_t j = 0; j < beads.size(); ++j)
      if (j != i)
        density += HWY_NAMESPACE::density_weight(
            apart(system.parameters.domain, beads.position[i], beads.position[j]).norm(), 1 / r_d);
    exact.density.push_back(density * density_normalization(r_d));
  }
  for (std::size_t i = 0; i < beads.size(); ++i) {
    Vector3d total = Vector3d::Zero(), conservative = total, random = total, friction = total;
    double scale = 0;
    const auto add = [&](const Vector3d& d, double attraction, double density_sum, const Vector3d& parting,
                         double zeta) {
      const double r = d.norm();
      if (r >= 1) return;
      const double approach = parting.dot(d) / r;
      total += HWY_NAMESPACE::mdpd_force(law, attraction, r, density_sum, approach, zeta) / r * d;
      const double weight = 1 - r;
      conservative += HWY_NAMESPACE::conservative_force(law, attraction, r, density_sum) / r * d;
      random += law.random_amplitude * weight * zeta / r * d;
      friction -= law.friction * weight * weight * approach / r * d;
      scale += std::abs(attraction) + law.repulsion * density_sum + std::abs(law.random_amplitude * zeta) +
               law.friction * std::abs(approach);
    };
    for (std::size_t j = 0; j < beads.size(); ++j)
      if (j != i)
        add(apart(system.parameters.domain, beads.position[i], beads.position[j]), law.attraction,
            exact.density[i] + exact.density[j], velocity(i) - velocity(j),
            HWY_NAMESPACE::pair_noise<double>(bits(beads.position[i].w), bits(beads.position[j].w)));
    for (std::size_t k = 0; k < wall.size(); ++k)
      add(apart(system.parameters.domain, beads.position[i], wall.beads()[k]), wall.beads()[k].w,
          exact.density[i], velocity(i),
          HWY_NAMESPACE::pair_noise<double>(bits(beads.position[i].w),
                                            HWY_NAMESPACE::wall_key(static_cast<std::uint32_t>(k))));
    exact.force.push_back(total);
    exact.conservative.push_back(conservative);
    exact.random.push_back(random);
    exact.friction.push_back(friction);
    exact.scale.push_back(scale);
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
    const PlaneWall wall = wall_of(system);
    Pairs pairs(system.parameters);
    const Forces forces(system.parameters, GetParam());
    pairs.rebuild(system.beads, wall);
    poison_behind(system.beads);
    forces.density(system.beads, wall, pairs);
    forces.force(system.beads, wall, pairs);
    const Exact exact = sum_over_all_pairs(system, wall);
    // A separation carries the rounding of coordinates up to 14 (2^-24 * 16 = 1e-6 absolute), which moves w
    // by 1/r_d of it: relative to the sum of absolute contributions a few 1e-6. 1e-5 leaves room for the
    // sums.
    for (std::size_t i = 0; i < system.beads.size(); ++i) {
      EXPECT_NEAR(system.beads.predicted[i].w, exact.density[i], 1e-5 * (10 + exact.density[i]))
          << "bead " << i;
      const Record& f = system.beads.force[i];
      EXPECT_LT((Vector3d(f.x, f.y, f.z) - exact.force[i]).norm(), 1e-5 * (1 + exact.scale[i]))
          << "bead " << i;
    }
  }
}

TEST_P(EveryKernel, GivesEachPartOfTheForceByItself) {
  for (System& system : all_systems()) {
    SCOPED_TRACE(system.name);
    const PlaneWall wall = wall_of(system);
    Pairs pairs(system.parameters);
    const Forces forces(system.parameters, GetParam());
    pairs.rebuild(system.beads, wall);
    poison_behind(system.beads);
    forces.density(system.beads, wall, pairs);
    const Exact exact = sum_over_all_pairs(system, wall);
    AlignedVector<Record> to;
    forces.force(PairForce::conservative, to, system.beads, wall, pairs);
    expect_close(to, exact.conservative, exact.scale, "conservative");
    forces.force(PairForce::random, to, system.beads, wall, pairs);
    expect_close(to, exact.random, exact.scale, "random");
    forces.force(PairForce::friction, to, system.beads, wall, pairs);
    expect_close(to, exact.friction, exact.scale, "friction");
  }
}

TEST_P(EveryKernel, ConservesMomentumAmongLiquidBeads) {
  for (System& system : all_systems()) {
    if (system.parameters.domain.has_wall()) continue;
    SCOPED_TRACE(system.name);
    const PlaneWall wall = wall_of(system);
    Pairs pairs(system.parameters);
    const Forces forces(system.parameters, GetParam());
    pairs.rebuild(system.beads, wall);
    poison_behind(system.beads);
    forces.density(system.beads, wall, pairs);
    forces.force(system.beads, wall, pairs);
    Vector3d total = Vector3d::Zero();
    double largest = 0;
    for (const Record& f : system.beads.force) {
      total += Vector3d(f.x, f.y, f.z);
      largest = std::max(largest, Vector3d(f.x, f.y, f.z).norm());
    }
    // Every pair force is antisymmetric to the last bit; only the sums round: sqrt(N) times 2^-23 of the
    // largest.
    EXPECT_LE(total.norm(),
              30 * largest * 1.2e-7 * std::sqrt(1.0 + static_cast<double>(system.beads.size())));
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
