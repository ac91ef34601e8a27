#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <functional>
#include <limits>
#include <map>

#include "chip/configuration.h"
#include "chip/scene.h"
#include "engine/simulation.h"
#include "tools/crossing.h"
#include "tools/liquid.h"
#include "tools/sessile.h"
#include "tools/study.h"

namespace dmf::tools {
namespace {

using engine::Integrator;

struct Scheme {
  const char* name;
  Integrator integrator;
};
constexpr Scheme schemes[] = {{"groot_warren", Integrator::groot_warren}, {"baoab", Integrator::baoab}};

/// What one run of a kind gives, by column.
struct Kind {
  const char* name;
  std::vector<std::string> columns;
  std::map<Integrator, std::vector<double>> time_steps;
  std::function<std::vector<double>(const Scheme&, double time_step, int seed)> work;
};

/// About the cheapest (see the cost that the study prints); results do not depend on it.
double skin_for(double time_step) { return std::clamp(10 * time_step, 0.2, 0.5); }

double thread_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Nanoseconds of a thread's own time per bead and step, a droplet of R = 7 on a plate: best of three.
double cost(const Scheme& scheme, double time_step, double skin) {
  engine::Parameters parameters;
  parameters.domain.lower = {-20, -20, 0};
  parameters.domain.upper = {20, 20, 20};
  parameters.time_step = time_step;
  parameters.integrator = scheme.integrator;
  parameters.list_skin = skin;
  engine::Simulation simulation(parameters, engine::ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.set_wettability([](double, double) { return 110.0; });
  const auto beads = static_cast<double>(simulation.add_droplet({{0, 0, 6}, 7}));
  for (int k = 0; k < 500; ++k) simulation.step();
  double best = std::numeric_limits<double>::infinity();
  for (int repetition = 0; repetition < 3; ++repetition) {
    constexpr int steps = 300;
    const double start = thread_seconds();
    for (int k = 0; k < steps; ++k) simulation.step();
    best = std::min(best, (thread_seconds() - start) * 1e9 / (steps * beads));
  }
  return best;
}

/// A run that blew up leaves nothing but that: every column is NaN.
std::vector<double> row_or_nan(std::size_t columns, const std::function<std::vector<double>()>& work) {
  try {
    return work();
  } catch (const std::exception&) {
    return std::vector<double>(columns, std::nan(""));
  }
}

}  // namespace

void study_time_step(const StudyOptions& options) {
  const bool quick = options.quick;
  const engine::ContactAngleCurve curve =
      engine::ContactAngleCurve::load(chip::find_config("calibration", options.calibration));
  const double radius = options.radius > 0 ? options.radius : 7;
  const std::vector<double> steps =
      quick ? std::vector<double>{0.01, 0.03} : std::vector<double>{0.005, 0.01, 0.02, 0.03, 0.04, 0.05};
  // A crossing takes minutes: Groot and Warren's only where it is known to work.
  const std::vector<double> crossing_steps = quick ? std::vector<double>{} : std::vector<double>{0.01},
                            long_crossing_steps =
                                quick ? std::vector<double>{} : std::vector<double>{0.02, 0.03, 0.04};
  const auto liquid = [quick](const Scheme& scheme, double time_step, int seed, double measure) {
    return LiquidRun{static_cast<std::uint64_t>(seed),
                     time_step,
                     0,
                     quick,
                     scheme.integrator,
                     skin_for(time_step),
                     quick ? 0 : measure};
  };
  const auto sessile = [=](const Scheme& scheme, double time_step, int seed, double attraction,
                           double starting_angle) {
    SessileRun run;
    run.attraction = attraction;
    run.radius = radius;
    run.starting_angle = starting_angle;
    run.settle = quick ? 10 : 40;
    run.measure = quick ? 10 : 60;
    run.seed = static_cast<std::uint64_t>(seed);
    run.parameters.time_step = time_step;
    run.parameters.integrator = scheme.integrator;
    run.parameters.list_skin = skin_for(time_step);
    return run_sessile(run);
  };
  const std::vector<Kind> kinds{
      {"film",
       {"film_density", "tension", "normal_pressure"},
       {{Integrator::groot_warren, steps}, {Integrator::baoab, steps}},
       [&](const Scheme& scheme, double dt, int seed) {
         const FilmResult r = run_film(liquid(scheme, dt, seed, 100));
         return std::vector<double>{r.density, r.tension, r.normal_pressure};
       }},
      {"bulk",
       {"temperature", "pressure", "viscosity"},
       {{Integrator::groot_warren, steps}, {Integrator::baoab, steps}},
       [&](const Scheme& scheme, double dt, int seed) {
         const BulkResult r = run_bulk(liquid(scheme, dt, seed, 50));
         return std::vector<double>{r.temperature, r.pressure, r.viscosity};
       }},
      {"sessile",
       {"angle_at_90", "temperature_at_90"},
       {{Integrator::groot_warren, steps}, {Integrator::baoab, steps}},
       [&](const Scheme& scheme, double dt, int seed) {
         const SessileResult r = sessile(scheme, dt, seed, curve.attraction(90), 90);
         return std::vector<double>{r.angle, r.temperature};
       }},
      {"wetting",
       {"angle_at_-22", "temperature_at_-22"},
       {{Integrator::groot_warren, steps}, {Integrator::baoab, steps}},
       [&](const Scheme& scheme, double dt, int seed) {
         const SessileResult r = sessile(scheme, dt, seed, -22, 38);
         return std::vector<double>{r.angle, r.temperature};
       }},
      {"crossing",
       {"from_-20_to_30", "to_40"},
       {{Integrator::groot_warren, crossing_steps}, {Integrator::baoab, long_crossing_steps}},
       [&](const Scheme& scheme, double dt, int seed) {
         chip::Scene scene = chip::load_scene(options.scene);
         scene.parameters.time_step = dt;
         scene.parameters.integrator = scheme.integrator;
         scene.parameters.list_skin = skin_for(dt);
         const Crossing crossing =
             run_crossing(scene, static_cast<std::uint64_t>(seed), scene.default_duration);
         return std::vector<double>{crossing.passed.at(30) - crossing.passed.at(-20), crossing.passed.at(40)};
       }}};

  const std::string file = options.output + "/time_step.csv";
  std::string summary = "observable,integrator,time_step,mean,standard_deviation,runs\n";
  const auto summarize = [&](const std::string& observable, const Scheme& scheme, double dt,
                             const std::vector<double>& values) {
    const MeanAndSpread result = mean_and_spread(values);
    fmt::print("{:<26} {:<14} dt {:<6} {:10.4f} +- {:.4f}\n", observable, scheme.name, dt, result.mean,
               result.deviation);
    summary += fmt::format("{},{},{},{:.6g},{:.3g},{}\n", observable, scheme.name, dt, result.mean,
                           result.deviation, values.size());
  };
  const auto key = [](const Scheme& scheme, double dt, int seed) {
    return fmt::format("{} dt={} seed={}", scheme.name, dt, seed);
  };
  for (const Kind& kind : kinds) {
    ResultTable table(fmt::format("{}/time_step_{}_runs.csv", options.output, kind.name), kind.columns);
    std::vector<Job> jobs;
    for (int seed = 1; seed <= options.seeds; ++seed)
      for (const Scheme& scheme : schemes)
        for (const double dt : kind.time_steps.at(scheme.integrator))
          jobs.push_back({key(scheme, dt, seed), [&kind, &scheme, dt, seed] {
                            return row_or_nan(kind.columns.size(),
                                              [&] { return kind.work(scheme, dt, seed); });
                          }});
    run_jobs(fmt::format("time_step {}", kind.name), jobs, options, table);
    for (std::size_t column = 0; column < kind.columns.size(); ++column)
      for (const Scheme& scheme : schemes)
        for (const double dt : kind.time_steps.at(scheme.integrator)) {
          std::vector<double> values;
          for (int seed = 1; seed <= options.seeds; ++seed)
            values.push_back(table.row(key(scheme, dt, seed))[column]);
          summarize(kind.columns[column], scheme, dt, values);
        }
  }

  const std::vector<double> skins =
      quick ? std::vector<double>{0.2} : std::vector<double>{0.2, 0.3, 0.4, 0.5, 0.6};
  ResultTable costs(options.output + "/time_step_cost_runs.csv", {"ns_per_bead_step"});
  const auto cost_key = [](const Scheme& scheme, double dt, double skin) {
    return fmt::format("{} dt={} skin={}", scheme.name, dt, skin);
  };
  std::vector<Job> jobs;
  for (const Scheme& scheme : schemes)
    for (const double dt : steps)
      for (const double skin : skins)
        jobs.push_back({cost_key(scheme, dt, skin), [&scheme, dt, skin] {
                          return row_or_nan(1, [&] { return std::vector<double>{cost(scheme, dt, skin)}; });
                        }});
  run_jobs("time_step cost", jobs, options, costs);
  for (const Scheme& scheme : schemes)
    for (const double dt : steps) {
      double best = std::numeric_limits<double>::infinity(), best_skin = 0;
      for (const double skin : skins)
        if (const double ns = costs.row(cost_key(scheme, dt, skin))[0]; ns < best)
          best = ns, best_skin = skin;
      if (!std::isfinite(best)) continue;  // unstable
      summarize("ns_per_bead_step", scheme, dt, {best});
      summarize("best_skin", scheme, dt, {best_skin});
      summarize("tau_per_second_10000_beads", scheme, dt, {dt / (best * 1e-9 * 1e4)});
    }
  std::ofstream(file) << summary;
  fmt::print("written: {}\n", file);
}

}  // namespace dmf::tools
