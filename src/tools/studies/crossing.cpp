#include "tools/crossing.h"

#include <fmt/format.h>

#include "tools/cases.h"

namespace dmf::tools {
namespace {

/// A scene in which a droplet crosses a gradient from x = -40 to 40, and the time that Lan's takes.
struct Gradient {
  const char* scene;
  Reference lan;
};

const std::vector<Gradient> gradients{{"gradient_R5", {"2973", "Lan, one run"}},
                                      {"droplet_gradient", {"about 1800", "Lan, one run, R = 10"}}};

const std::vector<std::string> columns{"to_-30", "to_-20", "to_0", "to_30", "to_40", "ns_per_bead_step"};

}  // namespace

std::vector<double> recorded_crossings(StudyOptions options) {
  options.recorded = true;
  return run_cases("crossing", columns, {{"gradient_R5", nullptr}}, without_only(options))
      .of("gradient_R5", "to_40");
}

Findings study_crossing(const StudyOptions& options) {
  std::vector<Case> cases;
  for (const Gradient& gradient : gradients)
    cases.push_back({gradient.scene, [=](std::uint64_t seed) {
                       const chip::Scene scene = scene_for(options, gradient.scene);
                       const Crossing crossing =
                           run_crossing(scene, seed, options.quick ? 100 : scene.default_duration);
                       std::vector<double> row;
                       for (const auto& entry : crossing.passed) row.push_back(entry.second);
                       row.push_back(crossing.ns_per_bead_step);
                       return row;
                     }});
  const Results results = run_cases(
      "crossing", {"to_-30", "to_-20", "to_0", "to_30", "to_40", "ns_per_bead_step"}, cases, options);
  Findings findings;
  for (const Gradient& gradient : gradients) {
    const auto passes = [&](const char* column) { return results.of(gradient.scene, column); };
    findings.push_back(
        results.finding(gradient.scene, "to_40", "from x = -40 to 40 (tau)", 0).against_paper(gradient.lan));
    std::vector<double> middle = passes("to_30");
    const std::vector<double> start = passes("to_-20");
    for (std::size_t k = 0; k < middle.size(); ++k) middle[k] -= start[k];
    findings.push_back(
        results.derived(gradient.scene, "from_-20_to_30", "from x = -20 to 30 (tau)", 0, middle));
  }
  return findings;
}

}  // namespace dmf::tools
