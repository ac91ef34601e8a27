#include "tools/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "chip/configuration.h"
#include "engine/simulation.h"

namespace dmf::tools {

MeanAndSpread mean_and_spread(const std::vector<double>& values) {
  MeanAndSpread result;
  const double count = static_cast<double>(values.size());
  for (const double value : values) result.mean += value / count;
  if (values.size() < 2) return result;
  double squares = 0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  result.deviation = std::sqrt(squares / (count - 1));
  result.standard_error = result.deviation / std::sqrt(count);
  return result;
}

std::string integrator_key(engine::Integrator integrator) {
  return integrator == engine::Integrator::baoab ? " baoab" : "";
}

chip::Scene scene_for(const StudyOptions& options, const std::string& name) {
  chip::Scene scene = chip::load_scene(name);
  scene.parameters.time_step = options.time_step;
  scene.parameters.integrator = options.integrator;
  if (options.list_skin > 0) scene.parameters.list_skin = options.list_skin;
  if (options.lambda > 0) scene.parameters.integrator_lambda = options.lambda;
  scene.parameters.microparticles.contact = options.contact;
  scene.calibration_file =
      options.calibration == "lan2016" ? "" : chip::find_config("calibration", options.calibration);
  return scene;
}

std::string options_key(const StudyOptions& options) {
  const StudyOptions usual;
  std::string key;
  if (options.time_step != usual.time_step) key += fmt::format(" dt={}", options.time_step);
  key += integrator_key(options.integrator);
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

bool is_wanted(const StudyOptions& options, const std::string& label) {
  return options.only.empty() ||
         std::find(options.only.begin(), options.only.end(), label) != options.only.end();
}

void require_known(const StudyOptions& options, const std::vector<std::string>& labels) {
  for (const std::string& label : options.only)
    if (std::find(labels.begin(), labels.end(), label) == labels.end())
      throw std::runtime_error(fmt::format("--only: {}, allowed: {}", label, fmt::join(labels, ", ")));
}

ResultTable::ResultTable(const std::string& file, std::vector<std::string> columns) : file_(file) {
  const std::string header = fmt::format("run,{}", fmt::join(columns, ","));
  if (const auto folder = std::filesystem::path(file).parent_path(); !folder.empty())
    std::filesystem::create_directories(folder);
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line)) {
    std::ofstream(file) << header << "\n";
    return;
  }
  if (line != header) throw std::runtime_error(fmt::format("{}: holds other results; move it away", file));
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    std::string key, field;
    std::getline(fields, key, ',');
    std::vector<double> values;
    while (std::getline(fields, field, ',')) values.push_back(std::strtod(field.c_str(), nullptr));
    // The last line of a killed study may be cut: it is done again.
    if (values.size() == columns.size()) rows_[key] = values;
  }
}

bool ResultTable::has(const std::string& key) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return rows_.count(key) > 0;
}

const std::vector<double>& ResultTable::row(const std::string& key) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return rows_.at(key);
}

void ResultTable::add(const std::string& key, const std::vector<double>& values) {
  const std::lock_guard<std::mutex> lock(mutex_);
  rows_[key] = values;
  std::ofstream(file_, std::ios::app) << key << "," << fmt::format("{:.10g}", fmt::join(values, ",")) << "\n";
}

void run_jobs(const std::string& title, const std::vector<Job>& jobs, const StudyOptions& options,
              ResultTable& table) {
  std::vector<const Job*> missing;
  for (const Job& job : jobs)
    if (!table.has(job.key)) missing.push_back(&job);
  fmt::print(stderr, "{}: {} runs, {} of them done before\n", title, jobs.size(),
             jobs.size() - missing.size());

  std::atomic<std::size_t> next{0};
  std::size_t done = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto start = std::chrono::steady_clock::now();
  const auto worker = [&] {
    for (std::size_t k = next++; k < missing.size(); k = next++) {
      try {
        table.add(missing[k]->key, missing[k]->work());
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!failure) failure = std::current_exception();
        next = missing.size();
        return;
      }
      const std::lock_guard<std::mutex> lock(mutex);
      ++done;
      const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      fmt::print(stderr, "{}: {} of {} done, {:.0f} s, about {:.0f} s left ({})\n", title, done,
                 missing.size(), elapsed,
                 elapsed / static_cast<double>(done) * static_cast<double>(missing.size() - done),
                 missing[k]->key);
    }
  };
  std::vector<std::thread> threads;
  for (int k = 0; k < options.jobs; ++k) threads.emplace_back(worker);
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

std::vector<double> row_or_nan(const std::string& key, std::size_t columns,
                               const std::function<std::vector<double>()>& work) {
  try {
    return work();
  } catch (const engine::Instability& problem) {
    fmt::print(stderr, "{}: {}\n", key, problem.what());
    return std::vector<double>(columns, NAN);
  }
}

}  // namespace dmf::tools
