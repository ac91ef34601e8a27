#include "tools/channel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "chip/experiment.h"

namespace dmf::tools {
namespace {

constexpr double looks_apart = 1;  // tau

/// u = u_0 - c z^2.
struct Parabola {
  double fastest, curvature;
  double at(double z) const { return fastest - curvature * z * z; }
};

bool in_the_middle(const ChannelProfile& profile, std::size_t slab) {
  return std::abs(profile.z[slab]) < 0.8 * profile.half_width;
}

/// Least squares, every slab alike.
Parabola parabola_of(const ChannelProfile& profile) {
  double n = 0, sum_x = 0, sum_xx = 0, sum_y = 0, sum_xy = 0;
  for (std::size_t slab = 0; slab < profile.z.size(); ++slab) {
    if (!in_the_middle(profile, slab)) continue;
    const double x = profile.z[slab] * profile.z[slab], y = profile.velocity[slab];
    n += 1, sum_x += x, sum_xx += x * x, sum_y += y, sum_xy += x * y;
  }
  const double slope = (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
  return {(sum_y - slope * sum_x) / n, -slope};
}

}  // namespace

ChannelProfile run_channel(const ChannelRun& run) {
  const engine::Parameters& parameters = run.scene.parameters;
  chip::Experiment experiment(run.scene, {1, "auto"}, run.seed);
  const auto go_on = [&](double time) {
    for (auto k = std::llround(time / parameters.time_step); k > 0; --k) experiment.step();
  };
  ChannelProfile profile;
  const auto look = [&] {
    go_on(looks_apart);
    auto snapshot = experiment.observe({true});
    const auto outside =
        std::count_if(snapshot->positions.begin(), snapshot->positions.end(), [&](const auto& at) {
          return at.z() < parameters.domain.lower.z() || at.z() > parameters.domain.upper.z();
        });
    profile.most_outside = std::max(profile.most_outside, static_cast<std::size_t>(outside));
    return snapshot;
  };
  for (int k = 0; k < static_cast<int>(run.settle / looks_apart); ++k) look();

  const std::size_t bins = static_cast<std::size_t>(run.bins);
  const engine::Vector3d size = parameters.domain.size();
  std::vector<double> beads(bins), velocity(bins), squares(bins);
  const int looks = std::max(1, static_cast<int>(run.measure / looks_apart));
  for (int k = 0; k < looks; ++k) {
    const auto snapshot = look();
    std::vector<double> of_slab(bins), along(bins), all(bins);
    for (std::size_t k = 0; k < snapshot->positions.size(); ++k) {
      const double fraction = (snapshot->positions[k].z() - parameters.domain.lower.z()) / size.z();
      const auto slab = std::min(bins - 1, static_cast<std::size_t>(std::max(0.0, fraction) * run.bins));
      of_slab[slab] += 1;
      along[slab] += snapshot->velocities[k].x();
      all[slab] += snapshot->velocities[k].squaredNorm();
    }
    for (std::size_t slab = 0; slab < bins; ++slab) {
      beads[slab] += of_slab[slab];
      velocity[slab] += along[slab];
      squares[slab] += all[slab];
    }
  }

  profile.half_width = size.z() / 2;
  const double thickness = size.z() / run.bins;
  const double slab_volume = thickness * size.x() * (parameters.dimensions == 2 ? 1.0 : size.y());
  for (std::size_t slab = 0; slab < bins; ++slab) {
    const double mean = velocity[slab] / beads[slab];
    profile.z.push_back((static_cast<double>(slab) + 0.5) * thickness - profile.half_width);
    profile.velocity.push_back(mean);
    profile.temperature.push_back((squares[slab] / beads[slab] - mean * mean) / parameters.dimensions);
    profile.density.push_back(beads[slab] / looks / slab_volume);
  }
  return profile;
}

ChannelFlow flow_of(const ChannelProfile& profile, double acceleration) {
  const Parabola parabola = parabola_of(profile);
  ChannelFlow flow{};
  double count = 0;
  for (std::size_t slab = 0; slab < profile.z.size(); ++slab) {
    if (!in_the_middle(profile, slab)) continue;
    flow.density += profile.density[slab];
    flow.temperature += profile.temperature[slab];
    count += 1;
  }
  flow.density /= count;
  flow.temperature /= count;
  flow.fastest = parabola.fastest;
  flow.viscosity = flow.density * acceleration / (2 * parabola.curvature);
  flow.slip = parabola.at(profile.half_width);
  flow.coolest_at_wall = flow.hottest_at_wall = profile.temperature.front();
  for (std::size_t slab = 0; slab < profile.z.size(); ++slab) {
    if (profile.half_width - std::abs(profile.z[slab]) > 1) continue;
    flow.most_dense_at_wall = std::max(flow.most_dense_at_wall, profile.density[slab] / flow.density);
    flow.coolest_at_wall = std::min(flow.coolest_at_wall, profile.temperature[slab]);
    flow.hottest_at_wall = std::max(flow.hottest_at_wall, profile.temperature[slab]);
  }
  return flow;
}

ShearFlow shear_of(const ChannelProfile& profile, double speed) {
  double product = 0, squares = 0, density = 0, count = 0;
  for (std::size_t slab = 0; slab < profile.z.size(); ++slab) {
    const double z = profile.z[slab];
    if (std::abs(z) >= 0.6 * profile.half_width) continue;
    product += z * profile.velocity[slab];
    squares += z * z;
    density += profile.density[slab];
    count += 1;
  }
  ShearFlow flow{};
  flow.slip = 1 - profile.half_width * product / squares / speed;
  flow.density = (profile.density.front() + profile.density.back()) / 2 / (density / count);
  flow.temperature = (profile.temperature.front() + profile.temperature.back()) / 2;
  return flow;
}

void write_profile(const std::string& file, const ChannelProfile& profile) {
  const Parabola parabola = parabola_of(profile);
  std::ofstream out(file);
  out << "z,velocity,parabola,temperature,density\n";
  for (std::size_t slab = 0; slab < profile.z.size(); ++slab)
    out << fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", profile.z[slab], profile.velocity[slab],
                       parabola.at(profile.z[slab]), profile.temperature[slab], profile.density[slab]);
}

}  // namespace dmf::tools
