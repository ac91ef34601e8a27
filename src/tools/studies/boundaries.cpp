#include <fmt/format.h>

#include "tools/cases.h"
#include "tools/channel.h"
#include "tools/saved_run.h"

namespace dmf::tools {
namespace {

using engine::Reflection;

constexpr double speed = 1;  ///< of both sides of the scene, r_c / tau
constexpr int slabs = 10;    ///< 0.85 r_c each, the ranges of layers at a wall within one

/// In which no bead may get through a side.
double steps_of(const StudyOptions& options) { return options.quick ? 1500 : 100'000; }

struct Boundary {
  std::string label;
  Reflection reflection;
  bool of_beads;            ///< a wall of beads stands behind the side
  double lateral_friction;  ///< of frozen particles
  /// What leaves a diffuse wall knows nothing of the liquid for a mean free path of thermal velocity over
  /// friction, 1 / (gamma rho [w_D] / 3) = 0.4 r_c here: 0.09 of the half width, by kinetic theory of gases
  /// up to half as much again. What bounces back takes twice the momentum, and a wall's beads rub besides:
  /// less.
  Reference slip;
};

std::vector<Boundary> boundaries() {
  const Reference none{"1", "no friction"};
  return {{"bounce_back", Reflection::bounce_back, true, 0, {"0 to 0.09", "a mean free path at most"}},
          {"bounce_forward", Reflection::bounce_forward, true, 0, {"0 to 0.09", "a mean free path at most"}},
          {"maxwellian", Reflection::maxwellian, true, 0, {"0 to 0.13", "a mean free path at most"}},
          {"thin_layer", Reflection::thin_layer, true, 0, {"0 to 0.13", "a mean free path at most"}},
          {"specular", Reflection::specular, false, 0, none},
          {"symmetric", Reflection::symmetric, false, 0, none},
          {"frozen_particles", Reflection::frozen_particles, false, 0, none},
          {"frozen_particles_0.3", Reflection::frozen_particles, false, 0.3, {}},
          {"frozen_particles_6", Reflection::frozen_particles, false, 6, {}}};
}

ChannelRun shear_run(const Boundary& boundary, const StudyOptions& options, std::uint64_t seed) {
  ChannelRun run;
  run.scene = scene_for(options, "couette");
  engine::Parameters& parameters = run.scene.parameters;
  engine::BoundaryParameters& sides = parameters.boundaries;
  sides.lower_reflection[2] = sides.upper_reflection[2] = boundary.reflection;
  sides.frozen_particles.lateral_friction = boundary.lateral_friction;
  if (!boundary.of_beads)
    parameters.domain.lower_side[2] = parameters.domain.upper_side[2] = engine::Side::reflecting;
  // Mirror images don't move past the liquid, so what is dragged is nothing.
  if (boundary.reflection == Reflection::symmetric)
    sides.lower_velocity = sides.upper_velocity = Eigen::Vector2d::Zero();
  run.seed = seed;
  run.bins = slabs;
  // The slowest wave decays with rho h^2 / (pi^2 mu), some 7 tau.
  run.settle = options.quick ? 10 : 50;
  run.measure = steps_of(options) * parameters.time_step - run.settle;
  return run;
}

}  // namespace

Findings study_boundaries(const StudyOptions& options) {
  std::vector<Case> cases;
  for (const Boundary& boundary : boundaries())
    cases.push_back({boundary.label, [=](std::uint64_t seed) {
                       const ChannelProfile profile = run_channel(shear_run(boundary, options, seed));
                       const ShearFlow flow = shear_of(profile, speed);
                       return std::vector<double>{static_cast<double>(profile.most_outside), flow.slip,
                                                  flow.density, flow.temperature};
                     }});
  const Results results =
      run_cases("boundaries", {"most_outside", "slip", "density", "temperature"}, cases, options);
  Findings findings;
  for (const Boundary& boundary : boundaries()) {
    const std::string& label = boundary.label;
    findings.push_back(results
                           .finding(label, "most_outside",
                                    fmt::format("beads beyond a side in {:.0f} steps", steps_of(options)), 0)
                           .against_theory({"0", "none"}));
    findings.push_back(results.finding(label, "slip", "slip at the sides, of their velocity", 3)
                           .against_theory(boundary.slip)
                           .within_margin(0.02));
    Finding density =
        results.finding(label, "density", "density within 0.85 r_c of a side, of the middle's", 3);
    // Without beads or images behind the side nothing there is as the middle is.
    if (boundary.of_beads || boundary.reflection == Reflection::symmetric)
      density.against_theory({"1", "even"}).within(0.05);
    findings.push_back(density);
    findings.push_back(
        results.finding(label, "temperature", "temperature within 0.85 r_c of a side (k_BT)", 3)
            .against_theory({"1", "set"})
            .within(0.03));
  }
  return findings;
}

}  // namespace dmf::tools
