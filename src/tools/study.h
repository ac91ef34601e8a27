#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "chip/scene.h"
#include "engine/parameters.h"

namespace dmf::tools {

/// What every study is told on the command line.
struct StudyOptions {
  int seeds = 3;            ///< 1 .. seeds
  int jobs = 1;             ///< runs at a time, each on one thread
  bool quick = false;       ///< a short form: shows that it works, not what the number is
  double radius = 0;        ///< of the droplet, r_c; 0: the study's own
  double time_step = 0.01;  ///< tau
  double lambda = 0;        ///< of the integrator; 0: the engine's default
  engine::Integrator integrator = engine::Integrator::groot_warren;
  double list_skin = 0;                    ///< r_c; 0: the scene's, or the engine's default
  std::string calibration = "water_like";  ///< name in config/calibration, a file, or "lan2016"
  std::string scene = "gradient_R5";       ///< crossing: which
  engine::ContactModel contact = engine::ContactModel::lan2016;  ///< studies of microparticles
  std::vector<std::string> only;                                 ///< of what is varied; empty: all
  std::string output = ".";                                      ///< folder for CSV files and results
};

/// One number with its spread over seeds.
struct MeanAndSpread {
  double mean = 0;
  double deviation = 0;       ///< sample standard deviation; 0 for one value
  double standard_error = 0;  ///< deviation / sqrt(n)
};
MeanAndSpread mean_and_spread(const std::vector<double>& values);

/// What a run's key says of its integrator: " baoab", or nothing for the default.
std::string integrator_key(engine::Integrator integrator);

/// A scene of config/scenes with what the command line says of time step, integrator, calibration and
/// contact.
chip::Scene scene_for(const StudyOptions& options, const std::string& name);
/// What a run's key says of all that, where it is not the default: " dt=0.005 coulomb quick".
std::string options_key(const StudyOptions& options);

/// The droplet starts beside the first microparticle in its way, after a short rest: it is picked up soon and
/// for sure.
void shorten_the_approach(chip::Scene& scene);

/// Is this value among those asked for by --only?
bool is_wanted(const StudyOptions& options, const std::string& label);
/// @throws std::runtime_error when --only names a value that the study does not vary.
void require_known(const StudyOptions& options, const std::vector<std::string>& labels);

/// Results of runs, one a line in a CSV file, written as soon as they are there: a study that was killed goes
/// on where it was. A run is known by its key, such as "A=-15 R=10 seed=2". Thread-safe.
class ResultTable {
 public:
  /// Reads what an earlier call has left. @throws std::runtime_error when the file has other columns.
  ResultTable(const std::string& file, std::vector<std::string> columns);

  bool has(const std::string& key) const;
  const std::vector<double>& row(const std::string& key) const;
  void add(const std::string& key, const std::vector<double>& values);

 private:
  std::string file_;
  mutable std::mutex mutex_;
  std::map<std::string, std::vector<double>> rows_;
};

/// One run of a study.
struct Job {
  std::string key;
  std::function<std::vector<double>()> work;  ///< gives the row; single-threaded
};

/// Does the jobs that the table does not hold yet, `options.jobs` at a time, with a progress line with time
/// left on standard error. An exception of a job ends the study after the running ones and is thrown again.
void run_jobs(const std::string& title, const std::vector<Job>& jobs, const StudyOptions& options,
              ResultTable& table);

/// What the work gives; all NaN, with a word on standard error, when the run has become unstable.
std::vector<double> row_or_nan(const std::string& key, std::size_t columns,
                               const std::function<std::vector<double>()>& work);

/// The studies. Each prints a table with the paper's numbers beside ours and leaves CSV files in
/// options.output.
void study_contact_angle(const StudyOptions& options);  ///< A_lw -> angle: makes the calibration file
void study_commanded_angle(
    const StudyOptions& options);                ///< commanded against shown angle, through the calibration
void study_liquid(const StudyOptions& options);  ///< temperature, density, surface tension twice, viscosity
void study_dpd_liquid(const StudyOptions& options);  ///< plain DPD against kinetic theory (Liu table 1)
void study_equation_of_state(
    const StudyOptions& options);  ///< pressure against density, with a van der Waals fit (Liu 3.3.2)
/// Two liquids that don't mix: tension against Chen's value and Groot and Warren's fit.
void study_interfacial_tension(const StudyOptions& options);
void study_poiseuille(
    const StudyOptions& options);  ///< plain DPD between walls, driven by a body force (Lan 2.3)
void study_crossing(
    const StudyOptions& options);  ///< a droplet on a wettability gradient: time against Lan's
void study_time_step(
    const StudyOptions& options);  ///< what each integrator does to every observable as the step grows

/// Protocols of config/protocols on scenes, some with faults: how often each works over seeds, judged by
/// where the droplets are in the simulation.
void study_protocols(const StudyOptions& options);

/// A_ls -> contact angle of a floating microparticle: makes its calibration file.
void study_microparticle_angle(const StudyOptions& options);

/// Studies of microparticles on their way: a scene, what is varied in it, what is measured. All in one table
/// in studies/transport.cpp; study_transport() does the one of that name. They leave NAME_runs.csv (a line a
/// run), NAME.csv (means) and a record of every run in runs/.
struct StudyTitle {
  std::string name, about;
};
std::vector<StudyTitle> transport_studies();
void study_transport(const std::string& name, const StudyOptions& options);

/// Forces on a microparticle and its velocity at places of the gradient that it is held at.
void study_forces(const StudyOptions& options);
/// Flow of the liquid around a microparticle, and in a droplet without one.
void study_inner_flow(const StudyOptions& options);
/// Chains: random walks, Rouse's time, good solvent, force and extension, in a channel (Liu 3.4, 4.3).
void study_chain(const StudyOptions& options);
/// Membranes: what they keep and what leaks, red cell, deflated sphere (Liu 4.4).
void study_membrane(const StudyOptions& options);
void study_plates(const StudyOptions& options);
void study_splitting(const StudyOptions& options);
/// A droplet on ridges: static angle against Cassie and Baxter, front and velocity under a force (Yao).
void study_structured_wall(const StudyOptions& options);
/// Liquid that goes into pores, by itself or pushed, over the contact angle (Liu 4.2).
void study_infiltration(const StudyOptions& options);
void study_square_channel(const StudyOptions& options);  ///< plain DPD along a duct (Chen 3.1)
void study_transport_velocity(const StudyOptions& options);

}  // namespace dmf::tools
