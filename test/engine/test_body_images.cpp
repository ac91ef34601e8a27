// Images of microparticles, chains and droplets: beyond sides that are sheared (Lees and Edwards), and behind
// symmetric sides.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "engine/bodies/contact.h"
#include "engine/bonds/mesh.h"
#include "engine/simulation.h"
#include "systems.h"

namespace dmf::engine {
namespace {

Vector3d vector_of(const Record& record) { return {record.x, record.y, record.z}; }

Record record_of(const Vector3d& v, float w) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), w};
}

/// A liquid and microparticles in it, whose forces are computed once.
class Forced {
 public:
  /// @param velocity  of the beads of microparticles, by index.
  /// @param prepare   what remains to be done before the forces.
  Forced(
      System system, double time, const std::function<Vector3d(std::size_t)>& velocity,
      const std::function<void(BodyBeads&)>& prepare = [](BodyBeads&) {})
      : system_(std::move(system)), wall_(wall_of(system_)), bodies_(system_.parameters) {
    for (const MicroparticlePlacement& placement : system_.microparticles) bodies_.add(placement, {});
    for (std::size_t k = 0; k < bodies_.beads().size(); ++k)
      bodies_.beads().moving[k] = record_of(velocity(k), 0);
    Pairs pairs(system_.parameters);
    const Forces forces(system_.parameters, "auto");
    pairs.ghosts().advance(time, 0);
    bodies_.set_images(pairs.ghosts().images());
    pairs.set_protrusion(bodies_.largest_bounding_radius());
    pairs.rebuild(system_.beads, wall_);
    bodies_.note_listed();
    prepare(bodies_.beads());
    pairs.find_bodies(bodies_, system_.beads, wall_);
    poison_behind(system_.beads, bodies_.beads());
    forces.density(system_.beads, wall_, bodies_, pairs);
    forces.force(system_.beads, wall_, bodies_, pairs);
    bodies_.finish({});
  }

  std::vector<Vector3d> liquid_by_id() const {
    std::vector<Vector3d> forces(system_.beads.size());
    for (std::size_t i = 0; i < forces.size(); ++i)
      forces[system_.beads.id[i]] = vector_of(system_.beads.force[i]);
    return forces;
  }
  const std::vector<Microparticle>& bodies() const { return bodies_.all(); }

 private:
  System system_;
  Walls wall_;
  Microparticles bodies_;
};

/// A velocity for a bead of a microparticle, whatever system it is in.
Vector3d velocity_of(std::size_t bead) {
  const auto k = static_cast<std::uint32_t>(bead);
  return {2 * scatter(3 * k) - 1, 2 * scatter(3 * k + 1) - 1, 2 * scatter(3 * k + 2) - 1};
}

Parameters sheared_box(double rate) {
  Parameters parameters = periodic_box(9);
  parameters.domain.upper = {9, 8, 10};
  parameters.boundaries.shear_rate = rate;
  parameters.watchdog.evaporation = 1;
  parameters.watchdog.highest_temperature = 100;
  return parameters;
}

/// Liquid around a microparticle, all of it `raised` and as much faster as the flow is there.
System sheared_system(const MicroparticlePlacement& placement, double raised) {
  const double rate = 0.6;
  System system{"sheared", sheared_box(rate), {}};
  const Domain& domain = system.parameters.domain;
  const Vector3d centre(placement.center.x(), placement.center.y(), *placement.z);
  scatter_beads(system, 6, domain.lower, domain.upper, [&](const Vector3d& p) {
    // Where no side is near: what moves past there is not the same liquid as here.
    return (p - centre).norm() > 1.3 && std::abs(p.z() - 5) < 4;
  });
  for (AlignedVector<Record>* array : {&system.beads.velocity, &system.beads.predicted})
    for (Record& velocity : *array) velocity.x += static_cast<float>(rate * raised);
  for (Record& place : system.beads.position) place.z += static_cast<float>(raised);
  system.microparticles = {placement};
  *system.microparticles[0].z += raised;
  return system;
}

TEST(ShearedSides, DoToAMicroparticleWhatTheMiddleDoes) {
  // The same system, higher up and as much faster as the flow is there: nothing may tell where the sides are.
  MicroparticlePlacement shell = sphere_at({0.4, 4}, 4.7), smooth = shell;
  smooth.smooth = true;
  for (const MicroparticlePlacement& placement : {shell, smooth})
    for (const double raised : {4.0, 5.0, 5.8}) {
      const double time = 2.3;
      const auto moving = [&](double by) {
        return [by](std::size_t bead) -> Vector3d { return velocity_of(bead) + Vector3d(0.6 * by, 0, 0); };
      };
      const Forced middle(sheared_system(placement, 0), time, moving(0));
      const Forced side(sheared_system(placement, raised), time, moving(raised));
      const std::vector<Vector3d> there = middle.liquid_by_id(), here = side.liquid_by_id();
      double largest = 0;
      for (std::size_t id = 0; id < there.size(); ++id) {
        EXPECT_LT((here[id] - there[id]).norm(), 2e-5 * (there[id].norm() + 1000)) << raised << ", " << id;
        largest = std::max(largest, there[id].norm());
      }
      EXPECT_GT(largest, 100);
      const Microparticle &one = middle.bodies()[0], &other = side.bodies()[0];
      EXPECT_GT(one.force.norm(), 10);
      EXPECT_LT((other.force - one.force).norm(), 2e-3 * (one.force.norm() + 100)) << raised;
      EXPECT_LT((other.torque - one.torque).norm(), 2e-3 * (one.torque.norm() + 100)) << raised;
      // It stands where the image that is in the box stands, and moves as that does.
      EXPECT_NEAR(other.body.position.z(), std::fmod(4.7 + raised, 10), 1e-9);
      EXPECT_NEAR(other.body.velocity.x(), 4.7 + raised > 10 ? -6 : 0, 0.1);
    }
}

TEST(ShearedSides, TwoMicroparticlesTouchAcrossThem) {
  const auto force = [](double raised) {
    Parameters parameters = sheared_box(0.6);
    parameters.microparticles.particle_adhesion = 100;
    Microparticles bodies(parameters);
    const ShearedDomain images{parameters.domain, 0.6 * 10 * 0.7, 6};
    bodies.set_images(images);
    for (const Vector3d& at : {Vector3d(8.5, 4, 4.2), Vector3d(9.1, 5, 5.86)}) {
      const Vector3d there = at + Vector3d(0, 0, raised);
      const Vector3d inside = there + images.shift_into(there);
      bodies.add(sphere_at(inside.head<2>(), inside.z()), {});
    }
    bodies.finish({});
    EXPECT_LT((bodies.all()[0].force + bodies.all()[1].force).norm(), 1e-9);
    return bodies.all()[1].force;
  };
  // Adhesion of 100 at contact, none at a gap of 0.1.
  const double gap = Vector3d(0.6, 1, 1.66).norm() - 2;
  EXPECT_NEAR(force(0).norm(), 100 * (1 - gap / 0.1), 1e-6);
  EXPECT_LT((force(5) - force(0)).norm(), 1e-6);
}

TEST(ShearedSides, AMicroparticleTurnsHalfAsFastAsTheFlowIsSheared) {
  // Einstein (1906): without torque, by half the vorticity. Inertia takes 0.15 Re^1.5 of it (Lin, Peery and
  // Schowalter 1970), 1 % at Re = rate R^2 rho / eta = 0.18.
  const double rate = 0.25;
  Parameters parameters = sheared_box(rate);
  parameters.domain.upper = {8, 7, 8};
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.add_microparticle(sphere_at({4, 3.5}, 4.0));
  simulation.fill({parameters.domain.lower, parameters.domain.upper});
  for (int k = 0; k < 2000; ++k) simulation.step();
  double turned = 0;
  const int steps = 12000;
  for (int k = 0; k < steps; ++k) {
    simulation.step();
    if (k % 10 != 0) continue;
    turned += simulation.observe()->microparticles[0].angular_velocity.y() / (steps / 10);
  }
  // Thermal motion turns it with D = k_BT / (8 pi eta R^3) = 0.005, by 1.1 in 120 tau: 0.009 a tau.
  EXPECT_NEAR(turned, 0.5 * rate, 0.03);
  RecordProperty("turned", std::to_string(turned));
}

TEST(ShearedSides, ADropletThatTakesUpAMicroparticleAcrossThemIsOneDroplet) {
  // Both at rest, in the middle and `raised`: the second run is the first one seen from something that moves.
  Parameters parameters = sheared_box(0.3);
  parameters.domain.upper = {12, 11, 18};
  parameters.angle_window = 0;
  const auto snapshot_of = [&](double raised) {
    Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
    for (int k = 0; k < 170; ++k) simulation.step();  // nothing is there yet but images that move on
    simulation.add_droplet({{6, 5, 10.5 + raised}, 3});
    MicroparticlePlacement placement = sphere_at({6.3, 5}, 5.95 + raised);
    placement.attraction = -19.5;
    simulation.add_microparticle(placement);
    for (int k = 0; k < 250; ++k) simulation.step();
    return simulation.observe();
  };
  const auto middle = snapshot_of(0), across = snapshot_of(11.5);
  ASSERT_EQ(across->droplets.size(), 1u);
  const DropletObservation &there = middle->droplets[0], &here = across->droplets[0];
  EXPECT_EQ(here.beads, there.beads);
  EXPECT_NEAR(here.centroid.z() - there.centroid.z(), 11.5 - 18, 0.01);
  EXPECT_LT(((here.upper - here.lower) - (there.upper - there.lower)).norm(), 0.05);
  const MicroparticleObservation &lower = middle->microparticles[0], &upper = across->microparticles[0];
  EXPECT_EQ(lower.droplet, there.id);
  EXPECT_EQ(upper.droplet, here.id);
  EXPECT_NEAR(upper.immersion, lower.immersion, 0.03);
  EXPECT_GT((lower.position - Vector3d(6.3, 5, 5.95)).norm(), 0.01);
  EXPECT_NEAR(upper.position.z(), lower.position.z() + 11.5, 0.005);
  EXPECT_GT(lower.drive_force.norm(), 10);
  EXPECT_LT((upper.drive_force - lower.drive_force).norm(), 0.05 * lower.drive_force.norm());
}

/// A chain without a liquid, `raised` in a box whose sides have been sheared for a while.
ChainObservation chain_at(double raised, int steps) {
  Parameters parameters = sheared_box(0.6);
  parameters.liquid.random_amplitude = 0;
  parameters.liquid.attraction = -1;  // its beads must not fall into each other
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  for (int k = 0; k < 230; ++k) simulation.step();
  ChainPlacement chain;
  chain.spring = {SpringKind::harmonic, 20, 0.7};
  for (int k = 0; k < 12; ++k) chain.points.emplace_back(8.6 + 0.1 * k, 4, 2 + 0.5 * k + raised);
  simulation.add_chains(chain);
  for (int k = 0; k < steps; ++k) simulation.step();
  return simulation.observe()->chains.at(0);
}

TEST(ShearedSides, AChainHangsTogetherAcrossThem) {
  EXPECT_NEAR(chain_at(4.6, 0).contour_length, 11 * std::hypot(0.1, 0.5), 1e-4);
  const ChainObservation still = chain_at(0, 100), across = chain_at(4.6, 100);
  EXPECT_GT(std::abs(still.contour_length - 11 * std::hypot(0.1, 0.5)), 0.1);  // it moves
  EXPECT_NEAR(across.contour_length, still.contour_length, 1e-3);
  EXPECT_LT((across.end_to_end - still.end_to_end).norm(), 1e-3);
  EXPECT_NEAR(across.energy, still.energy, 1e-2);
}

/// A spherical membrane without a liquid, likewise.
MembraneObservation membrane_at(double raised, int steps) {
  Parameters parameters = sheared_box(0.6);
  parameters.domain.upper = {14, 13, 15};
  parameters.liquid.random_amplitude = 0;
  parameters.liquid.attraction = -1;
  Simulation simulation(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
  for (int k = 0; k < 230; ++k) simulation.step();
  TriangleMesh mesh = icosphere(1);
  for (Vector3d& vertex : mesh.vertices) vertex = Vector3d(7, 6, 5 + raised) + 2.5 * vertex;
  simulation.add_membrane({std::make_shared<const TriangleMesh>(std::move(mesh)), {}});
  for (int k = 0; k < steps; ++k) simulation.step();
  return simulation.observe()->membranes.at(0);
}

TEST(ShearedSides, AMembraneIsClosedAcrossThem) {
  const MembraneObservation placed = membrane_at(0, 0), still = membrane_at(0, 150),
                            across = membrane_at(9.3, 150);
  EXPECT_GT((still.positions[0] - placed.positions[0]).norm(), 0.01);  // it moves
  EXPECT_NEAR(across.area, still.area, 1e-3 * still.area);
  EXPECT_NEAR(across.volume, still.volume, 1e-3 * still.volume);
  EXPECT_LT((across.gyration_radii - still.gyration_radii).norm(), 1e-3);
}

Parameters half_box() {
  Parameters parameters = periodic_box(9);
  parameters.domain.upper.z() = 6;
  parameters.domain.lower_side[2] = parameters.domain.upper_side[2] = Side::reflecting;
  parameters.boundaries.lower_reflection[2] = Reflection::symmetric;
  return parameters;
}

TEST(SymmetricSide, DoesToAMicroparticleWhatTheOtherHalfWould) {
  // A body of points, for a mirrored shell is no shell; then a smooth sphere, which looks alike in a mirror.
  MicroparticlePlacement body = sphere_at({4.5, 4.5}, 1.7), smooth = sphere_at({4.5, 4.5}, 1.2);
  body.radius = 0.5;
  for (std::uint32_t k = 0; k < 60; ++k)
    body.points.emplace_back(2 * scatter(900 + 3 * k) - 1, 2 * scatter(901 + 3 * k) - 1,
                             2 * scatter(902 + 3 * k) - 1.1);
  smooth.smooth = true;
  for (const MicroparticlePlacement& placement : {body, smooth}) {
    System half{"half", half_box(), {}};
    const Vector3d centre(4.5, 4.5, *placement.z);
    scatter_beads(half, 6, {0, 0, 0.02}, {9, 9, 6},
                  [&](const Vector3d& p) { return (p - centre).norm() > 1.15 && p.z() < 4.9; });
    half.microparticles = {placement};
    System whole{"whole", half.parameters, {}};
    whole.parameters.domain.lower.z() = -6;
    whole.parameters.boundaries = {};
    const std::uint32_t change =
        bead_key(step_key(half.parameters.seed, 0, Stream::mirror), 1) & ~std::uint32_t{7};
    const auto changed = [change](float word) {
      std::uint32_t key;
      std::memcpy(&key, &word, sizeof key);
      key ^= change;
      std::memcpy(&word, &key, sizeof key);
      return word;
    };
    const std::size_t count = half.beads.size();
    std::vector<double> heights;
    for (const Record& place : half.beads.position) heights.push_back(place.z);
    for (const double sign : {1.0, -1.0})
      for (std::size_t i = 0; i < count; ++i) {
        const Record &p = half.beads.position[i], &v = half.beads.predicted[i];
        add_bead(whole, {p.x, p.y, sign * p.z});
        whole.beads.predicted.back() = {v.x, v.y, static_cast<float>(sign) * v.z, 0};
        whole.beads.position.back().w = sign > 0 ? p.w : changed(p.w);
      }
    MicroparticlePlacement mirrored = placement;
    *mirrored.z = -*placement.z;
    for (Vector3d& point : mirrored.points) point.z() = -point.z();
    whole.microparticles = {placement, mirrored};
    // Points are sorted into patches: a bead's velocity must go by its place.
    const auto at_rest = [](std::size_t) -> Vector3d { return Vector3d::Zero(); };
    const auto turning = [&](bool with_image) {
      return [&, with_image](BodyBeads& beads) {
        for (std::size_t k = 0; k < beads.size(); ++k) {
          const Record& p = beads.position[k];
          const double height = std::abs(p.z);
          const Vector3d v(std::sin(5 * p.x + height), std::cos(3 * p.y - height), std::sin(7 * height));
          beads.moving[k] = {static_cast<float>(v.x()), static_cast<float>(v.y()),
                             static_cast<float>(p.z > 0 ? v.z() : -v.z()), 0};
        }
        if (!with_image) return;
        // Each mirrored bead is named after the one it mirrors.
        const std::size_t of_one = beads.size() / 2;
        for (std::size_t k = of_one; k < beads.size(); ++k)
          for (std::size_t j = 0; j < of_one; ++j) {
            const Record &p = beads.position[j], &q = beads.position[k];
            if (std::abs(p.x - q.x) + std::abs(p.y - q.y) + std::abs(p.z + q.z) < 1e-4f)
              beads.key[k] = beads.key[j] ^ change;
          }
      };
    };
    // A smooth sphere's noise goes by its index: it is compared without.
    if (placement.smooth)
      half.parameters.liquid.random_amplitude = whole.parameters.liquid.random_amplitude = 0;
    const Forced one(half, 0, at_rest, turning(false)), both(whole, 0, at_rest, turning(true));
    const std::vector<Vector3d> here = one.liquid_by_id(), there = both.liquid_by_id();
    for (std::size_t id = 0; id < count; ++id) {
      Vector3d difference = here[id] - there[id];
      // One that meets its own image straight below has a pair with one end, and another noise for it.
      if (!placement.smooth && heights[id] < 0.5) difference.z() = 0;
      EXPECT_LT(difference.norm(), 2e-5 * (there[id].norm() + 1000)) << id;
    }
    const Microparticle &seen = one.bodies()[0], &expected = both.bodies()[0];
    EXPECT_GT(expected.force.norm(), 10);
    EXPECT_LT((seen.force - expected.force).norm(), 2e-3 * (expected.force.norm() + 100));
    EXPECT_LT((seen.torque - expected.torque).norm(), 2e-3 * (expected.torque.norm() + 100));
  }
}

TEST(SymmetricSide, AMicroparticleTouchesItsMirrorImageAndNoOther) {
  Parameters parameters = half_box();
  parameters.microparticles.particle_adhesion = 30;
  Microparticles half(parameters);
  parameters.boundaries = {};
  parameters.domain.lower.z() = -6;
  Microparticles whole(parameters);
  const double height = 1 - 8e-4;
  for (Microparticles* bodies : {&half, &whole}) {
    bodies->add(sphere_at({3, 4}, height), {});
    bodies->add(sphere_at({5.02, 4}, 1.01), {});
  }
  MicroparticlePlacement below = sphere_at({3, 4}, -1.01);  // may not be placed in contact
  whole.add(below, {});
  whole.add(sphere_at({5.02, 4}, -1.01), {});
  half.finish({});
  whole.finish({});
  // Two spheres of radius 1 that are pressed 1.6e-3 into each other, less the adhesion. The whole system's
  // are 0.0092 apart there.
  const double own = hertz_force(1e6, 0.5, 1.6e-3) - 30;
  const double of_whole = -30 * (1 - 0.0092 / 0.1);
  EXPECT_NEAR(half.all()[0].force.z() - own, whole.all()[0].force.z() - of_whole, 0.3);
  EXPECT_NEAR(half.all()[0].force.x(), whole.all()[0].force.x(), 0.3);
  EXPECT_LT((half.all()[1].force - whole.all()[1].force).norm(), 0.3);
  EXPECT_GT(own, 1);
}

TEST(Ghosts, OfMicroparticlesLeaveTheSameBitsWhateverTheThreadsAndAfterARestart) {
  const auto hash_after = [](Simulation& simulation, int steps) {
    for (int k = 0; k < steps; ++k) simulation.step();
    return *simulation.observe({false, true})->state_hash;
  };
  for (Parameters parameters : {sheared_box(0.8), half_box()}) {
    parameters.watchdog.evaporation = 1;
    Simulation first(parameters, ContactAngleCurve::lan2016(), {1, "auto"});
    first.add_microparticle(sphere_at({4, 4}, 1.1));
    MicroparticlePlacement smooth = sphere_at({7, 4}, 1.2);
    smooth.smooth = true;
    first.add_microparticle(smooth);
    first.fill({parameters.domain.lower, parameters.domain.upper});
    hash_after(first, 37);
    const std::string saved = first.save_state();
    const std::uint64_t expected = hash_after(first, 37);
    Simulation second(parameters, ContactAngleCurve::lan2016(), {2, "auto"});
    second.load_state(saved);
    EXPECT_EQ(hash_after(second, 37), expected);
  }
}

}  // namespace
}  // namespace dmf::engine
