#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

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
  double list_skin = 0.25;                 ///< r_c
  std::string calibration = "water_like";  ///< name in config/calibration, a file, or "lan2016"
  std::string scene = "gradient_R5";       ///< crossing: which
  std::string output = ".";                ///< folder for CSV files and results
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

/// The studies. Each prints a table with the paper's numbers beside ours and leaves CSV files in
/// options.output.
void study_contact_angle(const StudyOptions& options);  ///< A_lw -> angle: makes the calibration file
void study_commanded_angle(
    const StudyOptions& options);                ///< commanded against shown angle, through the calibration
void study_liquid(const StudyOptions& options);  ///< temperature, density, surface tension twice, viscosity
void study_crossing(
    const StudyOptions& options);  ///< a droplet on a wettability gradient: time against Lan's
void study_time_step(
    const StudyOptions& options);  ///< what each integrator does to every observable as the step grows

}  // namespace dmf::tools
