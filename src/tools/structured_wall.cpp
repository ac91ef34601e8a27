#include "tools/structured_wall.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "chip/label_shape.h"
#include "engine/observe/contact_angle.h"
#include "engine/simulation.h"
#include "tools/sessile.h"
#include "yaml/units.h"

namespace dmf::tools {
namespace {

constexpr double slab = 3.5;            ///< r_c; Yao's is 3, the least that a periodic side may be is 3.15
constexpr double ceiling = 50;          ///< above the ridges, r_c
constexpr double voxel = 0.5;           ///< r_c
constexpr double clearance = 0.3;       ///< of the droplet over the tops when it is placed, r_c
constexpr double front_layer = 1.5;     ///< above the tops, where the front is looked for, r_c
constexpr std::uint32_t interval = 20;  ///< steps between two looks

engine::Parameters parameters_of(const StructuredWallRun& run) {
  engine::Parameters parameters = run.parameters;
  parameters.seed = run.seed;
  parameters.list_skin = 0.15;  // what the thin slab allows
  parameters.observe_interval = interval;
  parameters.watchdog.evaporation = 1;
  const double period = run.spacing > 0 ? run.ridge + run.spacing : 1;
  const double length = period * std::max(3.0, std::round(run.length / period));
  engine::Domain& domain = parameters.domain;
  domain.lower = {0, 0, 0};
  domain.upper = {length, slab, ceiling};
  domain.lower_side = {engine::Side::periodic, engine::Side::periodic, engine::Side::wall};
  domain.upper_side = {engine::Side::periodic, engine::Side::periodic, engine::Side::reflecting};
  if (run.spacing <= 0) return parameters;
  if (run.bottom == GrooveBottom::bare) domain.lower_side[2] = engine::Side::reflecting;
  engine::LabelGrid grid = chip::grid_over(domain, {voxel, voxel, voxel});
  for (double x = 0; x < length - 0.5 * period; x += period) {
    chip::LabelShape ridge;
    ridge.lower = {x, -slab, -1};
    ridge.upper = {x + run.ridge, 2 * slab, run.height};
    chip::label(grid, domain, ridge, engine::Vector3d::Zero(), engine::LabelGrid::solid);
  }
  parameters.label_grid.grid = std::make_shared<const engine::LabelGrid>(std::move(grid));
  parameters.label_grid.attraction = run.attraction;
  return parameters;
}

/// Where the droplet is along its periodic way.
class Place {
 public:
  explicit Place(double period) : period_(period) {}

  /// Follows the centre of mass, on a circle as long as the period.
  void follow(const engine::Snapshot& snapshot) {
    double sine = 0, cosine = 0;
    for (const Eigen::Vector3f& at : snapshot.positions) {
      sine += std::sin(2 * M_PI * at.x() / period_);
      cosine += std::cos(2 * M_PI * at.x() / period_);
    }
    const double folded = std::atan2(sine, cosine) * period_ / (2 * M_PI);
    centre_ += nearest(folded - centre_);
  }
  /// Never folded.
  double centre() const { return centre_; }
  double from_centre(double x) const { return nearest(x - centre_); }

 private:
  double nearest(double d) const { return d - period_ * std::nearbyint(d / period_); }
  double period_, centre_ = 0;
};

/// The farthest cell of the layer on the tops that is at least half full, from the centre of mass, r_c.
double front_of(const engine::Snapshot& snapshot, const Place& place, double top, double bulk_density) {
  std::vector<double> counts(400, 0.0);  // cells of 0.5 from -100 to 100
  for (const Eigen::Vector3f& at : snapshot.positions)
    if (at.z() >= top && at.z() < top + front_layer)
      counts[static_cast<std::size_t>(std::clamp(2 * (place.from_centre(at.x()) + 100), 0.0, 399.0))] += 1;
  for (std::size_t k = counts.size(); k-- > 0;)
    if (counts[k] >= 0.5 * bulk_density * 0.5 * slab * front_layer)
      return 0.5 * (static_cast<double>(k) + 1) - 100;
  return std::numeric_limits<double>::quiet_NaN();
}

/// Liquid below the tops over what the grooves between the contact points would hold.
double sunk_share(const engine::Snapshot& snapshot, const StructuredWallRun& run, const Place& place) {
  if (run.spacing <= 0) return 0;
  double below = 0, left = 1e9, right = -1e9;
  for (const Eigen::Vector3f& at : snapshot.positions) {
    if (at.z() >= run.height + front_layer) continue;
    const double x = place.from_centre(at.x());
    left = std::min(left, x);
    right = std::max(right, x);
    below += at.z() < run.height;
  }
  const double grooves = (right - left) * (1 - run.solid_fraction()) * run.height * slab;
  return grooves > 0 ? below / (run.parameters.liquid.bulk_density * grooves) : 0;
}

/// Over the tops: a square, or a disc of layers of liquid one lattice constant thick.
void place_droplet(const StructuredWallRun& run, double middle, engine::Simulation& simulation) {
  const double lowest = run.top() + clearance;
  if (run.start == DropletStart::square) {
    const double side = std::sqrt(run.area);
    simulation.fill_slab({middle - 0.5 * side, 0, lowest}, {middle + 0.5 * side, slab, lowest + side});
    return;
  }
  const double radius = std::sqrt(run.area / M_PI);
  const double layer = std::cbrt(4 / run.parameters.liquid.initial_density);
  const int layers = static_cast<int>(std::lround(2 * radius / layer));
  for (int k = 0; k < layers; ++k) {
    const double from_centre = (k + 0.5) * layer - 0.5 * layers * layer;
    const double half = std::sqrt(radius * radius - from_centre * from_centre), bottom = lowest + k * layer;
    simulation.fill({{middle - half, 0, bottom}, {middle + half, slab, bottom + layer}});
  }
}

}  // namespace

double cassie_baxter_angle(double solid_fraction, double angle) {
  return std::acos(solid_fraction * (std::cos(angle * degree) + 1) - 1) / degree;
}

StructuredWallResult run_structured_wall(const StructuredWallRun& run,
                                         const std::function<void(const FrontSample&)>& sample) {
  const engine::Parameters parameters = parameters_of(run);
  const double length = parameters.domain.size().x(), top = run.top();
  const double density = parameters.liquid.bulk_density;
  engine::Simulation simulation(parameters, uncalibrated(), {1, "auto"});
  const double shown = uncalibrated_angle(run.attraction);
  simulation.set_wettability([shown](double, double) { return shown; });
  place_droplet(run, 0.5 * length, simulation);

  const double dt = parameters.time_step;
  const auto looks_of = [dt](double time) { return static_cast<int>(std::lround(time / (dt * interval))); };
  Place place(length);
  const auto look = [&] {
    for (std::uint32_t k = 0; k < interval; ++k) simulation.step();
    const auto snapshot = simulation.observe({true, false});
    place.follow(*snapshot);
    return snapshot;
  };
  const auto collect = [&](engine::RunningAngles& angles, const engine::Snapshot& snapshot, double window) {
    angles.begin_sample(dt * interval, window);
    for (const Eigen::Vector3f& at : snapshot.positions)
      angles.add({place.from_centre(at.x()), 0, at.z() - top});
  };
  for (int k = 0; k < looks_of(run.settle); ++k) look();

  StructuredWallResult result;
  engine::RunningAngles at_rest(slab);
  const int rest = std::max(20, looks_of(run.rest));
  for (int k = 0; k < rest; ++k) {
    const auto snapshot = look();
    collect(at_rest, *snapshot, 1e9);
    result.sunk += sunk_share(*snapshot, run, place) / rest;
  }
  const auto angles = at_rest.angles(density);
  if (!angles) throw std::runtime_error("no circle fits the droplet's surface; measure longer");
  result.angle = 0.5 * (angles->advancing + angles->receding);
  result.difference = angles->advancing - angles->receding;
  if (run.drive <= 0) return result;

  simulation.set_body_forces({{run.force, 0, 0}, engine::Vector3d::Zero()});
  engine::RunningAngles moving(slab);
  const double start = place.centre();
  const int drive = looks_of(run.drive), every = std::max(1, looks_of(2));
  double quarter = start;
  for (int k = 1; k <= drive; ++k) {
    const auto snapshot = look();
    collect(moving, *snapshot, 10);
    if (k == drive / 4) quarter = place.centre();
    if (!sample || k % every != 0) continue;
    const auto seen = moving.angles(density);
    sample({k * dt * interval, place.centre() - start,
            place.centre() - start + front_of(*snapshot, place, top, density),
            seen ? seen->advancing : std::numeric_limits<double>::quiet_NaN()});
  }
  result.velocity = (place.centre() - quarter) / ((drive - drive / 4) * dt * interval);
  return result;
}

}  // namespace dmf::tools
