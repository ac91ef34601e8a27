#include "tools/sessile.h"

#include <cmath>
#include <stdexcept>

#include "engine/observe/contact_angle.h"
#include "tools/largest_droplet.h"

namespace dmf::tools {
namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;

void sample(const engine::Simulation& simulation, engine::SessileAngle& meter, double& temperature) {
  const auto snapshot = simulation.observe({true, false});
  const engine::DropletObservation* largest = largest_droplet(*snapshot);
  if (!largest) return;
  const Eigen::Vector3f foot(static_cast<float>(largest->centroid.x()),
                             static_cast<float>(largest->centroid.y()),
                             static_cast<float>(simulation.parameters().domain.lower.z()));
  for (std::size_t k = 0; k < snapshot->positions.size(); ++k)
    if (snapshot->bead_droplets[k] == largest->id) meter.add(snapshot->positions[k] - foot);
  meter.count_sample();
  temperature += snapshot->temperature;
}

}  // namespace

engine::ContactAngleCurve uncalibrated() {
  return engine::ContactAngleCurve({{-60.0, 0.0, 0.0}, {0.0, 180.0, 0.0}});
}

double uncalibrated_angle(double attraction) { return (attraction + 60.0) * 3.0; }

SessileResult run_sessile(const SessileRun& run) {
  const double cosine = std::cos(run.starting_angle * degree);
  // Cap of the same volume: R^3 4/3 pi = cap^3 pi/3 (2 + cos)(1 - cos)^2.
  const double cap = std::cbrt(4.0 / ((2 + cosine) * (1 - cosine) * (1 - cosine))) * run.radius;
  // Room for the cap, and for the free sphere in case that the start was a bad guess.
  const double half_width =
      std::max(2.2 * run.radius, 1.3 * cap * std::sin(run.starting_angle * degree) + 3.0);
  engine::Parameters parameters = run.parameters;
  parameters.seed = run.seed;
  parameters.domain.lower = {-half_width, -half_width, 0};
  parameters.domain.upper = {half_width, half_width, 2.2 * run.radius + 4.0};
  parameters.observe_interval = 20;
  engine::Simulation simulation(parameters, uncalibrated(), {1, "auto"});
  const double pass_through = uncalibrated_angle(run.attraction);
  simulation.set_wettability([pass_through](double, double) { return pass_through; });
  simulation.add_droplet({{0, 0, -cap * cosine}, cap});

  const double dt = parameters.time_step;
  const auto steps_of = [dt](double time) { return static_cast<std::uint64_t>(std::lround(time / dt)); };
  for (std::uint64_t step = 0; step < steps_of(run.settle); ++step) simulation.step();

  engine::SessileAngle halves[2] = {{half_width, 2.2 * run.radius + 4.0},
                                    {half_width, 2.2 * run.radius + 4.0}};
  engine::SessileAngle whole(half_width, 2.2 * run.radius + 4.0);
  SessileResult result;
  const std::uint64_t looks = steps_of(run.measure) / parameters.observe_interval;
  double ignored = 0;
  for (std::uint64_t look = 0; look < looks; ++look) {
    for (std::uint32_t k = 0; k < parameters.observe_interval; ++k) simulation.step();
    sample(simulation, whole, result.temperature);
    sample(simulation, halves[look < looks / 2 ? 0 : 1], ignored);
  }
  const double density = parameters.liquid.bulk_density;
  const auto angle = whole.angle(density), first = halves[0].angle(density),
             second = halves[1].angle(density);
  if (!angle || !first || !second)
    throw std::runtime_error("no circle fits the droplet's surface; measure longer");
  result.angle = *angle;
  result.first_half = *first;
  result.second_half = *second;
  result.temperature /= static_cast<double>(looks);
  return result;
}

}  // namespace dmf::tools
