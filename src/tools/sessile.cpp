#include "tools/sessile.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/observe/contact_angle.h"
#include "tools/flat_cap.h"
#include "tools/largest_droplet.h"
#include "yaml/units.h"

namespace dmf::tools {
namespace {

/// What looks at a droplet, over the whole measurement or half of it.
struct Meters {
  Meters(double half_width, double height, double density)
      : surface(half_width, height), cap(density, half_width) {}
  engine::SessileAngle surface;
  CapMeter cap;
};

void sample(const engine::Simulation& simulation, Meters& meter, double& temperature) {
  const auto snapshot = simulation.observe({true, false});
  const engine::DropletObservation* largest = largest_droplet(*snapshot);
  if (!largest) return;
  const Eigen::Vector3f foot(static_cast<float>(largest->centroid.x()),
                             static_cast<float>(largest->centroid.y()),
                             static_cast<float>(simulation.parameters().domain.lower.z()));
  for (std::size_t k = 0; k < snapshot->positions.size(); ++k)
    if (snapshot->bead_droplets[k] == largest->id) {
      meter.surface.add(snapshot->positions[k] - foot);
      meter.cap.add(snapshot->positions[k] - foot);
    }
  meter.surface.count_sample();
  meter.cap.count_sample();
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

  const double density = parameters.liquid.bulk_density, height = 2.2 * run.radius + 4.0;
  Meters halves[2] = {{half_width, height, density}, {half_width, height, density}};
  Meters whole(half_width, height, density);
  SessileResult result;
  const std::uint64_t looks = steps_of(run.measure) / parameters.observe_interval;
  double ignored = 0;
  for (std::uint64_t look = 0; look < looks; ++look) {
    for (std::uint32_t k = 0; k < parameters.observe_interval; ++k) simulation.step();
    sample(simulation, whole, result.temperature);
    sample(simulation, halves[look < looks / 2 ? 0 : 1], ignored);
  }
  const auto angle = whole.surface.angle(density), first = halves[0].surface.angle(density),
             second = halves[1].surface.angle(density);
  if (!run.flat && (!angle || !first || !second))
    throw std::runtime_error("no circle fits the droplet's surface; measure longer");
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  result.angle = angle.value_or(none);
  result.first_half = first.value_or(none);
  result.second_half = second.value_or(none);
  result.by_edge = whole.cap.angle_of_edge().value_or(none);
  result.by_mean_height = whole.cap.angle_of_mean_height();
  result.by_mean_height_first = halves[0].cap.angle_of_mean_height();
  result.by_mean_height_second = halves[1].cap.angle_of_mean_height();
  result.thickness = whole.cap.middle_thickness();
  result.temperature /= static_cast<double>(looks);
  return result;
}

}  // namespace dmf::tools
