#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "engine/wettability.h"
#include "tools/cases.h"
#include "tools/saved_run.h"
#include "tools/structured_wall.h"

namespace dmf::tools {
namespace {

/// One row of the study: what is varied, and what Yao found.
struct Droplet {
  std::string label;
  double attraction, spacing, force, drive;  ///< spacing 0: smooth
  GrooveBottom bottom = GrooveBottom::bare;  ///< where Yao's droplets hang, ours do so only over these
};

constexpr double optimum_force = 0.0007;  // of figure 7

/// Yao's f_s are those of ridges 4 wide, whole numbers apart: 3, 5, 9, 11 are 0.571, 0.444, 0.308, 0.267.
std::vector<Droplet> droplets(bool quick, const engine::ContactAngleCurve& curve) {
  const double drive = quick ? 20 : 1500;  // Yao's: 5,000
  std::vector<Droplet> all;
  // Figure 4: static angles at f_s 0.444, beside those of the smooth wall in the same slab.
  for (const double attraction : {-11.0, -13.0, -15.0, -17.0})
    for (const double s : {0.0, 5.0})
      all.push_back({fmt::format("static A={:g} S={:g}", attraction, s), attraction, s, 0, 0});
  all.push_back({"static A=-13 S=5 bottom", -13, 5, 0, 0, GrooveBottom::beads});
  // Figure 5: against the smooth wall, at two angles.
  for (const auto& [angle, spacing] : {std::pair{130.59, 5.0}, {67.84, 9.0}})
    for (const double s : {0.0, spacing})
      all.push_back(
          {fmt::format("order theta={:g} S={:g}", angle, s), curve.attraction(angle), s, 0.0008, drive});
  // Figure 7: velocity over f_s.
  for (const double attraction : {-13.0, -14.0, -15.0})
    for (const double spacing : {3.0, 5.0, 9.0, 11.0, 13.0})
      all.push_back({fmt::format("optimum A={:g} S={:g}", attraction, spacing), attraction, spacing,
                     optimum_force, drive});
  all.push_back({"optimum A=-13 S=11 bottom", -13, 11, optimum_force, drive, GrooveBottom::beads});
  return all;
}

StructuredWallRun run_of(const StudyOptions& options, const Droplet& one, std::uint64_t seed) {
  StructuredWallRun run;
  run.attraction = one.attraction;
  run.spacing = one.spacing;
  run.start = DropletStart::disc;
  run.bottom = one.bottom;
  run.force = one.force;
  run.drive = one.drive;
  run.length = one.drive > 0 ? 200 : 100;
  run.settle = options.quick ? 40 : one.drive > 0 ? 100 : 150;
  run.rest = options.quick || one.drive > 0 ? 10 : 150;  // the angle at rest is what static cases are for
  run.seed = seed;
  run.parameters.integrator = engine::Integrator::baoab;  // three times as cheap
  run.parameters.time_step = 0.03;
  apply(options, run.parameters);
  return run;
}

/// How fast droplets go over ridges, of what they do over a smooth wall; of runs that there are both of.
Finding over_smooth(double angle, double spacing, const Results& results) {
  const std::string label = fmt::format("order theta={:g} S=", angle);
  std::vector<double> ratios = results.of(fmt::format("{}{:g}", label, spacing), "velocity");
  const std::vector<double> smooth = results.of(label + "0", "velocity");
  ratios.resize(std::min(ratios.size(), smooth.size()));
  for (std::size_t k = 0; k < ratios.size(); ++k) ratios[k] /= smooth[k];
  return results.derived(fmt::format("order theta={:g}", angle), "over_smooth",
                         "velocity over ridges, of that over a smooth wall", 2, ratios);
}

/// The f_s at which droplets of one wettability move fastest; nothing while a spacing has not been run.
Finding fastest_of(const std::vector<Droplet>& all, double attraction, const Results& results) {
  double fastest = -1e300, at = 0;
  bool complete = true;
  for (const Droplet& one : all) {
    if (one.attraction != attraction || one.force != optimum_force || one.bottom != GrooveBottom::bare)
      continue;
    complete = complete && !results.of(one.label, "velocity").empty();
    const double velocity = results.mean(one.label, "velocity").mean;
    if (!complete || velocity <= fastest) continue;
    fastest = velocity;
    at = StructuredWallRun{attraction, 4, one.spacing}.solid_fraction();
  }
  return results.derived(fmt::format("optimum A={:g}", attraction), "fastest", "fastest at f_s", 3,
                         complete ? std::vector<double>{at} : std::vector<double>{});
}

}  // namespace

Findings study_structured_wall(const StudyOptions& options) {
  const engine::ContactAngleCurve curve = curve_for(options);
  const std::vector<Droplet> all = droplets(options.quick, curve);
  std::vector<Case> cases;
  for (const Droplet& one : all)
    cases.push_back({one.label, [=, &options](std::uint64_t seed) {
                       std::ofstream csv;
                       const auto sample = [&](const FrontSample& seen) {
                         if (!csv.is_open()) {
                           csv.open(fmt::format("{}/structured_wall_{}_seed{}.csv", options.output,
                                                file_name(one.label + options_key(options)), seed));
                           csv << "time,centre,front,angle\n";
                         }
                         csv << fmt::format("{:.6g},{:.6g},{:.6g},{:.6g}\n", seen.time, seen.centre,
                                            seen.front, seen.angle);
                       };
                       const StructuredWallResult found =
                           run_structured_wall(run_of(options, one, seed), sample);
                       return std::vector<double>{found.angle, found.difference, found.sunk, found.velocity};
                     }});
  const Results results =
      run_cases("structured_wall", {"angle", "difference", "sunk", "velocity"}, cases, options);
  Findings findings;
  for (const Droplet& one : all) {
    const double solid = run_of(options, one, 1).solid_fraction();
    Finding angle = results.finding(one.label, "angle", "contact angle (degrees)", 1);
    // Of a smooth wall the calibration tells; of ridges Cassie and Baxter, from what the smooth wall shows
    // here.
    const std::string smooth = fmt::format("static A={:g} S=0", one.attraction);
    const double measured = results.mean(smooth, "angle").mean;
    if (one.spacing == 0 && one.drive == 0)
      angle.against_theory(reference(curve.angle(one.attraction), 1, "calibration"));
    else if (one.drive == 0 && !results.of(smooth, "angle").empty())
      angle.against_theory(reference(cassie_baxter_angle(solid, measured), 1, "Cassie and Baxter"));
    findings.push_back(angle.within_margin(3));
    findings.push_back(results.finding(one.label, "sunk", "share of the grooves under it that is filled", 2));
    if (one.drive > 0)
      findings.push_back(
          results.finding(one.label, "velocity", fmt::format("velocity at f_s {:.3f} (r_c/tau)", solid), 5));
  }
  findings.push_back(over_smooth(130.59, 5, results).against_paper({"1 to 100", "Yao: faster"}));
  findings.push_back(over_smooth(67.84, 9, results).against_paper({"-1 to 1", "Yao: slower, hardly at all"}));
  for (const auto& [attraction, fastest] : {std::pair{-13.0, "0.267"}, {-14.0, "0.571"}, {-15.0, "0.571"}})
    findings.push_back(fastest_of(all, attraction, results).against_paper({fastest, "Yao"}).within(0.01));
  return findings;
}

}  // namespace dmf::tools
