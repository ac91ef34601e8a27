#include <fmt/format.h>

#include <fstream>
#include <optional>
#include <vector>

#include "tools/cases.h"
#include "tools/floating.h"
#include "tools/saved_run.h"
#include "tools/surfactant.h"

namespace dmf::tools {
namespace {

const std::vector<double> coverages{0, 0.25, 0.5, 1, 1.5, 2};  // of a film's surface, 1 / r_c^2

/// A microparticle on a film.
struct Floated {
  double attraction;              ///< A_ls
  double coverage;                ///< 1 / r_c^2
  std::optional<double> tails{};  ///< attraction of tails with it in place of A_ls
};
/// Lan's hydrophobic one, which the film swallows by itself, and one that floats at 109 degrees: with a
/// surfactant whose tails have with it what the liquid has, and with ever more that hold on to it.
const std::vector<Floated> floated{{-15, 0},     {-15, 1},     {-6, 0},      {-6, 1},
                                   {-6, 1, -15}, {-6, 1, -25}, {-6, 1, -35}, {-6, 2, -25}};

std::string label_of(double coverage) { return fmt::format("coverage={:g}", coverage); }
std::string label_of(const Floated& one) {
  std::string label = fmt::format("floating A={:g} coverage={:g}", one.attraction, one.coverage);
  return one.tails ? label + fmt::format(" tails={:g}", *one.tails) : label;
}

SurfactantFilmRun film_of(const StudyOptions& options, double coverage, std::uint64_t seed) {
  SurfactantFilmRun run;
  run.coverage = coverage;
  run.seed = seed;
  run.integrator = options.integrator.value_or(engine::Integrator::baoab);
  run.time_step = options.time_step_or(0.025);
  run.settle = options.quick ? 5 : 100;
  run.measure = options.quick ? 5 : 200;
  return run;
}

/// Density and orientation across the film, for a figure.
void write_profile(const StudyOptions& options, double coverage, std::uint64_t seed,
                   const SurfactantFilmResult& result) {
  std::ofstream csv(fmt::format("{}/surfactant_{}_seed{}.csv", options.output,
                                file_name(label_of(coverage) + options_key(options)), seed));
  csv << "out,liquid,heads,tails,orientation\n";
  for (const SurfactantFilmResult::Slab& slab : result.profile)
    csv << fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", slab.out, slab.liquid, slab.heads, slab.tails,
                       slab.orientation);
}

Results run_films(const StudyOptions& options) {
  std::vector<Case> cases;
  for (const double coverage : coverages)
    cases.push_back({label_of(coverage), [=, &options](std::uint64_t seed) {
                       const SurfactantFilmResult r = run_surfactant_film(film_of(options, coverage, seed));
                       write_profile(options, coverage, seed, r);
                       return std::vector<double>{r.tension, r.at_surface, r.orientation, r.temperature};
                     }});
  return run_cases("surfactant_film", {"tension", "at_surface", "orientation", "temperature"}, cases,
                   options);
}

Results run_floated(const StudyOptions& options) {
  std::vector<Case> cases;
  for (const Floated& one : floated)
    cases.push_back({label_of(one), [=, &options](std::uint64_t seed) {
                       FloatingRun run;
                       run.attraction = one.attraction;
                       run.surfactant = one.coverage;
                       run.tail_attraction = one.tails;
                       run.seed = seed;
                       run.parameters.time_step = options.time_step_or(run.parameters.time_step);
                       if (options.quick) run.settle = run.measure = 10;
                       const FloatingResult r = run_floating(run);
                       return std::vector<double>{r.height, r.immersion, r.angle};
                     }});
  return run_cases("surfactant_floating", {"height", "immersion", "angle"}, cases, options);
}

}  // namespace

Findings study_surfactant(const StudyOptions& options) {
  std::vector<std::string> labels;
  for (const double coverage : coverages) labels.push_back(label_of(coverage));
  for (const Floated& one : floated) labels.push_back(label_of(one));
  require_known(options, labels);
  // --only chooses among both parts.
  StudyOptions films = options, floats = options;
  films.only.clear();
  floats.only.clear();
  for (const std::string& one : labels)
    if (is_wanted(options, one)) (one.rfind("floating", 0) == 0 ? floats : films).only.push_back(one);
  Findings findings;
  if (!films.only.empty()) {
    const Results results = run_films(films);
    const double clean = results.mean(label_of(0), "tension").mean;
    for (const double coverage : coverages) {
      const std::string of = label_of(coverage);
      findings.push_back(results.finding(of, "tension", "surface tension (k_BT/r_c^2)", 2));
      if (coverage == 0) {
        findings.back().against_theory({"7.54", "the film's without species"});
        continue;
      }
      std::vector<double> pushed;
      for (const double tension : results.of(of, "tension")) pushed.push_back((clean - tension) / coverage);
      // Few of them are a gas in the surface; tensions spread by 0.05.
      Finding pressure =
          results.derived(of, "surface_pressure", "tension falls by, of coverage k_BT", 2, pushed);
      if (coverage == coverages[1]) pressure.against_theory({"1", "a gas in the surface"}).within_margin(0.4);
      findings.push_back(pressure);
      findings.push_back(results.finding(of, "at_surface", "share of dimers at a surface", 3));
      findings.push_back(results.finding(of, "orientation", "cosine of head to tail with outwards", 2));
      findings.push_back(results.finding(of, "temperature", "temperature (k_BT)", 4));
    }
  }
  if (!floats.only.empty()) {
    const Results results = run_floated(floats);
    for (const Floated& one : floated) {
      const std::string of = label_of(one);
      findings.push_back(results.finding(of, "immersion", "immersion of a microparticle", 3));
      findings.push_back(results.finding(of, "height", "its centre over the surface (r_c)", 3));
      findings.push_back(results.finding(of, "angle", "its contact angle, 0 when swallowed (degrees)", 1));
    }
  }
  return findings;
}

}  // namespace dmf::tools
