#include <fmt/format.h>

#include "tools/cases.h"
#include "tools/quasi_stationary.h"
#include "tools/saved_run.h"

namespace dmf::tools {

Findings study_inner_flow(const StudyOptions& options) {
  // Lan looks where the microparticle is at x = -10 (figures 3.7 and 3.8), and at a droplet alone (2.17).
  constexpr double place = -10;
  const std::vector<std::string> labels{"particle", "alone"};
  std::vector<Case> cases;
  for (const std::string& label : labels) {
    chip::Scene scene = scene_for(options, "pickup");
    if (label == "alone") scene.microparticles.clear();
    shorten_the_approach(scene);
    QuasiStationaryRun run;
    run.place = place;
    run.measure = 10000;
    run.flow = true;
    run.folder = options.output + "/runs";
    run.key = "inner_flow " + label + options_key(options);
    if (options.quick) {
      run.pickup = 100;
      run.ahead = -1;  // as soon as it is wet
      run.slide = 2;
      run.settle = 2;
      run.measure = 5;
    }
    cases.push_back({label, [scene, run](std::uint64_t seed) {
                       QuasiStationaryRun seeded = run;
                       seeded.key += fmt::format(" seed={}", seed);
                       const QuasiStationary r = run_quasi_stationary(scene, seed, seeded);
                       replace_file(run.folder + "/" + file_name(seeded.key) + "_cells.csv", r.flow.as_csv());
                       ResultRow row = std::vector<double>{r.velocity, r.drive_z, r.droplet_ahead};
                       row.computing = r.earlier_computing;
                       return row;
                     }});
  }
  const Results results = run_cases("inner_flow", {"velocity", "drive_z", "droplet_ahead"}, cases, options);
  Findings findings;
  for (const std::string& label : labels) {
    findings.push_back(results.finding(label, "velocity", "velocity (r_c/tau)", 5));
    findings.push_back(results.finding(label, "drive_z", "lift of the liquid (k_BT/r_c)", 1));
    findings.push_back(results.finding(label, "droplet_ahead", "the droplet's centre is ahead by (r_c)", 2));
  }
  return findings;
}

}  // namespace dmf::tools
