#include "tools/transport_velocity.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/cases.h"
#include "yaml/units.h"

namespace dmf::tools {

Findings study_transport_velocity(const StudyOptions& options) {
  const std::vector<double> voltages =
      options.quick ? std::vector<double>{10, 60}
                    : std::vector<double>{10, 20, 30, 35, 40, 45, 50, 60, 70, 80, 100, 120};
  const chip::Scene scene = scene_for(options, "transport_velocity");
  const auto label = [](double voltage) { return fmt::format("V={}", voltage); };
  std::vector<Case> cases;
  for (const double voltage : voltages)
    cases.push_back({label(voltage), [=, &scene](std::uint64_t seed) {
                       VelocityRun run;
                       run.voltage = voltage;
                       run.seed = seed;
                       const VelocityResult result = run_transport_velocity(scene, run);
                       return std::vector<double>{result.velocity, result.electrodes};
                     }});
  const Results results = run_cases("transport_velocity", {"velocity", "electrodes"}, cases, options);

  // What the force on the contact line makes of it: V^2 - V_T^2 up to saturation, as fast as here at 40 V.
  const auto force = [&](double voltage) {
    const auto cosine = [](double angle) { return std::cos(angle * degree); };
    return cosine(scene.electrowetting.contact_angle(voltage)) - cosine(scene.electrowetting.rest_angle);
  };
  const double unit = results.mean(label(40), "velocity").mean / force(40);
  Findings findings;
  for (const double voltage : voltages) {
    Finding velocity = results.finding(label(voltage), "velocity", "velocity (r_c/tau)", 4);
    if (velocity.happened() > 0 && unit > 0)
      velocity.against_theory(reference(unit * force(voltage), 4, "V^2 - V_T^2, saturated")).within(0.1);
    findings.push_back(std::move(velocity));
    findings.push_back(results.finding(label(voltage), "electrodes", "electrodes passed", 1));
    findings.push_back(results.derived(label(voltage), "contact_angle", "contact angle commanded (degrees)",
                                       1, {scene.electrowetting.contact_angle(voltage)}));
  }
  return findings;
}

}  // namespace dmf::tools
