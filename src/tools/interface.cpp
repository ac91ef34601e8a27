#include "tools/interface.h"

#include <algorithm>
#include <cmath>

#include "engine/simulation.h"

namespace dmf::tools {

namespace {

engine::Parameters parameters_of(const InterfaceRun& how) {
  using engine::Side;
  engine::Parameters parameters;
  parameters.seed = how.seed;
  parameters.time_step = how.time_step;
  parameters.integrator = how.integrator;
  parameters.domain.lower = engine::Vector3d::Zero();
  parameters.domain.upper = how.size;
  parameters.domain.lower_side =
      parameters.domain.upper_side = {Side::periodic, Side::periodic, Side::periodic};
  const engine::LiquidParameters& liquid = parameters.liquid = how.liquid;
  parameters.mixture.liquids = {{"other",
                                 {liquid.attraction, liquid.repulsion, liquid.random_amplitude},
                                 liquid.initial_density,
                                 liquid.bulk_density}};
  parameters.mixture.pairs = {
      {"liquid", "other", {how.attraction_between, liquid.repulsion, liquid.random_amplitude}}};
  parameters.watchdog.evaporation = 1;  // what has dissolved is no fault
  return parameters;
}

}  // namespace

InterfaceResult run_interface(const InterfaceRun& how) {
  engine::Simulation simulation(parameters_of(how), engine::ContactAngleCurve::lan2016(), {1, "auto"});
  const double height = how.size.z(), area = how.size.x() * how.size.y();
  simulation.fill({{0, 0, 0}, {how.size.x(), how.size.y(), height / 2}, 0});
  simulation.fill({{0, 0, height / 2}, how.size, 1});
  const auto steps = [&](double time) { return std::max(1L, std::lround(time / how.time_step)); };
  for (long k = 0; k < steps(how.relax); ++k) simulation.step();
  InterfaceResult sum{};
  double looks = 0, strangers = 0, looked_at = 0;
  for (long k = 0; k < steps(how.measure); ++k) {
    simulation.step();
    if (k % steps(0.4) != 0) continue;
    const auto snapshot = simulation.observe({true, false, true});
    const Eigen::Matrix3d& virial = *snapshot->virial;
    sum.tension += (virial(2, 2) - 0.5 * (virial(0, 0) + virial(1, 1))) / (2 * area);
    sum.temperature += snapshot->temperature;
    for (std::size_t bead = 0; bead < snapshot->positions.size(); ++bead) {
      const double layers =
          2 * snapshot->positions[bead].z() / height;  // 0 to 1 the lower one, to 2 the upper
      if (std::abs(layers - std::floor(layers) - 0.5) > 1.0 / 6) continue;
      ++looked_at;
      strangers += snapshot->bead_species[bead] != (static_cast<long>(std::floor(layers)) & 1);
    }
    ++looks;
  }
  return {sum.tension / looks, sum.temperature / looks, strangers / looked_at};
}

}  // namespace dmf::tools
