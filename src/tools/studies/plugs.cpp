#include <fmt/format.h>

#include "tools/cases.h"
#include "tools/plug.h"

namespace dmf::tools {
namespace {

/// Chen 3.3.2: one plug at rest and under two accelerations (his figures 10 and 11), and how fast plugs move
/// over what repels them from the walls (12), with the liquid around them as it is or repelled as much.
struct Drive {
  double acceleration, wall_repulsion, carrier_wall_repulsion;
  std::string label() const {
    return fmt::format("g={:g} a_wA={:g} a_wB={:g}", acceleration, wall_repulsion, carrier_wall_repulsion);
  }
};
const Drive at_rest{0, 16, 10}, slow{0.02, 16, 10}, fast{0.08, 16, 10}, neutral{0.02, 10, 10},
    hydrophobic{0.02, 20, 10}, both_repelled{0.02, 20, 20};

PlugRun plug_run(const StudyOptions& options, const Drive& drive, std::uint64_t seed) {
  PlugRun run;
  run.seed = seed;
  run.time_step = options.time_step_or(0.02);
  run.walls = ChannelWalls::square;
  run.half_gap = 7;  // Chen's is 10: half of his beads
  run.plug = 15;
  run.settle = 80;
  run.measure = 60;
  run.acceleration = drive.acceleration;
  run.wall_repulsion = drive.wall_repulsion;
  run.carrier_wall_repulsion = drive.carrier_wall_repulsion;
  if (options.quick) {
    run.length = 20;
    run.half_gap = 5;
    run.plug = 10;
    run.settle = run.measure = 10;
  }
  return run;
}

}  // namespace

Findings study_plugs(const StudyOptions& options) {
  const std::vector<Drive> drives{at_rest, slow, fast, neutral, hydrophobic, both_repelled};
  std::vector<Case> cases;
  for (const Drive& drive : drives)
    cases.push_back({drive.label(), [=, &options](std::uint64_t seed) {
                       const PlugResult found = run_plug(plug_run(options, drive, seed));
                       return std::vector<double>{found.advancing,  found.receding, found.length,
                                                  found.velocity,   found.section,  found.corners,
                                                  found.temperature};
                     }});
  const Results results =
      run_cases("plugs", {"advancing", "receding", "length", "velocity", "section", "corners", "temperature"},
                cases, options);
  Findings findings;
  const auto add = [&](const Drive& drive, const char* column, const char* title, int decimals,
                       const Reference& paper = {}) {
    if (!results.of(drive.label(), column).empty())
      findings.push_back(results.finding(drive.label(), column, title, decimals).against_paper(paper));
  };
  // He tells of trends: against what is seen at rest.
  const auto beside_rest = [&](const char* column, bool above, double limit, int decimals) {
    const double rest = results.mean(at_rest.label(), column).mean;
    return Reference{
        fmt::format("{:.{}f} to {:.{}f}", above ? rest : limit, decimals, above ? limit : rest, decimals),
        above ? "Chen: more than at rest" : "Chen: less than at rest"};
  };
  for (const Drive& drive : drives) {
    const bool moving = drive.wall_repulsion == at_rest.wall_repulsion && drive.acceleration > 0;
    const auto trend = [&](const char* column, bool above, double limit, int decimals) {
      return moving ? beside_rest(column, above, limit, decimals) : Reference{};
    };
    // The fast one no longer touches the walls: it has no angles.
    if (drive.acceleration < fast.acceleration) {
      add(drive, "advancing", "advancing angle (degrees)", 0, trend("advancing", true, 180, 0));
      add(drive, "receding", "receding angle (degrees)", 0, trend("receding", false, 0, 0));
    }
    add(drive, "length", "length of the plug (r_c)", 1);
    add(drive, "velocity", "velocity of the plug (r_c/tau)", 3);
    add(drive, "section", "share of the channel's section that it fills", 2, trend("section", false, 0, 2));
    add(drive, "corners", "share of the corners that it fills", 2, trend("corners", false, 0, 2));
  }
  return findings;
}

}  // namespace dmf::tools
