#include "tools/plug.h"

#include <cmath>
#include <complex>
#include <stdexcept>

#include "engine/simulation.h"
#include "tools/duct.h"
#include "tools/meniscus.h"

namespace dmf::tools {
namespace {

constexpr double slice = 1;   ///< half the thickness of the slice of a square channel that is looked at, r_c
constexpr double corner = 2;  ///< r_c
constexpr double look_every = 0.2;  ///< tau

engine::Parameters parameters_of(const PlugRun& run) {
  engine::Parameters parameters = immiscible_liquids(run.carrier_wall_repulsion);
  const bool square = run.walls == ChannelWalls::square;
  if (square) {
    lay_duct(run.length, run.half_gap, parameters);
    parameters.label_grid.attraction = run.wall_repulsion;
  } else {
    using engine::Side;
    parameters.domain.lower = {0, -run.width / 2, -run.half_gap};
    parameters.domain.upper = {run.length, run.width / 2, run.half_gap};
    parameters.domain.lower_side =
        parameters.domain.upper_side = {Side::periodic, Side::periodic, Side::wall};
    parameters.boundaries.lower_reflection[2] = parameters.boundaries.upper_reflection[2] = run.reflection;
    parameters.wall.attraction = run.wall_repulsion;
  }
  parameters.seed = run.seed;
  parameters.time_step = run.time_step;
  parameters.observe_interval = 1000;
  parameters.watchdog.evaporation = 1;          // what has dissolved is no fault
  parameters.watchdog.highest_temperature = 5;  // a flow is warm where it shears
  return parameters;
}

/// Along a period: the mean of places that lie within half a period of each other, whatever side they are on.
class MeanPlace {
 public:
  explicit MeanPlace(double period) : period_(period) {}
  void add(double x) { sum_ += std::polar(1.0, 2 * M_PI * x / period_); }
  double place() const { return std::arg(sum_) * period_ / (2 * M_PI); }

 private:
  double period_;
  std::complex<double> sum_ = 0;
};

double nearest(double distance, double period) {
  return distance - period * std::nearbyint(distance / period);
}

struct Ends {
  Ends(const PlugRun& run)
      : front(run.length / 2, run.half_gap), rear(front), both(front), half_gap(run.half_gap) {}
  void add(double s, double h, bool inner) {
    (s > 0 ? front : rear).add(std::abs(s), h, inner);
    both.add(std::abs(s), h, inner);
  }
  static MeniscusArc arc_of(const MeniscusProfile& profile) {
    const auto arc = profile.arc();
    if (!arc) throw std::runtime_error("the plug has no end that an arc fits; is it torn, or too short?");
    return *arc;
  }
  double angle() const { return arc_of(both).angle(half_gap); }

  MeniscusProfile front, rear, both;
  double half_gap;
};

/// How much of a part of the channel the plug's liquid fills.
struct Share {
  double plug = 0, all = 0;
  void add(bool inner) { plug += inner, all += 1; }
  double value() const { return all > 0 ? plug / all : 0; }
};

}  // namespace

engine::Parameters immiscible_liquids(double carrier_wall_repulsion) {
  engine::Parameters parameters;
  engine::LiquidParameters& liquid = parameters.liquid;
  liquid.attraction = 18.75;
  liquid.repulsion = 0;
  liquid.random_amplitude = 3;  // gamma 4.5
  liquid.dissipation_exponent = 0.5;
  liquid.initial_density = liquid.bulk_density = 4;
  parameters.mixture.liquids = {{"carrier", {18.75, 0, 3}, 4, 4}};
  parameters.mixture.pairs = {{"liquid", "carrier", {56.25, 0, 3}},
                              {"carrier", "wall", {carrier_wall_repulsion, 0, 3}}};
  return parameters;
}

PlugResult run_plug(const PlugRun& run) {
  engine::Simulation simulation(parameters_of(run), engine::ContactAngleCurve::lan2016(), {1, "auto"});
  const bool square = run.walls == ChannelWalls::square;
  const double across = square ? run.half_gap : run.width / 2;
  simulation.fill({{0, -across, -run.half_gap}, {run.plug, across, run.half_gap}, 0});
  simulation.fill({{run.plug, -across, -run.half_gap}, {run.length, across, run.half_gap}, 1});
  const auto steps = [&](double time) { return std::max(1L, std::lround(time / run.time_step)); };
  // At rest first, as Chen does: half of the time to settle is for the shape at rest.
  for (long k = 0; k < steps(run.settle); ++k) {
    if (k == steps(run.settle) / 2) simulation.set_body_forces({{run.acceleration, 0, 0}, {0, 0, 0}});
    simulation.step();
  }

  Ends whole(run), halves[2] = {Ends(run), Ends(run)};
  Share section, corners;
  PlugResult result;
  const long looks = std::max(2L, std::lround(run.measure / look_every));
  double travelled = 0, before = 0;
  for (long look = 0; look < looks; ++look) {
    for (long k = 0; k < steps(look_every); ++k) simulation.step();
    const auto snapshot = simulation.observe({true});
    result.temperature += snapshot->temperature / static_cast<double>(looks);
    MeanPlace mean(run.length);
    for (std::size_t k = 0; k < snapshot->positions.size(); ++k)
      if (snapshot->bead_species[k] == 0) mean.add(snapshot->positions[k].x());
    const double centre = mean.place();
    if (look > 0) travelled += nearest(centre - before, run.length);
    before = centre;
    for (std::size_t k = 0; k < snapshot->positions.size(); ++k) {
      const Eigen::Vector3f& at = snapshot->positions[k];
      const double s = nearest(at.x() - centre, run.length);
      const bool inner = snapshot->bead_species[k] == 0;
      const auto note = [&](double h) {
        whole.add(s, h, inner);
        halves[look < looks / 2 ? 0 : 1].add(s, h, inner);
      };
      if (!square || std::abs(at.y()) < slice) note(at.z());
      if (square && std::abs(at.z()) < slice) note(at.y());
      if (std::abs(s) > run.plug / 8) continue;
      section.add(inner);
      if (square && std::min(std::abs(at.y()), std::abs(at.z())) > run.half_gap - corner) corners.add(inner);
    }
  }
  const MeniscusArc front = Ends::arc_of(whole.front), rear = Ends::arc_of(whole.rear);
  result.angle = whole.angle();
  result.first_half = halves[0].angle();
  result.second_half = halves[1].angle();
  result.advancing = front.angle(run.half_gap);
  result.receding = rear.angle(run.half_gap);
  result.length = front.place + rear.place;
  result.velocity = travelled / (static_cast<double>(looks - 1) * look_every);
  result.section = section.value();
  result.corners = corners.value();
  return result;
}

}  // namespace dmf::tools
