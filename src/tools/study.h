#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "chip/scene.h"
#include "engine/parameters.h"
#include "engine/wettability.h"
#include "tools/finding.h"

namespace dmf::tools {

/// What every study is told on the command line.
struct StudyOptions {
  int seeds = 3;          ///< 1 .. seeds
  int jobs = 1;           ///< runs at a time, each a process with one thread
  bool quick = false;     ///< a short form: shows that it works, not what the number is
  bool recorded = false;  ///< nothing is run: what stands in the folder's CSV files is reported
  double radius = 0;      ///< of the droplet, r_c; 0: the study's own
  double time_step = 0;   ///< tau; 0: the study's or scene's own
  double lambda = 0;      ///< of the integrator; 0: the study's or scene's own
  std::optional<engine::Integrator> integrator;  ///< none: the study's or scene's own
  double list_skin = 0;                          ///< r_c; 0: the scene's, or the engine's default
  std::string calibration = "water_like";        ///< name in config/calibration, a file, or "lan2016"
  engine::ContactModel contact = engine::ContactModel::lan2016;  ///< studies of microparticles
  std::vector<std::string> only;                                 ///< of what is varied; empty: all
  std::string output = ".";                                      ///< folder for CSV files and results

  double time_step_or(double own) const { return time_step > 0 ? time_step : own; }
  double radius_or(double own) const { return radius > 0 ? radius : own; }
};

/// Takes over what the command line says of time step, integrator and cells.
void apply(const StudyOptions& options, engine::Parameters& parameters);

/// A scene of config/scenes with what the command line says of time step, integrator, calibration and
/// contact.
chip::Scene scene_for(const StudyOptions& options, const std::string& name);
/// The calibration that the command line names.
engine::ContactAngleCurve curve_for(const StudyOptions& options);
/// What a run's key says of all that, where it is not the default: " dt=0.005 coulomb quick".
std::string options_key(const StudyOptions& options);

/// The droplet starts beside the first microparticle in its way, after a short rest: it is picked up soon and
/// for sure.
void shorten_the_approach(chip::Scene& scene);

/// Is this value among those asked for by --only?
bool is_wanted(const StudyOptions& options, const std::string& label);
/// @throws std::runtime_error when --only names a value that the study does not vary.
void require_known(const StudyOptions& options, const std::vector<std::string>& labels);
/// For the parts of a study that --only does not choose from.
StudyOptions without_only(StudyOptions options);

/// A study: runs what has not been run yet, leaves a line a run in options.output, and tells what it has
/// found.
struct Study {
  std::string name, about;
  std::function<Findings(const StudyOptions&)> run;
  bool about_the_papers = true;  ///< stands in the table of docs/validation.md
};

/// All of them, in the order of docs/validation.md.
const std::vector<Study>& all_studies();
/// What a study has found, as NAME.csv in options.output.
void write_findings(const std::string& study, const Findings& findings, const StudyOptions& options);
/// Draws that, with the paper's numbers beside, as NAME.png in options.output: scripts/plot_study.py does,
/// which says on standard error why when it can't. @returns whether it could.
bool draw_figure(const std::string& study, const StudyOptions& options);

/// A_lw -> angle: makes the calibration file.
Findings study_contact_angle(const StudyOptions& options);
/// Commanded against shown angle, through the calibration.
Findings study_commanded_angle(const StudyOptions& options);
/// Temperature, density, surface tension twice, viscosity.
Findings study_liquid(const StudyOptions& options);
/// Plain DPD against kinetic theory (Liu table 1).
Findings study_dpd_liquid(const StudyOptions& options);
/// Pressure against density, with a van der Waals fit (Liu 3.3.2).
Findings study_equation_of_state(const StudyOptions& options);
/// Two liquids that don't mix: tension against Chen's value and Groot and Warren's fit.
Findings study_interfacial_tension(const StudyOptions& options);
/// Plain DPD between walls, driven by a body force (Lan 2.3).
Findings study_poiseuille(const StudyOptions& options);
Findings study_boundaries(const StudyOptions& options);
/// Plain DPD along a duct (Chen 3.1).
Findings study_square_channel(const StudyOptions& options);
/// A plug of one liquid in another: angle on walls against Young's (Chen 3.3.1).
Findings study_young(const StudyOptions& options);
/// The same driven along a square channel: angles, shape, velocity (Chen 3.3.2).
Findings study_plugs(const StudyOptions& options);
/// Flat droplets on well-wetting walls: angle by volume and edge or mean height (Lan 5.2.9).
Findings study_thin_film(const StudyOptions& options);
/// A droplet on ridges: static angle against Cassie and Baxter, front and velocity under a force (Yao).
Findings study_structured_wall(const StudyOptions& options);
/// Liquid that goes into pores, by itself or pushed, over the contact angle (Liu 4.2).
Findings study_infiltration(const StudyOptions& options);
/// Chains: random walks, Rouse's time, good solvent, force and extension, in a channel (Liu 3.4, 4.3).
Findings study_chain(const StudyOptions& options);
/// Chains that a flow drives through a channel that narrows, over the slope of its walls (Liu 4.3).
Findings study_sloping_channel(const StudyOptions& options);
/// Membranes: what they keep and what leaks, red cell, deflated sphere (Liu 4.4).
Findings study_membrane(const StudyOptions& options);
/// A red cell that a flow drives through a throat (Liu 4.4).
Findings study_constriction(const StudyOptions& options);
/// Dimers in the surface of a film: tension over coverage, a floating microparticle (Lan 5.2.4).
Findings study_surfactant(const StudyOptions& options);
/// A droplet on a wettability gradient: time against Lan's.
Findings study_crossing(const StudyOptions& options);
/// How long droplets of R = 5 take from x = -40 to 40, tau, by what is recorded of that study in
/// options.output.
std::vector<double> recorded_crossings(StudyOptions options);
/// A_ls -> contact angle of a floating microparticle: makes its calibration file.
Findings study_microparticle_angle(const StudyOptions& options);
/// A droplet between two plates: pressure against Laplace's, and what it keeps off the plates.
Findings study_plates(const StudyOptions& options);
/// Up to which gap over pitch a droplet between two plates splits.
Findings study_splitting(const StudyOptions& options);
/// How fast a droplet moves along electrodes under what voltage.
Findings study_transport_velocity(const StudyOptions& options);
/// Protocols of config/protocols on scenes, some with faults: how often each works over seeds, judged by
/// where the droplets are in the simulation.
Findings study_protocols(const StudyOptions& options);
/// Forces on a microparticle and its velocity at places of the gradient that it is held at.
Findings study_forces(const StudyOptions& options);
/// Flow of the liquid around a microparticle, and in a droplet without one.
Findings study_inner_flow(const StudyOptions& options);
/// What each integrator does to every observable as the step grows.
Findings study_time_step(const StudyOptions& options);
/// Microparticles on their way: a scene, what is varied in it, what is measured. Each leaves a record of
/// every run in runs/ besides.
std::vector<Study> transport_studies();

}  // namespace dmf::tools
