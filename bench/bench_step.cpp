// What a step costs, in nanoseconds per moving bead and step, and what the scalar double reference costs for
// the same.
//   bench_step [--benchmark_filter=...] [--benchmark_repetitions=5 --benchmark_report_aggregates_only]
#include <benchmark/benchmark.h>

#include <string>

#include "engine/simulation.h"

namespace {

using namespace dmf::engine;

struct Workload {
  const char* name;
  Parameters parameters;
  double droplet_radius;  ///< 0: the box is full
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

Parameters plate() {
  Parameters parameters;
  parameters.domain.lower = {-75, -35, 0};
  parameters.domain.upper = {75, 35, 30};
  return parameters;
}

void step(benchmark::State& state, const Workload& workload, const std::string& kernel) {
  Simulation simulation(workload.parameters, ContactAngleCurve::lan2016(),
                        {static_cast<int>(state.range(0)), kernel});
  simulation.set_wettability([](double, double) { return 110.0; });
  if (workload.droplet_radius > 0)
    simulation.add_droplet({{0, 0, workload.droplet_radius}, workload.droplet_radius});
  else
    simulation.fill_box();
  const int warm_up = kernel == "reference" ? 20 : 500;  // melts the starting lattice
  for (int k = 0; k < warm_up; ++k) simulation.step();
  for (auto _ : state) simulation.step();
  const auto beads = static_cast<double>(simulation.observe()->moving_beads);
  state.counters["beads"] = beads;
  state.counters["ns_per_bead_step"] =
      benchmark::Counter(beads * static_cast<double>(state.iterations()) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

}  // namespace

int main(int argc, char** argv) {
  const Workload workloads[] = {
      {"W1_bulk_20", bulk(20), 0}, {"W2_droplet_R10", plate(), 10}, {"W3_droplet_R5", plate(), 5}};
  for (const Workload& workload : workloads)
    for (const std::string& kernel : available_kernels())
      for (const int threads : {1, 2})
        if (threads == 1 || kernel == available_kernels().front())
          benchmark::RegisterBenchmark(
              (std::string(workload.name) + "/" + kernel).c_str(),
              [workload, kernel](benchmark::State& state) { step(state, workload, kernel); })
              ->Arg(threads)
              ->ArgName("threads")
              ->Unit(benchmark::kMillisecond)
              ->UseRealTime();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
