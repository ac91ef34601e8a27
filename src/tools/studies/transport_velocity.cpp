#include "tools/transport_velocity.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/saved_run.h"
#include "tools/study.h"

namespace dmf::tools {

void study_transport_velocity(const StudyOptions& options) {
  const std::vector<double> voltages =
      options.quick ? std::vector<double>{10, 60}
                    : std::vector<double>{10, 20, 30, 35, 40, 45, 50, 60, 70, 80, 100, 120};
  ResultTable table(options.output + "/transport_velocity_runs.csv", {"velocity", "electrodes"});
  const chip::Scene scene = scene_for(options, "transport_velocity");
  const auto key = [&](double voltage, int seed) {
    return fmt::format("V={} dt={} seed={}", voltage, options.time_step, seed);
  };
  std::vector<Job> jobs;
  for (int seed = 1; seed <= options.seeds; ++seed)
    for (const double voltage : voltages)
      jobs.push_back({key(voltage, seed), [=, &scene] {
                        VelocityRun run;
                        run.voltage = voltage;
                        run.seed = static_cast<std::uint64_t>(seed);
                        const VelocityResult result = run_transport_velocity(scene, run);
                        return std::vector<double>{result.velocity, result.electrodes};
                      }});
  run_jobs("transport_velocity", jobs, options, table);

  // What the force on the contact line would make of it: eta, which is V^2 - V_T^2 up to saturation.
  std::string summary = "voltage,velocity,standard_deviation,electrowetting_number,contact_angle_deg\n";
  fmt::print("{:>6} {:>8} {:>8} {:>10} {:>8} {:>12}\n", "V rms", "angle", "eta", "r_c / tau", "+-",
             "per eta");
  const double rest = std::cos(scene.electrowetting.rest_angle * M_PI / 180);
  for (const double voltage : voltages) {
    std::vector<double> velocities;
    for (int seed = 1; seed <= options.seeds; ++seed) velocities.push_back(table.row(key(voltage, seed))[0]);
    const MeanAndSpread velocity = mean_and_spread(velocities);
    const double angle = scene.electrowetting.contact_angle(voltage);
    const double eta = std::cos(angle * M_PI / 180) - rest;
    fmt::print("{:6} {:8.1f} {:8.3f} {:10.4f} {:8.4f} {:12.4f}\n", voltage, angle, eta, velocity.mean,
               velocity.deviation, eta > 1e-9 ? velocity.mean / eta : NAN);
    summary += fmt::format("{},{:.6g},{:.3g},{:.6g},{:.6g}\n", voltage, velocity.mean, velocity.deviation,
                           scene.electrowetting.number(voltage), angle);
  }
  replace_file(options.output + "/transport_velocity.csv", summary);
  fmt::print("written: {}/transport_velocity.csv\n", options.output);
}

}  // namespace dmf::tools
