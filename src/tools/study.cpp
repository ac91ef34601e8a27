#include "tools/study.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>

#include "chip/configuration.h"
#include "tools/saved_run.h"

namespace dmf::tools {

void apply(const StudyOptions& options, engine::Parameters& parameters) {
  if (options.time_step > 0) parameters.time_step = options.time_step;
  if (options.integrator) parameters.integrator = *options.integrator;
  if (options.list_skin > 0) parameters.list_skin = options.list_skin;
  if (options.lambda > 0) parameters.integrator_lambda = options.lambda;
}

chip::Scene scene_for(const StudyOptions& options, const std::string& name) {
  chip::Scene scene = chip::load_scene(name);
  apply(options, scene.parameters);
  scene.parameters.microparticles.contact = options.contact;
  scene.calibration_file =
      options.calibration == "lan2016" ? "" : chip::find_config("calibration", options.calibration);
  return scene;
}

engine::ContactAngleCurve curve_for(const StudyOptions& options) {
  return options.calibration == "lan2016"
             ? engine::ContactAngleCurve::lan2016()
             : engine::ContactAngleCurve::load(chip::find_config("calibration", options.calibration));
}

std::string options_key(const StudyOptions& options) {
  const StudyOptions usual;
  std::string key;
  if (options.radius > 0) key += fmt::format(" R={}", options.radius);
  if (options.time_step > 0) key += fmt::format(" dt={}", options.time_step);
  if (options.integrator)
    key += *options.integrator == engine::Integrator::baoab ? " baoab" : " groot_warren";
  if (options.lambda > 0) key += fmt::format(" lambda={}", options.lambda);
  if (options.calibration != usual.calibration) {
    const std::string name = std::filesystem::path(options.calibration).stem().string();
    key += fmt::format(" calibration={}", name);
  }
  if (options.contact == engine::ContactModel::coulomb) key += " coulomb";
  if (options.quick) key += " quick";
  return key;
}

void shorten_the_approach(chip::Scene& scene) {
  scene.settle_time = 5;
  if (scene.microparticles.empty()) return;
  engine::DropletPlacement& droplet = scene.droplets.at(0);
  double first = scene.parameters.domain.upper.x();
  for (const auto& body : scene.microparticles) first = std::min(first, body.center.x() - body.radius);
  // 1 r_c apart is as near as the engine lets them be placed.
  droplet.center.x() = first - droplet.radius - 1;
}

namespace {

/// "R=5" is called by its whole name or by its value.
bool names(const std::string& said, const std::string& label) {
  return said == label || (label.size() > said.size() &&
                           label.compare(label.size() - said.size() - 1, std::string::npos, "=" + said) == 0);
}

}  // namespace

bool is_wanted(const StudyOptions& options, const std::string& label) {
  return options.only.empty() || std::any_of(options.only.begin(), options.only.end(),
                                             [&](const std::string& said) { return names(said, label); });
}

void require_known(const StudyOptions& options, const std::vector<std::string>& labels) {
  for (const std::string& said : options.only)
    if (std::none_of(labels.begin(), labels.end(),
                     [&](const std::string& label) { return names(said, label); }))
      throw std::runtime_error(fmt::format("--only: {}, allowed: {}", said, fmt::join(labels, ", ")));
}

StudyOptions without_only(StudyOptions options) {
  options.only.clear();
  return options;
}

const std::vector<Study>& all_studies() {
  static const std::vector<Study> all = [] {
    std::vector<Study> studies{
        {"liquid", "temperature, density, surface tension, viscosity", study_liquid},
        {"contact_angle", "wall attraction -> contact angle; writes calibration.yaml", study_contact_angle},
        {"commanded_angle", "commanded against shown angle, through the calibration", study_commanded_angle},
        {"crossing", "a droplet on a wettability gradient, time against Lan's", study_crossing},
        {"dpd_liquid", "plain DPD: viscosity, diffusivity, Schmidt number against kinetic theory",
         study_dpd_liquid},
        {"equation_of_state", "pressure against density, with a van der Waals fit", study_equation_of_state},
        {"interfacial_tension", "two liquids that don't mix, against Chen's value and Groot and Warren's fit",
         study_interfacial_tension},
        {"poiseuille", "plain DPD in a channel, 3D and 2D, against Lan's and the parabola", study_poiseuille},
        {"boundaries", "every kind of side: slip, density and temperature at it, and whether it holds",
         study_boundaries},
        {"square_channel", "plain DPD along a square channel against the series, mass flow against Chen's",
         study_square_channel},
        {"young", "two liquids on a wall: contact angle against Young's and Chen's", study_young},
        {"plugs", "a plug of one liquid in another, driven along a square channel", study_plugs},
        {"thin_film", "droplets too flat for a circle: contact angle by volume and height", study_thin_film},
        {"structured_wall", "a droplet on ridges: angle against Cassie-Baxter, front, velocity over spacing",
         study_structured_wall},
        {"infiltration", "liquid that goes into a slit or between grains, by itself or pushed",
         study_infiltration},
        {"chain", "chains: random walks, relaxation, good solvent, pulled, in a channel", study_chain},
        {"sloping_channel", "chains in a flow through a channel that narrows: what stretches them",
         study_sloping_channel},
        {"membrane", "membranes: what they keep, what leaks, a deflated sphere, a red cell", study_membrane},
        {"constriction", "a red cell goes through a throat: shape, area, volume, what leaks",
         study_constriction},
        {"surfactant", "dimers in a surface: tension over coverage, a floating microparticle",
         study_surfactant},
        {"plates", "pressure of a droplet between two plates against Laplace's, and what it keeps off",
         study_plates},
        {"splitting", "between two plates: up to which gap over pitch a droplet splits", study_splitting},
        {"transport_velocity", "how fast a droplet moves along electrodes under what voltage",
         study_transport_velocity},
        {"protocols", "success rate of the controller's protocols, with faults too", study_protocols},
        {"time_step", "every observable against the time step, both integrators; cost of a tau",
         study_time_step, false},
        {"microparticle_angle", "attraction -> contact angle, floating in a film; writes microparticle.yaml",
         study_microparticle_angle}};
    for (const Study& study : transport_studies()) studies.push_back(study);
    studies.push_back({"forces", "drive, friction and velocity of a microparticle at places of the gradient",
                       study_forces});
    studies.push_back({"inner_flow", "flow of the liquid around a microparticle", study_inner_flow});
    return studies;
  }();
  return all;
}

void write_findings(const std::string& study, const Findings& findings, const StudyOptions& options) {
  replace_file(fmt::format("{}/{}.csv", options.output, study), as_csv(findings));
}

bool draw_figure(const std::string& study, const StudyOptions& options) {
  std::error_code ignored;
  std::string scripts = std::filesystem::is_directory(DMF_SOURCE_SCRIPTS_DIR, ignored)
                            ? DMF_SOURCE_SCRIPTS_DIR
                            : DMF_INSTALL_SCRIPTS_DIR;
  // -B: leaves nothing beside the script.
  std::array<std::string, 5> words{"/usr/bin/python3", "-B", scripts + "/plot_study.py", study,
                                   options.output};
  std::array<char*, words.size() + 1> arguments{};
  std::transform(words.begin(), words.end(), arguments.begin(),
                 [](std::string& word) { return word.data(); });
  pid_t process = 0;
  int status = 1;
  return posix_spawn(&process, words[0].c_str(), nullptr, nullptr, arguments.data(), environ) == 0 &&
         waitpid(process, &status, 0) == process && status == 0;
}

}  // namespace dmf::tools
