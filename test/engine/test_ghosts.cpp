// Images of beads: beyond sides that are sheared (Lees and Edwards), and behind symmetric sides.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "engine/kernels/lanes-inl.h"
#include "engine/noise-inl.h"
#include "engine/pair_law-inl.h"
#include "engine/simulation.h"
#include "systems.h"

namespace dmf::engine {
namespace {

void use_plain_dpd(Parameters& parameters) {
  parameters.liquid.attraction = 18.75;
  parameters.liquid.repulsion = 0;
  parameters.liquid.random_amplitude = 3;
  parameters.liquid.initial_density = parameters.liquid.bulk_density = 4;
  parameters.watchdog.evaporation = 1;
}

Parameters sheared_box(double rate) {
  Parameters parameters = periodic_box(5);
  parameters.domain.upper = {6, 5, 8};
  use_plain_dpd(parameters);
  parameters.boundaries.shear_rate = rate;
  return parameters;
}

Parameters half_box(bool symmetric_above) {
  Parameters parameters = periodic_box(5);
  parameters.domain.upper.z() = 6;
  parameters.domain.lower_side[2] = parameters.domain.upper_side[2] = Side::reflecting;
  parameters.boundaries.lower_reflection[2] = Reflection::symmetric;
  if (symmetric_above) parameters.boundaries.upper_reflection[2] = Reflection::symmetric;
  use_plain_dpd(parameters);
  return parameters;
}

std::uint32_t bits(float value) {
  std::uint32_t result;
  std::memcpy(&result, &value, sizeof result);
  return result;
}

Vector3d vector_of(const Record& record) { return {record.x, record.y, record.z}; }

TEST(ShearedSides, ForcesAreThoseOfAllImagesThatMovePast) {
  for (const double time : {0.0, 0.7, 3.1}) {
    System system{"sheared", sheared_box(0.6), {}};
    system.parameters.liquid.attraction = -40;
    system.parameters.liquid.repulsion = 25;
    const Vector3d size = system.parameters.domain.size();
    scatter_beads(system, 4, {0, 0, 0}, size, [](const Vector3d&) { return true; });
    const Walls wall = wall_of(system);
    Microparticles none(system.parameters);
    Pairs pairs(system.parameters);
    Forces forces(system.parameters, "auto");
    pairs.ghosts().advance(time, 0);
    pairs.rebuild(system.beads, wall);
    // The images go on a little before the cells are sorted anew.
    const double now = time + 0.02;
    pairs.ghosts().advance(now, 0);
    forces.density(system.beads, wall, none, pairs);
    forces.force(system.beads, wall, none, pairs);
    ASSERT_EQ(system.beads.position.size(), system.beads.size());

    const MdpdLaw<double> law = liquid_law(system.parameters.liquid, system.parameters.time_step);
    const double speed = 0.6 * size.z();
    const auto for_each_image = [&](std::size_t i, auto visit) {
      for (std::size_t j = 0; j < system.beads.size(); ++j)
        for (int nx = -3; nx <= 3; ++nx)
          for (int ny = -1; ny <= 1; ++ny)
            for (int nz = -1; nz <= 1; ++nz) {
              const Vector3d shift(nx * size.x() + nz * speed * now, ny * size.y(), nz * size.z());
              const Vector3d d =
                  vector_of(system.beads.position[i]) - vector_of(system.beads.position[j]) - shift;
              if (d.norm() < 1 && d.norm() > 1e-5) visit(j, d, nz * speed);
            }
    };
    std::vector<double> density(system.beads.size());
    for (std::size_t i = 0; i < density.size(); ++i)
      for_each_image(i, [&](std::size_t, const Vector3d& d, double) {
        density[i] += density_normalization(0.75) * HWY_NAMESPACE::density_weight(d.norm(), 1 / 0.75);
      });
    Vector3d total = Vector3d::Zero();
    for (std::size_t i = 0; i < density.size(); ++i) {
      Vector3d exact = Vector3d::Zero();
      double scale = 1;
      for_each_image(i, [&](std::size_t j, const Vector3d& d, double past) {
        const Vector3d between = vector_of(system.beads.predicted[i]) - vector_of(system.beads.predicted[j]) -
                                 Vector3d(past, 0, 0);
        const double r = d.norm();
        const double force =
            HWY_NAMESPACE::mdpd_force(law, law.attraction, r, density[i] + density[j], between.dot(d) / r,
                                      HWY_NAMESPACE::pair_noise<double>(bits(system.beads.position[i].w),
                                                                        bits(system.beads.position[j].w)));
        exact += force / r * d;
        scale += std::abs(law.attraction) + law.repulsion * (density[i] + density[j]) + 100;
      });
      EXPECT_LT((vector_of(system.beads.force[i]) - exact).norm(), 2e-5 * scale) << time << ", bead " << i;
      total += vector_of(system.beads.force[i]);
    }
    EXPECT_LT(total.norm(), 1e-2);  // of thousands of pairs, each some 100
  }
}

TEST(ShearedSides, MakeALinearProfileWithoutASeamAndTheViscosityOfTheChannel) {
  const double rate = 1;
  Simulation simulation(sheared_box(rate), ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.fill_box();
  const Vector3d size = simulation.parameters().domain.size();
  for (int k = 0; k < 3000; ++k) simulation.step();
  std::array<double, 8> beads{}, velocity{}, squares{};
  double stress = 0, looks = 0;
  for (int k = 0; k < 8000; ++k) {
    simulation.step();
    if (k % 10 != 0) continue;
    const auto snapshot = simulation.observe({true, false, true});
    stress -= (*snapshot->virial)(0, 2);
    for (std::size_t i = 0; i < snapshot->positions.size(); ++i) {
      const double z = snapshot->positions[i].z() - 8 * std::floor(snapshot->positions[i].z() / 8);
      const double periods = std::floor(snapshot->positions[i].z() / 8);
      const int slab = std::min(7, static_cast<int>(z));
      const Vector3d thermal =
          snapshot->velocities[i].cast<double>() - Vector3d(rate * (snapshot->positions[i].z() - 4), 0, 0);
      beads[slab] += 1;
      velocity[slab] += snapshot->velocities[i].x() - rate * 8 * periods;
      squares[slab] += thermal.squaredNorm() / 3;
      stress -= thermal.x() * thermal.z();
    }
    ++looks;
  }
  // Friction turns a stress of about 1 times the rate into heat and takes it away again: 1.08 / 4 a bead and
  // tau against 3 Gamma (k_BT - 1) with Gamma = gamma rho [w_D] / 3 = 2.5, so k_BT is about 1.04.
  double temperature = 0;
  for (int slab = 0; slab < 8; ++slab) temperature += squares[slab] / beads[slab] / 8;
  EXPECT_NEAR(temperature, 1.04, 0.04);
  for (int slab = 0; slab < 8; ++slab) {
    // 120 beads a slab, over 80 tau.
    EXPECT_NEAR(velocity[slab] / beads[slab], rate * (slab - 3.5), 0.06) << slab;
    EXPECT_NEAR(squares[slab] / beads[slab], temperature, 0.02) << slab;
    EXPECT_NEAR(beads[slab] / looks / 30, 4, 0.1) << slab;
  }
  // `dmf_study poiseuille` reads 1.08 from its parabola. The stress of 960 beads over 80 tau is good to 4 %.
  const double viscosity = stress / looks / size.prod() / rate;
  RecordProperty("viscosity", std::to_string(viscosity));
  EXPECT_NEAR(viscosity, 1.08, 0.1);
  EXPECT_NEAR(simulation.observe()->temperature, 1, 0.15);
}

TEST(SymmetricSide, ForcesAreThoseOfTheWholeSystemItIsHalfOf) {
  System half{"half", half_box(false), {}};
  scatter_beads(half, 4, {0, 0, 0}, {5, 5, 6}, [](const Vector3d&) { return true; });
  System whole{"whole", half.parameters, {}};
  whole.parameters.domain.lower.z() = -6;
  whole.parameters.boundaries = {};
  for (const double sign : {1.0, -1.0})
    for (std::size_t i = 0; i < half.beads.size(); ++i) {
      const Record &p = half.beads.position[i], &v = half.beads.predicted[i];
      add_bead(whole, {p.x, p.y, sign * p.z});
      whole.beads.predicted.back() = {v.x, v.y, static_cast<float>(sign) * v.z, 0};
    }
  for (const PairForce part : {PairForce::conservative, PairForce::friction}) {
    std::vector<std::vector<Record>> found;
    for (System* system : {&half, &whole}) {
      const Walls wall = wall_of(*system);
      Microparticles none(system->parameters);
      Pairs pairs(system->parameters);
      Forces forces(system->parameters, "auto");
      pairs.rebuild(system->beads, wall);
      forces.density(system->beads, wall, none, pairs);
      AlignedVector<Record> sums;
      forces.force(part, sums, system->beads, wall, none, pairs);
      std::vector<Record> by_id(system->beads.size());
      for (std::size_t i = 0; i < system->beads.size(); ++i) by_id[system->beads.id[i]] = sums[i];
      found.push_back(by_id);
    }
    for (std::size_t id = 0; id < found[0].size(); ++id)
      EXPECT_LT((vector_of(found[0][id]) - vector_of(found[1][id])).norm(), 2e-3) << id;
  }
}

TEST(SymmetricSide, LeavesDensityAndTemperatureAsTheyAreInTheMiddle) {
  for (const Integrator integrator : {Integrator::groot_warren, Integrator::baoab}) {
    Parameters parameters = half_box(true);
    parameters.integrator = integrator;
    Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
    simulation.fill_box();
    for (int k = 0; k < 500; ++k) simulation.step();
    std::array<double, 12> beads{}, normal{}, along{};
    int looks = 0;
    for (int k = 0; k < 4000; ++k) {
      simulation.step();
      if (k % 5 != 0) continue;
      const auto snapshot = simulation.observe({true});
      for (std::size_t i = 0; i < snapshot->positions.size(); ++i) {
        const int slab = std::clamp(static_cast<int>(2 * snapshot->positions[i].z()), 0, 11);
        beads[slab] += 1;
        normal[slab] += std::pow(snapshot->velocities[i].z(), 2);
        along[slab] += snapshot->velocities[i].head<2>().squaredNorm() / 2;
      }
      ++looks;
    }
    for (int slab = 0; slab < 12; ++slab) {
      EXPECT_NEAR(beads[slab] / looks / 12.5, 4, 0.25) << slab;
      EXPECT_NEAR(normal[slab] / beads[slab], 1, 0.05) << slab;
      EXPECT_NEAR(along[slab] / beads[slab], 1, 0.05) << slab;
    }
  }
}

TEST(Ghosts, LeaveTheSameBitsWhateverTheThreadsAndAfterARestart) {
  const auto hash_after = [](Simulation& simulation, int steps) {
    for (int k = 0; k < steps; ++k) simulation.step();
    return *simulation.observe({false, true})->state_hash;
  };
  for (const Parameters& parameters : {sheared_box(0.8), half_box(true)})
    for (const Integrator integrator : {Integrator::groot_warren, Integrator::baoab}) {
      Parameters with = parameters;
      with.integrator = integrator;
      Simulation first(with, ContactAngleCurve::lan2016(), {1, "auto"});
      first.fill_box();
      hash_after(first, 37);
      const std::string saved = first.save_state();
      const std::uint64_t expected = hash_after(first, 37);
      Simulation second(with, ContactAngleCurve::lan2016(), {2, "auto"});
      second.load_state(saved);
      EXPECT_EQ(hash_after(second, 37), expected);
    }
}

}  // namespace
}  // namespace dmf::engine
