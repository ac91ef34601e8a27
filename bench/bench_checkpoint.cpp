// What checkpoints and state hashes cost, beside a step of the same run on one thread.
//   scripts/build.sh --bench && BUILD/benchmarks/bench/bench_checkpoint [--benchmark_repetitions=7] [...]
// Names are scene/what: a step, the hash of the complete state, the copy that the engine stands still for,
// and what other threads do with it: checksum and write, read and load.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <string>

#include "chip/checkpoint_file.h"
#include "chip/experiment.h"
#include "engine/wait_policy.h"

namespace {

using dmf::chip::Checkpoint;
using dmf::chip::CheckpointFolder;
using dmf::chip::Experiment;
using dmf::chip::Scene;

/// The scene `sessile` with a droplet of that radius, r_c.
Scene sessile(double radius) {
  Scene scene = dmf::chip::load_scene("sessile");
  const double half = radius + 10;
  scene.parameters.domain.lower = {-half, -half, 0};
  scene.parameters.domain.upper = {half, half, 2 * half};
  scene.droplets.at(0).radius = radius;
  scene.droplets.at(0).center = {0, 0, radius};
  return scene;
}

/// One experiment a scene, made when its first benchmark runs.
class Run {
 public:
  explicit Run(std::function<Scene()> scene) : scene_(std::move(scene)) {}
  Experiment& get() {
    if (!experiment_) {
      experiment_ = std::make_unique<Experiment>(scene_(), dmf::engine::Execution{1, "auto"});
      for (int k = 0; k < 20; ++k) experiment_->step();
    }
    return *experiment_;
  }

 private:
  std::function<Scene()> scene_;
  std::unique_ptr<Experiment> experiment_;
};

void add(const std::string& name, Run& run,
         const std::function<void(Experiment&, benchmark::State&)>& measure) {
  benchmark::RegisterBenchmark(name.c_str(), [&run, measure](benchmark::State& state) {
    Experiment& experiment = run.get();
    measure(experiment, state);
    state.counters["beads"] = static_cast<double>(experiment.observe()->moving_beads);
  })->Unit(benchmark::kMillisecond);
}

void add_all(const std::string& name, Run& run, const CheckpointFolder& folder) {
  add(name + "/step", run, [](Experiment& experiment, benchmark::State& state) {
    for (auto _ : state) experiment.step();
  });
  add(name + "/hash", run, [](Experiment& experiment, benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(experiment.observe({false, true})->state_hash);
  });
  add(name + "/copy", run, [](Experiment& experiment, benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(checkpoint_of(experiment));
  });
  add(name + "/write", run, [&folder](Experiment& experiment, benchmark::State& state) {
    const Checkpoint checkpoint = checkpoint_of(experiment);
    for (auto _ : state) folder.write("run", checkpoint);
    state.counters["file_MB"] = static_cast<double>(std::filesystem::file_size(folder.path() / "run")) * 1e-6;
  });
  add(name + "/load", run, [&folder](Experiment& experiment, benchmark::State& state) {
    folder.write("run", checkpoint_of(experiment));
    for (auto _ : state) experiment.load(folder.read("run").state);
  });
}

}  // namespace

int main(int argc, char** argv) try {
  dmf::engine::prefer_short_spinning(argv);
  benchmark::Initialize(&argc, argv);
  const CheckpointFolder folder(std::filesystem::temp_directory_path() / "dmf_bench_checkpoint");
  std::map<std::string, Run> runs;
  runs.emplace("delivery_line", [] { return dmf::chip::load_scene("delivery_line"); });
  runs.emplace("sessile_R16", [] { return sessile(16); });
  runs.emplace("sessile_R35", [] { return sessile(35); });
  for (auto& [name, run] : runs) add_all(name, run, folder);
  benchmark::RunSpecifiedBenchmarks();
  std::filesystem::remove_all(folder.path());
} catch (const std::exception& problem) {
  std::cerr << "bench_checkpoint: " << problem.what() << '\n';
  return 1;
}
