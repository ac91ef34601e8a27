#include "tools/constriction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "chip/experiment.h"
#include "tools/membrane_run.h"

namespace dmf::tools {
namespace {

constexpr double behind = 5;  // the throat, where the cell has its shape again, r_c

double mean_or_nan(double sum, double count) {
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

ConstrictionResult run_constriction(const ConstrictionRun& run,
                                    const std::function<void(const ConstrictionSample&)>& sample) {
  chip::Experiment experiment(run.scene, {1, "auto"}, run.seed);
  const engine::Parameters& parameters = run.scene.parameters;
  const double period = parameters.domain.size().x();
  const auto steps_a_look = static_cast<std::uint64_t>(std::max(1L, std::lround(1 / parameters.time_step)));
  const double interval = static_cast<double>(steps_a_look) * parameters.time_step;

  ConstrictionResult result;
  result.passage = std::numeric_limits<double>::quiet_NaN();
  double area_placed = 0, volume_placed = 0;
  double last_x = 0, x = 0, front_in = -1, rear_out = -1, recovered = 0, times_recovered = 0, looks = 0;
  double x_start = 0, x_in = 0;
  std::set<std::uint32_t> inside;
  const auto looks_wanted = static_cast<std::uint64_t>(std::lround(run.time / interval));
  for (std::uint64_t look = 0; look <= looks_wanted; ++look) {
    const double time = static_cast<double>(look) * interval;
    const auto snapshot = experiment.observe();
    const engine::MembraneObservation& cell = snapshot->membranes.at(0);
    const engine::Vector3d extent = cell.upper - cell.lower;
    if (look == 0) {
      area_placed = cell.area;
      volume_placed = cell.volume;
      x = x_start = cell.centroid.x();
    } else {
      // It goes less than half a period between two looks.
      const double way = cell.centroid.x() - last_x;
      x += way - period * std::nearbyint(way / period);
    }
    last_x = cell.centroid.x();
    const ConstrictionSample now{time,
                                 x,
                                 extent.x(),
                                 std::sqrt(extent.y() * extent.z()),
                                 cell.gyration_radii.z() / cell.gyration_radii.y(),
                                 cell.area / area_placed,
                                 cell.volume / volume_placed};
    if (sample) sample(now);
    const double front = x + (cell.upper.x() - cell.centroid.x()),
                 rear = x - (cell.centroid.x() - cell.lower.x());
    if (front_in < 0 && front > run.begin) front_in = time, x_in = x;
    if (rear_out < 0 && rear > run.end) {
      rear_out = time;
      result.passage = rear_out - front_in;
      result.speed_inside = (x - x_in) / std::max(result.passage, interval);
    }
    result.elongation = std::max(result.elongation, now.elongation);
    result.width = std::min(look == 0 ? now.width : result.width, now.width);
    result.area_error = std::max(result.area_error, std::abs(now.area - 1));
    result.volume_error = std::max(result.volume_error, std::abs(now.volume - 1));
    result.area += now.area;
    result.volume += now.volume;
    ++looks;
    if (rear > run.end + behind) recovered += now.elongation, ++times_recovered;
    if (look == 1) inside = enclosed_liquid(*experiment.observe({true}), parameters.domain);
    if (look == looks_wanted || x > run.end + 0.5 * period) break;
    for (std::uint64_t k = 0; k < steps_a_look; ++k) experiment.step();
  }
  result.area /= looks;
  result.volume /= looks;
  result.recovered = mean_or_nan(recovered, times_recovered);
  if (front_in > 0) result.speed_before = (x_in - x_start) / front_in;
  double changed = 0;
  const std::set<std::uint32_t> after = enclosed_liquid(*experiment.observe({true}), parameters.domain);
  for (const std::uint32_t id : inside) changed += after.count(id) == 0;
  for (const std::uint32_t id : after) changed += inside.count(id) == 0;
  result.leaked = inside.empty() ? 0 : changed / static_cast<double>(inside.size());
  return result;
}

}  // namespace dmf::tools
