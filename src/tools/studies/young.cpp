#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/cases.h"
#include "tools/interface.h"
#include "tools/plug.h"
#include "tools/wall_tension.h"
#include "yaml/units.h"

namespace dmf::tools {
namespace {

constexpr double own_time_step = 0.02;

/// Chen's table 2: a of the walls and the plug; 10 of the walls and what is around it. Degrees.
struct Row {
  double wall_repulsion;
  const char* angle;
  double width = PlugRun{}.width;  ///< of the slit
};
/// The wide slit's surface trembles less: the largest angle is one that trembling makes smaller, for beyond
/// 180 degrees there is none.
const std::vector<Row> paper{{10, "89"},  {12, "116"}, {14, "125"},    {16, "135"},
                             {18, "149"}, {20, "164"}, {20, "164", 18}};
constexpr double around = 10;

std::string label_of(double wall_repulsion) { return fmt::format("a_wA={:g}", wall_repulsion); }
std::string label_of(const Row& row) {
  const std::string label = label_of(row.wall_repulsion);
  return row.width == PlugRun{}.width ? label : fmt::format("{} width={:g}", label, row.width);
}
const char* const of_liquids = "liquids";

PlugRun plug_run(const StudyOptions& options, const Row& row, std::uint64_t seed) {
  PlugRun run;
  run.seed = seed;
  run.time_step = options.time_step_or(own_time_step);
  run.wall_repulsion = row.wall_repulsion;
  run.width = row.width;
  run.carrier_wall_repulsion = around;
  run.measure = 200;
  if (options.quick) {
    run.length = 20;
    run.half_gap = 5;
    run.plug = 10;
    run.settle = run.measure = 10;
  }
  return run;
}

std::vector<double> film_row(const StudyOptions& options, double wall_repulsion, std::uint64_t seed) {
  const PlugRun plug = plug_run(options, {wall_repulsion, ""}, seed);
  WallTensionRun run;
  run.seed = seed;
  run.time_step = plug.time_step;
  run.wall_repulsion = wall_repulsion;
  run.gap = 2 * plug.half_gap;
  run.reflection = plug.reflection;
  if (options.quick) run.settle = run.measure = 5;
  const WallTensionResult found = run_wall_tension(run);
  return {found.tension, found.pressure, found.lacking, found.slope, found.temperature};
}

std::vector<double> interface_row(const StudyOptions& options, std::uint64_t seed) {
  const engine::Parameters parameters = immiscible_liquids(around);
  InterfaceRun run;
  run.seed = seed;
  run.time_step = options.time_step_or(own_time_step);
  run.liquid = parameters.liquid;
  run.attraction_between = parameters.mixture.pairs.front().coefficients.attraction;
  if (options.quick) run.relax = run.measure = 3;
  const InterfaceResult found = run_interface(run);
  return {found.tension, NAN, NAN, NAN, found.temperature};
}

}  // namespace

Findings study_young(const StudyOptions& options) {
  std::vector<Case> plugs,
      tensions{{of_liquids, [&options](std::uint64_t seed) { return interface_row(options, seed); }}};
  for (const Row& row : paper) {
    const double repulsion = row.wall_repulsion;
    plugs.push_back(
        {label_of(row), [=, &options](std::uint64_t seed) {
           const PlugResult found = run_plug(plug_run(options, row, seed));
           return std::vector<double>{found.angle, found.first_half, found.second_half, found.temperature};
         }});
    const bool known = std::any_of(tensions.begin(), tensions.end(),
                                   [&](const Case& one) { return one.label == label_of(repulsion); });
    if (!known && (repulsion == around || is_wanted(options, label_of(row))))
      tensions.push_back({label_of(repulsion),
                          [=, &options](std::uint64_t seed) { return film_row(options, repulsion, seed); }});
  }
  const Results angles =
      run_cases("young", {"angle", "first_half", "second_half", "temperature"}, plugs, options);
  const Results of_walls =
      run_cases("young_tensions", {"tension", "pressure", "lacking", "slope", "temperature"}, tensions,
                without_only(options));

  const auto film = [&](double repulsion) {
    const std::string label = label_of(repulsion);
    return WallTensionResult{of_walls.mean(label, "tension").mean, of_walls.mean(label, "pressure").mean,
                             of_walls.mean(label, "lacking").mean, of_walls.mean(label, "slope").mean,
                             of_walls.mean(label, "temperature").mean};
  };
  const double tension = of_walls.mean(of_liquids, "tension").mean;
  const PlugRun run = plug_run(options, paper.front(), 1);
  Findings findings{of_walls.finding(of_liquids, "tension", "interfacial tension (k_BT/r_c^2)", 2)
                        .against_paper({"5.25", "Chen"})};
  for (const Row& row : paper) {
    const std::string label = label_of(row);
    const std::string of_film = label_of(row.wall_repulsion);
    if (!is_wanted(options, label) || of_walls.of(of_film, "tension").empty()) continue;
    const double cosine =
        young_cosine(film(row.wall_repulsion), film(around), tension, run.half_gap, run.plug / run.length);
    findings.push_back(
        angles.finding(label, "angle", "contact angle of a plug (degrees)", 1)
            .against_paper({row.angle, "Chen"})
            .against_theory(reference(std::acos(std::clamp(cosine, -1.0, 1.0)) / degree, 1, "Young"))
            .within_margin(6));  // what one run is good to at the larger angles
    findings.push_back(angles.finding(label, "first_half", "in the first half of the measurement", 1));
    findings.push_back(angles.finding(label, "second_half", "in the second half of the measurement", 1));
    if (label != of_film) continue;
    findings.push_back(of_walls.finding(label, "tension", "tension of liquid and wall (k_BT/r_c^2)", 2));
    findings.push_back(of_walls.finding(label, "lacking", "layer that the wall keeps off (r_c)", 3));
  }
  return findings;
}

}  // namespace dmf::tools
