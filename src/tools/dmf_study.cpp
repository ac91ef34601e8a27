// dmf_study NAME: the measurements behind what the package claims, over seeds, with spread.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <functional>
#include <map>

#include "tools/study.h"

int main(int argc, char** argv) {
  using namespace dmf::tools;
  std::map<std::string, std::function<void(const StudyOptions&)>> studies{
      {"contact_angle", study_contact_angle},
      {"commanded_angle", study_commanded_angle},
      {"liquid", study_liquid},
      {"dpd_liquid", study_dpd_liquid},
      {"equation_of_state", study_equation_of_state},
      {"interfacial_tension", study_interfacial_tension},
      {"poiseuille", study_poiseuille},
      {"crossing", study_crossing},
      {"time_step", study_time_step},
      {"protocols", study_protocols},
      {"microparticle_angle", study_microparticle_angle},
      {"forces", study_forces},
      {"inner_flow", study_inner_flow},
      {"plates", study_plates},
      {"chain", study_chain},
      {"membrane", study_membrane},
      {"splitting", study_splitting},
      {"square_channel", study_square_channel},
      {"infiltration", study_infiltration},
      {"structured_wall", study_structured_wall},
      {"transport_velocity", study_transport_velocity}};
  std::string transport_titles;
  for (const StudyTitle& study : transport_studies()) {
    studies[study.name] = [name = study.name](const StudyOptions& options) {
      study_transport(name, options);
    };
    transport_titles += fmt::format("  {:<16} {}\n", study.name, study.about);
  }
  const std::map<std::string, dmf::engine::Integrator> integrators{
      {"groot_warren", dmf::engine::Integrator::groot_warren}, {"baoab", dmf::engine::Integrator::baoab}};
  const std::map<std::string, dmf::engine::ContactModel> contacts{
      {"lan2016", dmf::engine::ContactModel::lan2016}, {"coulomb", dmf::engine::ContactModel::coulomb}};
  CLI::App app(
      "Studies of dmf_sim.\n"
      "  contact_angle    wall attraction -> contact angle; writes calibration.yaml\n"
      "  commanded_angle  commanded against shown angle, through the calibration\n"
      "  liquid           temperature, density, surface tension, viscosity\n"
      "  dpd_liquid       plain DPD: viscosity, diffusivity, Schmidt number against kinetic theory\n"
      "  equation_of_state  pressure against density, with a van der Waals fit\n"
      "  interfacial_tension  two liquids that don't mix, against Chen's value and Groot and Warren's fit\n"
      "  poiseuille       plain DPD in a channel, 3D and 2D, against Lan's and the parabola\n"
      "  crossing         a droplet on a wettability gradient, time against Lan's\n"
      "  time_step        every observable against the time step, both integrators; cost of a tau\n"
      "  plates           pressure of a droplet between two plates against Laplace's, and what it keeps off\n"
      "  splitting        between two plates: up to which gap over pitch a droplet splits\n"
      "  square_channel   plain DPD along a square channel against the series, mass flow against Chen's\n"
      "  structured_wall  a droplet on ridges: angle against Cassie-Baxter, front, velocity over spacing\n"
      "  infiltration     liquid that goes into a slit or between grains, by itself or pushed\n"
      "  transport_velocity  how fast a droplet moves along electrodes under what voltage\n"
      "  protocols        success rate of the controller's protocols, with faults too\n"
      "  chain            chains: random walks, relaxation, good solvent, pulled, in a channel\n"
      "  membrane         membranes: what they keep, what leaks, a deflated sphere, a red cell\n"
      "Microparticles:\n"
      "  microparticle_angle  attraction -> contact angle, floating in a film; writes microparticle.yaml\n" +
      transport_titles +
      "  forces           drive, friction and velocity at places of the gradient\n"
      "  inner_flow       flow of the liquid around a microparticle\n"
      "A study that was stopped goes on where it was: finished runs stand in its CSV files, and runs of\n"
      "microparticles save themselves every minute.");
  std::string name;
  StudyOptions options;
  app.add_option("name", name, "study")->required()->check(CLI::IsMember(studies));
  app.add_option("--seeds", options.seeds, "runs for the spread")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--jobs", options.jobs, "runs at a time")->check(CLI::Range(1, 1024))->capture_default_str();
  app.add_option("--radius", options.radius, "of the droplet, r_c (default: the study's)")
      ->check(CLI::Range(3.0, 40.0));
  app.add_option("--time-step", options.time_step, "tau")
      ->check(CLI::Range(1e-4, 0.1))
      ->capture_default_str();
  app.add_option("--lambda", options.lambda, "of the integrator (default: the engine's)")
      ->check(CLI::Range(0.5, 1.0));
  app.add_option("--integrator", options.integrator, "groot_warren or baoab")
      ->transform(CLI::CheckedTransformer(integrators));
  app.add_option("--skin", options.list_skin,
                 "how much wider than r_c the sorting cells are, r_c (default: the scene's)")
      ->check(CLI::Range(0.05, 1.0));
  app.add_option("--calibration", options.calibration, "name, file, or lan2016")->capture_default_str();
  app.add_option("--contact", options.contact, "of microparticles with the wall: lan2016 or coulomb")
      ->transform(CLI::CheckedTransformer(contacts));
  app.add_option("--only", options.only, "some of what a study of microparticles varies, such as -15,-19")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--scene", options.scene, "for crossing")->capture_default_str();
  app.add_option("--out", options.output, "folder for CSV files")->capture_default_str();
  app.add_flag("--quick", options.quick, "short runs that show that it works");
  CLI11_PARSE(app, argc, argv);
  try {
    studies.at(name)(options);
  } catch (const std::exception& problem) {
    fmt::print(stderr, "dmf_study: {}\n", problem.what());
    return 1;
  }
  return 0;
}
