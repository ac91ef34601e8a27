// dmf_study NAME: the measurements behind what the package claims, over seeds, with spread.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <map>

#include "tools/study.h"

namespace {

using namespace dmf::tools;

void report(const Study& study, const StudyOptions& options) {
  const Findings findings = study.run(options);
  fmt::print("{}: {}\n{}", study.name, study.about, as_text(findings));
  write_findings(study.name, findings, options);
  const std::string written = fmt::format("{}/{}", options.output, study.name);
  // Of what is recorded the figure may be drawn from more than stands there: it is left as it is.
  if (options.recorded || !draw_figure(study.name, options))
    fmt::print("written: {}.csv\n", written);
  else
    fmt::print("written: {0}.csv, {0}.png\n", written);
}

/// The table of docs/validation.md, of what is recorded in a folder.
void print_table(StudyOptions options) {
  options.recorded = true;
  fmt::print(
      "| study, case | quantity | paper | theory | ours | runs | verdict | computing, s a run |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Study& study : all_studies()) {
    if (!study.about_the_papers) continue;
    Findings findings = study.run(options);
    for (Finding& finding : findings) finding.study = study.name;
    fmt::print("{}", as_markdown(findings));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::map<std::string, dmf::engine::Integrator> integrators{
      {"groot_warren", dmf::engine::Integrator::groot_warren}, {"baoab", dmf::engine::Integrator::baoab}};
  const std::map<std::string, dmf::engine::ContactModel> contacts{
      {"lan2016", dmf::engine::ContactModel::lan2016}, {"coulomb", dmf::engine::ContactModel::coulomb}};
  std::map<std::string, const Study*> studies;
  std::string titles;
  for (const Study& study : all_studies()) {
    studies[study.name] = &study;
    titles += fmt::format("  {:<20} {}\n", study.name, study.about);
  }
  studies["table"] = nullptr;
  CLI::App app(
      "Studies of dmf_sim.\n" + titles +
      "  table                of all of them, what is recorded in --out, as docs/validation.md has it\n"
      "A study that was stopped goes on where it was: finished runs stand in its CSV files, and runs of\n"
      "microparticles save themselves every minute.");
  std::string name;
  StudyOptions options;
  dmf::engine::Integrator integrator{};
  app.add_option("name", name, "study")->required()->check(CLI::IsMember(studies));
  app.add_option("--seeds", options.seeds, "runs for the spread")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--jobs", options.jobs, "runs at a time")->check(CLI::Range(1, 1024))->capture_default_str();
  app.add_option("--radius", options.radius, "of the droplet, r_c (default: the study's)")
      ->check(CLI::Range(3.0, 40.0));
  app.add_option("--time-step", options.time_step, "tau (default: the study's)")
      ->check(CLI::Range(1e-4, 0.1));
  app.add_option("--lambda", options.lambda, "of the integrator (default: the study's)")
      ->check(CLI::Range(0.5, 1.0));
  const CLI::Option* const chosen =
      app.add_option("--integrator", integrator, "groot_warren or baoab (default: the study's)")
          ->transform(CLI::CheckedTransformer(integrators));
  app.add_option("--skin", options.list_skin,
                 "how much wider than r_c the sorting cells are, r_c (default: the scene's)")
      ->check(CLI::Range(0.05, 1.0));
  app.add_option("--calibration", options.calibration, "name, file, or lan2016")->capture_default_str();
  app.add_option("--contact", options.contact, "of microparticles with the wall: lan2016 or coulomb")
      ->transform(CLI::CheckedTransformer(contacts));
  app.add_option("--only", options.only, "some cases, by name or by value: R=5 or 5")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--out", options.output, "folder for CSV files and the figure")->capture_default_str();
  app.add_flag("--quick", options.quick, "short runs that show that it works");
  app.add_flag("--recorded", options.recorded, "run nothing, report what is recorded in --out");
  CLI11_PARSE(app, argc, argv);
  if (*chosen) options.integrator = integrator;
  try {
    if (name == "table")
      print_table(options);
    else
      report(*studies.at(name), options);
  } catch (const std::exception& problem) {
    fmt::print(stderr, "dmf_study: {}\n", problem.what());
    return 1;
  }
  return 0;
}
