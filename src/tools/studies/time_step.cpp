#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "chip/scene.h"
#include "engine/simulation.h"
#include "tools/cases.h"
#include "tools/crossing.h"
#include "tools/liquid.h"
#include "tools/saved_run.h"
#include "tools/sessile.h"

namespace dmf::tools {
namespace {

using engine::Integrator;

struct Scheme {
  const char* name;
  Integrator integrator;
};
constexpr Scheme schemes[] = {{"groot_warren", Integrator::groot_warren}, {"baoab", Integrator::baoab}};

/// What one run of a kind gives, by column, and what is known of each.
struct Kind {
  const char* name;
  std::vector<std::string> columns;
  std::vector<const char*> titles;
  std::vector<Reference> known;
  std::map<Integrator, std::vector<double>> time_steps;
  std::function<std::vector<double>(const Scheme&, double time_step, std::uint64_t seed)> work;
};

/// About the cheapest (see the cost that the study prints); results do not depend on it.
double skin_for(double time_step) { return std::clamp(10 * time_step, 0.2, 0.5); }

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

std::string label_of(const Scheme& scheme, double time_step) {
  return fmt::format("{} dt={}", scheme.name, time_step);
}

/// Cost of a step over time step and width of the cells, and the tau that a second of one core makes of it.
Findings costs(const StudyOptions& options, const std::vector<double>& steps) {
  const std::vector<double> skins =
      options.quick ? std::vector<double>{0.2} : std::vector<double>{0.2, 0.3, 0.4, 0.5, 0.6};
  const auto label = [](const Scheme& scheme, double dt, double skin) {
    return fmt::format("{} skin={}", label_of(scheme, dt), skin);
  };
  std::vector<Case> cases;
  for (const Scheme& scheme : schemes)
    for (const double dt : steps)
      for (const double skin : skins)
        cases.push_back({label(scheme, dt, skin), [&scheme, dt, skin](std::uint64_t) {
                           return std::vector<double>{cost(scheme, dt, skin)};
                         }});
  const Results results = run_cases("time_step_cost", {"ns_per_bead_step"}, cases, options);
  Findings findings;
  for (const Scheme& scheme : schemes)
    for (const double dt : steps) {
      double best = std::numeric_limits<double>::infinity(), best_skin = 0;
      for (const double skin : skins)
        for (const double ns : results.of(label(scheme, dt, skin), "ns_per_bead_step"))
          if (ns < best) best = ns, best_skin = skin;
      if (!std::isfinite(best)) continue;  // unstable
      const auto add = [&](const char* quantity, const char* title, int decimals, double value) {
        findings.push_back(results.derived(label_of(scheme, dt), quantity, title, decimals, {value}));
      };
      add("ns_per_bead_step", "least cost of a bead and step (ns)", 1, best);
      add("best_skin", "at cells wider than r_c by (r_c)", 2, best_skin);
      add("tau_per_second_10000_beads", "tau a second, 10,000 beads on one core", 2,
          dt / (best * 1e-9 * 1e4));
    }
  return findings;
}

}  // namespace

Findings study_time_step(const StudyOptions& options) {
  const bool quick = options.quick;
  const engine::ContactAngleCurve curve = curve_for(options);
  const double radius = options.radius_or(7);
  const std::vector<double> steps =
      quick ? std::vector<double>{0.01, 0.03} : std::vector<double>{0.005, 0.01, 0.02, 0.03, 0.04, 0.05};
  // A crossing takes minutes: Groot and Warren's only where it is known to work.
  const std::vector<double> crossing_steps = quick ? std::vector<double>{} : std::vector<double>{0.01},
                            long_crossing_steps =
                                quick ? std::vector<double>{} : std::vector<double>{0.02, 0.03, 0.04};
  const auto liquid = [quick](const Scheme& scheme, double time_step, std::uint64_t seed, double measure) {
    return LiquidRun{seed, time_step, 0, quick, scheme.integrator, skin_for(time_step), quick ? 0 : measure};
  };
  const auto sessile = [=](const Scheme& scheme, double time_step, std::uint64_t seed, double attraction,
                           double starting_angle) {
    SessileRun run;
    run.attraction = attraction;
    run.radius = radius;
    run.starting_angle = starting_angle;
    run.settle = quick ? 10 : 40;
    run.measure = quick ? 10 : 60;
    run.seed = seed;
    run.parameters.time_step = time_step;
    run.parameters.integrator = scheme.integrator;
    run.parameters.list_skin = skin_for(time_step);
    return run_sessile(run);
  };
  const std::vector<Kind> kinds{
      {"film",
       {"film_density", "tension", "normal_pressure"},
       {"density inside a film (1/r_c^3)", "surface tension (k_BT/r_c^2)",
        "normal pressure of a film at rest (k_BT/r_c^3)"},
       {{"6.0 to 6.1", "known of this liquid"}, {"about 7.5", "known of this liquid"}, {"0", "at rest"}},
       {{Integrator::groot_warren, steps}, {Integrator::baoab, steps}},
       [&](const Scheme& scheme, double dt, std::uint64_t seed) {
         const FilmResult r = run_film(liquid(scheme, dt, seed, 100));
         return std::vector<double>{r.density, r.tension, r.normal_pressure};
       }},
      {"bulk",
       {"temperature", "pressure", "viscosity"},
       {"temperature of the bulk (k_BT)", "pressure of the bulk (k_BT/r_c^3)", "viscosity (m/(r_c tau))"},
       {{"1", "set"}, {}, {}},
       {{Integrator::groot_warren, steps}, {Integrator::baoab, steps}},
       [&](const Scheme& scheme, double dt, std::uint64_t seed) {
         const BulkResult r = run_bulk(liquid(scheme, dt, seed, 50));
         return std::vector<double>{r.temperature, r.pressure, r.viscosity};
       }},
      {"sessile",
       {"angle_at_90", "temperature_at_90"},
       {"contact angle, commanded 90 (degrees)", "temperature of that droplet (k_BT)"},
       {{"90", "calibration"}, {"1", "set"}},
       {{Integrator::groot_warren, steps}, {Integrator::baoab, steps}},
       [&](const Scheme& scheme, double dt, std::uint64_t seed) {
         const SessileResult r = sessile(scheme, dt, seed, curve.attraction(90), 90);
         return std::vector<double>{r.angle, r.temperature};
       }},
      {"wetting",
       {"angle_at_-22", "temperature_at_-22"},
       {"contact angle at A_lw -22 (degrees)", "temperature of that droplet (k_BT)"},
       {{}, {"1", "set"}},
       {{Integrator::groot_warren, steps}, {Integrator::baoab, steps}},
       [&](const Scheme& scheme, double dt, std::uint64_t seed) {
         const SessileResult r = sessile(scheme, dt, seed, -22, 38);
         return std::vector<double>{r.angle, r.temperature};
       }},
      {"crossing",
       {"from_-20_to_30", "to_40"},
       {"gradient_R5, x = -20 to 30 (tau)", "gradient_R5, x = -40 to 40 (tau)"},
       {{}, {}},
       {{Integrator::groot_warren, crossing_steps}, {Integrator::baoab, long_crossing_steps}},
       [&](const Scheme& scheme, double dt, std::uint64_t seed) {
         chip::Scene scene = chip::load_scene("gradient_R5");
         scene.parameters.time_step = dt;
         scene.parameters.integrator = scheme.integrator;
         scene.parameters.list_skin = skin_for(dt);
         const Crossing crossing = run_crossing(scene, seed, scene.default_duration);
         return std::vector<double>{crossing.passed.at(30) - crossing.passed.at(-20), crossing.passed.at(40)};
       }}};

  Findings findings;
  for (const Kind& kind : kinds) {
    std::vector<Case> cases;
    for (const Scheme& scheme : schemes)
      for (const double dt : kind.time_steps.at(scheme.integrator))
        cases.push_back({label_of(scheme, dt),
                         [&kind, &scheme, dt](std::uint64_t seed) { return kind.work(scheme, dt, seed); }});
    const Results results =
        run_cases(fmt::format("time_step_{}", kind.name), kind.columns, cases, without_only(options));
    for (std::size_t column = 0; column < kind.columns.size(); ++column)
      for (const Case& one : cases) {
        Finding finding = results.finding(one.label, kind.columns[column], kind.titles[column], 3);
        if (!finding.values.empty())
          findings.push_back(finding.against_theory(kind.known[column]).within(0.02));
      }
  }
  const Findings cost_findings = costs(without_only(options), steps);
  findings.insert(findings.end(), cost_findings.begin(), cost_findings.end());
  return findings;
}

}  // namespace dmf::tools
