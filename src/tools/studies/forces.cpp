#include <fmt/format.h>

#include <cmath>

#include "tools/quasi_stationary.h"
#include "tools/saved_run.h"
#include "tools/study.h"

namespace dmf::tools {
namespace {

/// A friction, and where on the gradient Lan has measured with it (his figures 4.6 to 4.8).
struct Series {
  double static_friction, rolling_friction;
  std::vector<double> places;  ///< x, r_c
};

const std::vector<Series>& series() {
  static const std::vector<Series> all{{0.2, 0.1, {-5, 15}},
                                       {0.4, 0.2, {-15, -10, -5, 0, 5, 10, 15}},
                                       {0.8, 0.4, {-15, -10, -5, 0, 5, 10, 15}},
                                       {1.6, 0.8, {-15, -10, -5, 0, 5}}};
  return all;
}

const std::vector<std::string>& columns() {
  static const std::vector<std::string> all{"velocity", "drive_x",      "friction_x",       "drive_z",
                                            "height",   "normal_force", "contact_fraction", "droplet_ahead"};
  return all;
}

}  // namespace

void study_forces(const StudyOptions& options) {
  std::vector<std::string> labels;
  for (const Series& one : series()) labels.push_back(fmt::format("{}", one.static_friction));
  require_known(options, labels);
  ResultTable table(options.output + "/forces_runs.csv", columns());
  const auto key = [&](const Series& one, double place, int seed) {
    return fmt::format("f={}/{} x={}{} seed={}", one.static_friction, one.rolling_friction, place,
                       options_key(options), seed);
  };
  std::vector<Job> jobs;
  for (int seed = 1; seed <= options.seeds; ++seed)
    for (const Series& one : series()) {
      if (!is_wanted(options, fmt::format("{}", one.static_friction))) continue;
      chip::Scene scene = scene_for(options, "friction");
      scene.microparticles.at(0).static_friction = one.static_friction;
      scene.microparticles.at(0).rolling_friction = one.rolling_friction;
      shorten_the_approach(scene);
      for (const double place : one.places) {
        QuasiStationaryRun run;
        run.place = place;
        run.folder = options.output + "/runs";
        run.key = "forces " + key(one, place, seed);
        if (options.quick) {
          if (place != one.places.front()) continue;
          run.pickup = 100;
          run.ahead = -1;  // as soon as it is wet
          run.slide = 2;
          run.settle = 2;
          run.measure = 5;
        }
        jobs.push_back(
            {key(one, place, seed), [scene, seed, run] {
               return row_or_nan(run.key, columns().size(), [&] {
                 const QuasiStationary r = run_quasi_stationary(scene, static_cast<std::uint64_t>(seed), run);
                 return std::vector<double>{r.velocity, r.drive_x,      r.friction_x,       r.drive_z,
                                            r.height,   r.normal_force, r.contact_fraction, r.droplet_ahead};
               });
             }});
      }
    }
  run_jobs("forces", jobs, options, table);

  std::string summary = "f_s,f_r,x,quantity,mean,standard_deviation,runs\n";
  fmt::print("forces on a held microparticle, mean +- standard deviation (runs that kept it)\n");
  fmt::print("{:>5} {:>6}  {:>20}  {:>18}  {:>18}\n", "f_s", "x", "velocity (r_c/tau)", "drive (k_BT/r_c)",
             "friction (k_BT/r_c)");
  for (const Series& one : series()) {
    if (!is_wanted(options, fmt::format("{}", one.static_friction))) continue;
    for (const double place : one.places) {
      std::vector<MeanAndSpread> means;
      std::size_t kept = 0;
      for (std::size_t column = 0; column < columns().size(); ++column) {
        std::vector<double> values;
        for (int seed = 1; seed <= options.seeds; ++seed) {
          if (!table.has(key(one, place, seed))) continue;  // --quick leaves places out
          if (const double value = table.row(key(one, place, seed))[column]; std::isfinite(value))
            values.push_back(value);
        }
        kept = values.size();
        means.push_back(mean_and_spread(values));
        summary +=
            fmt::format("{},{},{},{},{:.6g},{:.3g},{}\n", one.static_friction, one.rolling_friction, place,
                        columns()[column], kept > 0 ? means.back().mean : NAN, means.back().deviation, kept);
      }
      if (kept == 0) continue;
      fmt::print("{:>5} {:>6}  {:>9.5f} +- {:<7.5f}  {:>9.2f} +- {:<5.2f}  {:>9.2f} +- {:<5.2f} ({} of {})\n",
                 one.static_friction, place, means[0].mean, means[0].deviation, means[1].mean,
                 means[1].deviation, means[2].mean, means[2].deviation, kept, options.seeds);
    }
  }
  const std::string file = options.output + "/forces.csv";
  replace_file(file, summary);
  fmt::print(
      "Lan: drive and friction balance; both and the velocity rise to x = 5 and fall again at f_s 0.4, "
      "only rise at 0.8 and 1.6\nwritten: {}\n",
      file);
}

}  // namespace dmf::tools
