#include <fmt/format.h>

#include <cmath>

#include "tools/cases.h"
#include "tools/channel.h"
#include "tools/saved_run.h"

namespace dmf::tools {
namespace {

using engine::Reflection;

constexpr double acceleration = 0.02, half_width = 15.25, friction = 4.5;  // of the scenes

/// What Lan's 2.3 leaves open, and what it says.
struct Channel {
  std::string label;
  int dimensions;
  Reflection reflection;
  Reference reported;  ///< u_max of Lan's figures 2.9 and 2.10

  /// Liu's table 1 and Lan (2.32), (2.33), of a liquid that no repulsion orders.
  double theory(double density) const {
    return dimensions == 2 ? 6 / (M_PI * friction) + M_PI * friction * density * density / 480
                           : 45 / (4 * M_PI * friction) + 2 * M_PI * friction * density * density / 1575;
  }
};

std::vector<Channel> channels() {
  return {{"3D", 3, Reflection::bounce_forward, {"8.60", "Lan"}},
          {"3D bounce_back", 3, Reflection::bounce_back, {}},
          {"3D maxwellian", 3, Reflection::maxwellian, {}},
          {"3D thin_layer", 3, Reflection::thin_layer, {}},
          {"3D specular", 3, Reflection::specular, {}},
          // Lan (2.34) lays the rest of it on an apparent density of 6.35, four beads of an fcc lattice in a
          // plane.
          {"2D", 2, Reflection::bounce_forward, {"9.18", "Lan"}}};
}

/// Lan 2.3.1: 60 x 3 x 30.5 between the planes, the fcc lattice of the liquid and the walls goes through
/// both. Three cells must fit across, hence 4 r_c along y; along x nothing varies, and the scene's 10 do.
ChannelRun channel_run(const Channel& channel, const StudyOptions& options, std::uint64_t seed) {
  ChannelRun run;
  run.scene = scene_for(options, channel.dimensions == 2 ? "poiseuille_2d" : "poiseuille");
  engine::BoundaryParameters& boundaries = run.scene.parameters.boundaries;
  boundaries.lower_reflection[2] = boundaries.upper_reflection[2] = channel.reflection;
  run.seed = seed;
  // The slowest wave decays with rho h^2 / (pi^2 / 4 mu), some 350 tau. Lan: 2600 and 400 tau.
  run.settle = options.quick ? 20 : 2000;
  run.measure = options.quick ? 20 : 1000;
  return run;
}

}  // namespace

Findings study_poiseuille(const StudyOptions& options) {
  std::vector<Case> cases;
  for (const Channel& channel : channels())
    cases.push_back(
        {channel.label, [=](std::uint64_t seed) {
           const ChannelProfile profile = run_channel(channel_run(channel, options, seed));
           write_profile(
               fmt::format("{}/poiseuille_{}_seed{}.csv", options.output, file_name(channel.label), seed),
               profile);
           const ChannelFlow flow = flow_of(profile, acceleration);
           return std::vector<double>{flow.fastest,         flow.viscosity,      flow.slip,
                                      flow.density,         flow.temperature,    flow.most_dense_at_wall,
                                      flow.coolest_at_wall, flow.hottest_at_wall};
         }});
  const Results results = run_cases("poiseuille",
                                    {"u_max", "viscosity", "slip", "density", "temperature",
                                     "most_dense_at_wall", "coolest_at_wall", "hottest_at_wall"},
                                    cases, options);
  Findings findings;
  for (const Channel& channel : channels()) {
    const double viscosity = channel.theory(4);
    findings.push_back(results.finding(channel.label, "u_max", "largest velocity (r_c/tau)", 3)
                           .against_paper(channel.reported)
                           .against_theory(reference(
                               4 * acceleration * half_width * half_width / (2 * viscosity), 2, "parabola"))
                           .within(0.03));
    findings.push_back(results.finding(channel.label, "viscosity", "viscosity (m/(r_c tau))", 3)
                           .against_theory(reference(viscosity, 3, "kinetic theory")));
    findings.push_back(results.finding(channel.label, "slip", "slip velocity at the walls (r_c/tau)", 3));
    findings.push_back(results.finding(channel.label, "density", "density in the middle", 3));
    findings.push_back(results.finding(channel.label, "temperature", "temperature in the middle (k_BT)", 3));
    findings.push_back(
        results.finding(channel.label, "most_dense_at_wall", "largest density at a wall, of the middle", 2));
    findings.push_back(
        results.finding(channel.label, "coolest_at_wall", "lowest temperature at a wall (k_BT)", 3));
    findings.push_back(
        results.finding(channel.label, "hottest_at_wall", "highest temperature at a wall (k_BT)", 3));
  }
  return findings;
}

}  // namespace dmf::tools
