// A scene file. What is accepted and small is also placed and goes two steps.
#include "chip/experiment.h"
#include "engine/memory.h"
#include "target.h"

namespace {

/// Little enough to be run some hundred times a second.
bool is_small(const dmf::chip::Scene& scene) {
  double beads = 0;
  for (const auto& droplet : scene.droplets)
    beads += 4.2 * droplet.radius * droplet.radius * droplet.radius * scene.parameters.liquid.initial_density;
  const auto need = dmf::engine::memory_need(scene.parameters, beads, 0);
  return need.total() - need.program < 2e6 && scene.microparticles.size() < 4 &&
         scene.layout.electrodes().size() < 100;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dmf;
  try {
    const chip::Scene scene = chip::parse_scene(text_of(data, size), "fuzz.yaml");
    require(engine::violations(scene.parameters).empty(), "an accepted scene has sound parameters");
    const double most = scene.parameters.max_memory * engine::bytes_per_megabyte;
    require(engine::memory_need(scene.parameters, 0, 0).total() <= most,
            "an accepted domain fits into memory");
    if (!is_small(scene)) return 0;
    chip::Experiment experiment(scene, {1, "auto"});
    for (int k = 0; k < 2; ++k) experiment.step();
    experiment.sense();
  } catch (const InvalidInput&) {
  } catch (const engine::Instability&) {
  }
  return 0;
}
