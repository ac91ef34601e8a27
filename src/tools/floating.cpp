#include "tools/floating.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/surfactant.h"
#include "yaml/units.h"

namespace dmf::tools {
namespace {

constexpr double thickness = 6.0;  // of the film, r_c
constexpr double bin = 0.1;        // of the density profiles, r_c

/// Bead counts over a distance, each bin with its own volume.
class Profile {
 public:
  explicit Profile(double upper) : counts_(static_cast<std::size_t>(upper / bin) + 1) {}
  void add(double at) {
    if (at >= 0 && at < bin * static_cast<double>(counts_.size()))
      counts_[static_cast<std::size_t>(at / bin)] += 1;
  }
  /// Outermost crossing of `density` when going in (from_above) or first when going out, interpolated;
  /// negative when there is none. @param volume  of bin k, for all looks.
  template <class Volume>
  double crossing(double density, bool from_above, Volume volume) const {
    const auto at = [&](std::size_t k) { return counts_[k] / volume(k); };
    const auto between = [&](std::size_t k) {
      const double low = at(k), high = at(k + 1);
      return bin * (static_cast<double>(k) + 0.5 + (density - low) / (high - low));
    };
    if (from_above) {
      for (std::size_t k = counts_.size() - 1; k-- > 0;)
        if (at(k) >= density && at(k + 1) < density) return between(k);
    } else {
      for (std::size_t k = 0; k + 1 < counts_.size(); ++k)
        if (at(k) < density && at(k + 1) >= density) return between(k);
    }
    return -1;
  }

 private:
  std::vector<double> counts_;
};

}  // namespace

FloatingResult run_floating(const FloatingRun& run) {
  engine::Parameters parameters = run.parameters;
  parameters.seed = run.seed;
  const double half_width = run.radius + 4.5;
  parameters.domain.lower = {-half_width, -half_width, 0};
  parameters.domain.upper = {half_width, half_width, thickness + 2 * run.radius + 4};
  parameters.domain.lower_side = {engine::Side::periodic, engine::Side::periodic, engine::Side::wall};
  parameters.domain.upper_side = {engine::Side::periodic, engine::Side::periodic, engine::Side::reflecting};
  parameters.observe_interval = 20;
  // Where it floats does not depend on its mass; a light one is there sooner. It never touches the wall.
  parameters.microparticles.wall_attraction = 0;
  if (run.surfactant > 0) add_surfactant(parameters, run.tail_attraction);
  engine::Simulation simulation(parameters, engine::ContactAngleCurve::lan2016(), {1, "auto"});
  simulation.set_wettability([](double, double) { return 40.0; });
  simulation.fill_slab({-half_width, -half_width, 0}, {half_width, half_width, thickness});
  if (run.surfactant > 0)
    simulation.add_chains(surfactant_dimers(
        static_cast<std::uint32_t>(std::lround(run.surfactant * 4 * half_width * half_width)),
        {-half_width, -half_width, thickness - 1.5}, {half_width, half_width, thickness}));
  engine::MicroparticlePlacement placement;
  placement.radius = run.radius;
  placement.z = thickness + run.radius + 0.55;
  placement.attraction = run.attraction;
  placement.mass = 60 * run.radius * run.radius;
  simulation.add_microparticle(placement);

  const double dt = parameters.time_step;
  const auto steps_of = [dt](double time) { return static_cast<std::uint64_t>(std::lround(time / dt)); };
  for (std::uint64_t step = 0; step < steps_of(run.settle); ++step) simulation.step();

  const double far = run.radius + 3.0;  // from the axis: the surface is flat there
  const double cone = 0.8;              // cosine around the way down
  Profile over_height(parameters.domain.upper.z()), over_distance(run.radius + 3.0);
  const std::uint64_t looks = steps_of(run.measure) / parameters.observe_interval;
  FloatingResult result;
  double square = 0;
  for (std::uint64_t look = 0; look < looks; ++look) {
    for (std::uint32_t k = 0; k < parameters.observe_interval; ++k) simulation.step();
    const auto snapshot = simulation.observe({true, false});
    const engine::MicroparticleObservation& particle = snapshot->microparticles.front();
    const double share = 1.0 / static_cast<double>(looks);
    result.height += share * particle.position.z();
    square += share * particle.position.z() * particle.position.z();
    result.immersion += share * particle.immersion;
    for (const Eigen::Vector3f& bead : snapshot->positions) {
      const Eigen::Vector3d d = parameters.domain.nearest_image(bead.cast<double>() - particle.position);
      if (std::hypot(d.x(), d.y()) > far) over_height.add(bead.z());
      if (-d.z() > cone * d.norm()) over_distance.add(d.norm());
    }
  }
  const double half = 0.5 * parameters.liquid.bulk_density;
  const double flat_area = 4 * half_width * half_width - M_PI * far * far;
  const double surface = over_height.crossing(
      half, true, [&](std::size_t) { return bin * flat_area * static_cast<double>(looks); });
  result.effective_radius = over_distance.crossing(half, false, [&](std::size_t k) {
    const double inner = bin * static_cast<double>(k), outer = inner + bin;
    return 2 * M_PI / 3 * (1 - cone) * (outer * outer * outer - inner * inner * inner) *
           static_cast<double>(looks);
  });
  result.height_deviation = std::sqrt(std::max(0.0, square - result.height * result.height));
  result.height -= surface;
  const double cosine = -result.height / result.effective_radius;
  result.angle = result.immersion < 0.02 || result.effective_radius < 0
                     ? 180.0
                     : std::acos(std::clamp(cosine, -1.0, 1.0)) / degree;
  return result;
}

}  // namespace dmf::tools
