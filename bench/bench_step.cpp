// What a step costs, in nanoseconds per moving bead and step, and what the scalar double reference costs for
// the same. scripts/bench.sh runs this and lays the results side by side.
//   bench_step [--threads=1,2] [--states=FOLDER] [--skin=0.25] [--benchmark_filter=W3] [...]
//     --threads  thread counts of the best kernel; the others run with one. Default: 1 and all cores
//     --states   where melted liquids are kept for the next call; default: every benchmark melts its own
//     --skin     list_skin, r_c, in place of the engine's default
// Names are workload/kernel/threads:n. Every kernel and thread count starts from the same melted liquid and
// makes the same number of steps, so that repetitions differ by timing noise only.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "engine/simulation.h"
#include "engine/wait_policy.h"

namespace {

using namespace dmf::engine;

struct Workload {
  std::string name;
  Parameters parameters;
  double droplet_radius;       ///< 0: the box is full
  bool microparticle = false;  ///< one of 612 beads at the droplet's foot
};

struct Options {
  std::vector<int> threads;
  std::string states;  ///< folder; empty: keep none
  double list_skin = Parameters().list_skin;
};

Parameters bulk(double size) {
  Parameters parameters;
  parameters.domain.lower = Vector3d::Zero();
  parameters.domain.upper = Vector3d::Constant(size);
  parameters.domain.lower_side =
      parameters.domain.upper_side = {Side::periodic, Side::periodic, Side::periodic};
  parameters.liquid.initial_density = parameters.liquid.bulk_density;
  return parameters;
}

/// A periodic cube of so many fcc cells along each side, four beads a cell.
Parameters bulk_of_cells(int cells) {
  return bulk(cells * std::cbrt(4.0 / Parameters().liquid.bulk_density));
}

Parameters plate() {
  Parameters parameters;
  parameters.domain.lower = {-75, -35, 0};
  parameters.domain.upper = {75, 35, 30};
  return parameters;
}

std::vector<Workload> workloads() {
  return {{"W1_bulk_20", bulk(20), 0},
          {"W2_droplet_R10", plate(), 10},
          {"W3_droplet_R5", plate(), 5},
          {"W3_droplet_R5_microparticle", plate(), 5, true},
          {"W4_bulk_1M", bulk_of_cells(63), 0}};
}

/// Bulk liquids from about a thousand to a million beads, each about twice the one before.
std::vector<Workload> size_sweep() {
  std::vector<Workload> sweep;
  for (const int cells : {6, 8, 11, 14, 18, 23, 29, 37, 46, 63})
    sweep.push_back({"bulk_" + std::to_string(4 * cells * cells * cells), bulk_of_cells(cells), 0, false});
  return sweep;
}

void place(Simulation& simulation, const Workload& workload) {
  simulation.set_wettability([](double, double) { return 110.0; });
  if (workload.droplet_radius > 0)
    simulation.add_droplet({{0, 0, workload.droplet_radius}, workload.droplet_radius});
  else
    simulation.fill_box();
  if (workload.microparticle) {
    MicroparticlePlacement beside;
    beside.center = {5.4, 0};
    simulation.add_microparticle(beside);
  }
}

/// The state of the workload's liquid after its starting lattice has melted.
std::string melted(const Workload& workload, const std::string& folder) {
  const std::string path = folder.empty() ? "" : folder + "/" + workload.name;
  if (std::ifstream kept(path, std::ios::binary); kept)
    return {std::istreambuf_iterator<char>(kept), std::istreambuf_iterator<char>()};
  Simulation simulation(workload.parameters, ContactAngleCurve::lan2016());
  place(simulation, workload);
  const auto beads = static_cast<double>(simulation.observe()->moving_beads);
  // A microparticle is wet after 20 tau.
  const int steps = workload.microparticle ? 3000 : static_cast<int>(std::clamp(2.5e7 / beads, 100.0, 500.0));
  for (int k = 0; k < steps; ++k) simulation.step();
  std::string state = simulation.save_state();
  if (!path.empty() && !(std::ofstream(path, std::ios::binary) << state).flush())
    throw std::runtime_error(path + ": write failed; is the disk full?");
  return state;
}

/// Kernels that take microseconds a bead and step.
bool slow(const std::string& kernel) { return kernel == "reference" || kernel == "scalar"; }

/// Steps to time: about half a second, and never less than one round of the droplet tracker, or of a list
/// rebuild for the slow ones.
int timed_steps(const Workload& workload, const std::string& kernel) {
  const Domain& domain = workload.parameters.domain;
  const double volume =
      workload.droplet_radius > 0 ? 4.19 * std::pow(workload.droplet_radius, 3) : domain.size().prod();
  const double beads = volume * workload.parameters.liquid.bulk_density;
  return slow(kernel) ? static_cast<int>(std::max(3.0, 2e5 / beads))
                      : static_cast<int>(std::max(20.0, 4e6 / beads));
}

void time_steps(benchmark::State& state, Simulation& simulation) {
  for (auto _ : state) simulation.step();
  const auto beads = static_cast<double>(simulation.observe()->moving_beads);
  state.counters["beads"] = beads;
  state.counters["ns_per_bead_step"] =
      benchmark::Counter(beads * static_cast<double>(state.iterations()) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void cost(benchmark::State& state, const Workload& workload, const std::string& kernel,
          const std::string& folder) {
  Simulation simulation(workload.parameters, ContactAngleCurve::lan2016(),
                        {static_cast<int>(state.range(0)), kernel});
  simulation.load_state(melted(workload, folder));
  const int warm_up = slow(kernel) ? 1 : 3;  // touches all memory
  for (int k = 0; k < warm_up; ++k) simulation.step();
  time_steps(state, simulation);
}

double resident_bytes() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double peak_resident_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// The most that the process ever held less what it held before. Says something only in a process that ran
/// nothing larger before.
void memory(benchmark::State& state, const Workload& workload) {
  const double before = resident_bytes();
  Simulation simulation(workload.parameters, ContactAngleCurve::lan2016(),
                        {static_cast<int>(state.range(0)), "auto"});
  place(simulation, workload);
  time_steps(state, simulation);
  state.counters["bytes_per_bead"] =
      (peak_resident_bytes() - before) / static_cast<double>(simulation.observe()->moving_beads);
}

void add(const std::string& name, int threads, int iterations,
         const std::function<void(benchmark::State&)>& run) {
  benchmark::RegisterBenchmark(name.c_str(), run)
      ->Arg(threads)
      ->ArgName("threads")
      ->Iterations(iterations)
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

void add_cost(const Workload& workload, const std::string& kernel, int threads, const std::string& states) {
  add(workload.name + "/" + kernel, threads, timed_steps(workload, kernel),
      [=](benchmark::State& state) { cost(state, workload, kernel, states); });
}

void add_all(const Options& options) {
  const std::vector<std::string> kernels = available_kernels();
  for (Workload workload : workloads()) {
    workload.parameters.list_skin = options.list_skin;
    for (const int threads : options.threads) add_cost(workload, kernels.front(), threads, options.states);
    for (std::size_t k = 1; k < kernels.size(); ++k) add_cost(workload, kernels[k], 1, options.states);
  }
  for (Workload workload : size_sweep()) {
    workload.parameters.list_skin = options.list_skin;
    for (const int threads : options.threads) add_cost(workload, kernels.front(), threads, options.states);
  }
  const Workload largest = workloads().back();
  add(largest.name + "/memory", 1, 20, [largest](benchmark::State& state) { memory(state, largest); });
}

/// What Google Benchmark left over. @throws std::invalid_argument for what nobody knows.
Options own_options(int argc, char** argv) {
  Options options{{1, static_cast<int>(std::max(1u, std::thread::hardware_concurrency()))}, ""};
  for (int k = 1; k < argc; ++k) {
    const std::string argument = argv[k], key = argument.substr(0, argument.find('=') + 1),
                      value = argument.substr(key.size());
    if (key == "--states=") {
      options.states = value;
    } else if (key == "--skin=") {
      options.list_skin = std::atof(value.c_str());
    } else if (key == "--threads=") {
      options.threads.clear();
      std::istringstream list(value);
      for (std::string count; std::getline(list, count, ',');)
        options.threads.push_back(std::atoi(count.c_str()));
      if (options.threads.empty() || *std::min_element(options.threads.begin(), options.threads.end()) < 1)
        throw std::invalid_argument(argument + ", allowed: counts of 1 or more, with commas between");
    } else {
      throw std::invalid_argument(argument + ", allowed: --threads=, --states=, --skin= and those of --help");
    }
  }
  std::sort(options.threads.begin(), options.threads.end());
  options.threads.erase(std::unique(options.threads.begin(), options.threads.end()), options.threads.end());
  return options;
}

}  // namespace

int main(int argc, char** argv) try {
  prefer_short_spinning(argv);
  benchmark::Initialize(&argc, argv);
  benchmark::AddCustomContext("compiler", DMF_COMPILER);
  benchmark::AddCustomContext("flags", DMF_COMPILER_FLAGS);
  add_all(own_options(argc, argv));
  benchmark::RunSpecifiedBenchmarks();
} catch (const std::exception& problem) {
  std::cerr << "bench_step: " << problem.what() << '\n';
  return 1;
}
