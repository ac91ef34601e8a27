#include "tools/sloping_channel.h"

#include <fmt/format.h>

#include "tools/cases.h"
#include "tools/saved_run.h"

namespace dmf::tools {
namespace {

struct Channel {
  double run;           ///< of its slopes, r_c
  double acceleration;  ///< r_c / tau^2

  Slopes slopes() const {
    Slopes slopes;
    slopes.run = run;
    return slopes;
  }
  std::string label() const { return fmt::format("slope={:.0f} g={:g}", slopes().angle(), acceleration); }
};

/// That of the scene, a longer slope and a steeper one (Liu says what both do, without numbers), and three
/// times the force, of which he says nothing.
const std::vector<Channel> all{{16, 0.05}, {10, 0.05}, {2, 0.05}, {10, 0.15}};

SlopingChannelRun run_of(const StudyOptions& options, const Channel& channel, std::uint64_t seed) {
  SlopingChannelRun run{scene_for(options, "sloping_channel")};
  lay_slopes(channel.slopes(), run.scene);
  run.scene.body_forces.gravity.x() = channel.acceleration;
  run.seed = seed;
  if (options.quick) {
    run.settle = 5;
    run.measure = 5;
  }
  return run;
}

}  // namespace

Findings study_sloping_channel(const StudyOptions& options) {
  std::vector<Case> cases;
  for (const Channel& channel : all)
    cases.push_back({channel.label(), [=, &options](std::uint64_t seed) {
                       const SlopingChannelResult result =
                           run_sloping_channel(run_of(options, channel, seed));
                       write_sections(fmt::format("{}/sloping_channel_{}_seed{}.csv", options.output,
                                                  file_name(channel.label() + options_key(options)), seed),
                                      result);
                       const ReachMeans narrow = result.over(Reach::narrow), wide = result.over(Reach::wide);
                       return std::vector<double>{narrow.velocity,
                                                  wide.velocity,
                                                  narrow.density,
                                                  wide.density,
                                                  narrow.stretch_square,
                                                  wide.stretch_square,
                                                  narrow.stretch_square / narrow.end_to_end_square,
                                                  wide.stretch_square / wide.end_to_end_square,
                                                  narrow.off_centre,
                                                  wide.off_centre,
                                                  result.stretch_square,
                                                  result.longest,
                                                  result.straightest,
                                                  result.temperature};
                     }});
  const Results results =
      run_cases("sloping_channel",
                {"velocity_narrow", "velocity_wide", "density_narrow", "density_wide", "stretch_narrow",
                 "stretch_wide", "share_narrow", "share_wide", "off_centre_narrow", "off_centre_wide",
                 "stretch", "longest", "straightest", "temperature"},
                cases, options);
  Findings findings;
  std::vector<std::pair<double, double>> order;
  for (const Channel& channel : all) {
    const std::string label = channel.label();
    const Slopes slopes = channel.slopes();
    const double narrowing = slopes.wide / slopes.narrow;
    const auto ratio = [&](const char* column, const char* of_column) {
      std::vector<double> values = results.of(label, column);
      const std::vector<double> units = results.of(label, of_column);
      for (std::size_t k = 0; k < values.size(); ++k) values[k] /= units[k];
      return values;
    };
    std::vector<double> flow = ratio("velocity_narrow", "velocity_wide");
    const std::vector<double> density = ratio("density_narrow", "density_wide");
    for (std::size_t k = 0; k < flow.size(); ++k) flow[k] *= density[k] / narrowing;
    findings.push_back(
        results.derived(label, "flow_ratio", "flow through the narrow part, of the wide one's", 3, flow)
            .against_theory({"1", "kept"})
            .within(0.02));
    findings.push_back(results
                           .derived(label, "velocity_ratio", "velocity in the narrow part, of the wide one's",
                                    2, ratio("velocity_narrow", "velocity_wide"))
                           .against_theory(reference(narrowing, 2, "heights")));
    findings.push_back(results.finding(label, "velocity_narrow", "velocity in the narrow part (r_c/tau)", 3));
    findings.push_back(results.finding(label, "velocity_wide", "velocity in the wide part (r_c/tau)", 3));
    findings.push_back(results
                           .derived(label, "stretch_ratio", "<R_x^2> in the narrow part, of the wide one's",
                                    2, ratio("stretch_narrow", "stretch_wide"))
                           .against_theory({fmt::format("1 to {:.2f}", narrowing * narrowing),
                                            "not at all, to as much as the liquid around them"}));
    findings.push_back(results.finding(label, "share_narrow", "<R_x^2>/<R^2> in the narrow part", 2)
                           .against_theory({"0.34 to 1", "a coil at rest has a third"}));
    findings.push_back(results.finding(label, "share_wide", "<R_x^2>/<R^2> in the wide part", 2));
    findings.push_back(
        results.finding(label, "off_centre_narrow", "|z| of half the height, in the narrow part", 2)
            .against_theory({"0.5", "even"}));
    findings.push_back(
        results.finding(label, "off_centre_wide", "|z| of half the height, in the wide part", 2)
            .against_theory({"0.5", "even"}));
    findings.push_back(results.finding(label, "stretch", "<R_x^2> of all chains (r_c^2)", 1));
    findings.push_back(results.finding(label, "longest", "longest R_x, of a contour's greatest length", 2));
    findings.push_back(results.finding(label, "straightest", "straightest chain, R over its contour", 2)
                           .against_paper({"1", "Liu: some are fully stretched"})
                           .within(0.2));
    findings.push_back(results.finding(label, "temperature", "temperature across the flow (k_BT)", 3));
    const double stretch = results.mean(label, "stretch").mean;
    if (!results.of(label, "stretch").empty() && channel.acceleration == all[0].acceleration)
      order.push_back({stretch, -slopes.angle()});
  }
  if (order.size() > 1)
    findings.push_back(results
                           .derived("", "order",
                                    "<R_x^2> of all chains: order over the slopes, rank correlation", 2,
                                    {rank_correlation(order)})
                           .against_paper({"1", "Liu: a steep channel stretches less"}));
  return findings;
}

}  // namespace dmf::tools
