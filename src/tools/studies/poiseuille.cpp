#include <fmt/format.h>

#include <cmath>

#include "tools/channel.h"
#include "tools/study.h"

namespace dmf::tools {

namespace {

using engine::Parameters;
using engine::Reflection;
using engine::Side;

constexpr double pi = 3.14159265358979323846;
constexpr double acceleration = 0.02, half_width = 15.25, friction = 4.5;

/// What Lan's 2.3 leaves open, and what it says.
struct Channel {
  std::string label;
  int dimensions;
  Reflection reflection;
  double reported;  ///< u_max of Lan's figures 2.9 and 2.10; 0: none

  /// Liu's table 1 and Lan (2.32), (2.33), of a liquid that no repulsion orders.
  double theory(double density) const {
    return dimensions == 2 ? 6 / (pi * friction) + pi * friction * density * density / 480
                           : 45 / (4 * pi * friction) + 2 * pi * friction * density * density / 1575;
  }
};

std::vector<Channel> channels() {
  return {{"3D", 3, Reflection::bounce_forward, 8.60},     {"3D bounce_back", 3, Reflection::bounce_back, 0},
          {"3D maxwellian", 3, Reflection::maxwellian, 0}, {"3D thin_layer", 3, Reflection::thin_layer, 0},
          {"3D specular", 3, Reflection::specular, 0},     {"2D", 2, Reflection::bounce_forward, 9.18}};
}

/// Lan 2.3.1: 60 x 3 x 30.5 between the planes, the fcc lattice of the liquid and the walls goes through
/// both. Three cells must fit across, hence 4 r_c along y; along x nothing varies, and 20 r_c do.
ChannelRun channel_run(const Channel& channel, const StudyOptions& options, int seed) {
  ChannelRun run;
  Parameters& parameters = run.parameters;
  const bool flat = channel.dimensions == 2;
  parameters.dimensions = channel.dimensions;
  parameters.domain.lower = {0, 0, -half_width};
  parameters.domain.upper = {flat ? 30.0 : 10.0, 4, half_width};
  const Side y_side = flat ? Side::reflecting : Side::periodic;
  parameters.domain.lower_side = parameters.domain.upper_side = {Side::periodic, y_side, Side::wall};
  parameters.boundaries.lower_reflection[2] = parameters.boundaries.upper_reflection[2] = channel.reflection;
  parameters.wall.attraction = 9.68;
  parameters.wall.lattice_constant = flat ? std::sqrt(2.0 / 4) : 1;  // four beads per r_c^3, or r_c^2
  parameters.liquid.attraction = 18.75;
  parameters.liquid.repulsion = 0;
  parameters.liquid.random_amplitude = 3;
  parameters.liquid.initial_density = parameters.liquid.bulk_density = 4;
  parameters.time_step = options.time_step;
  parameters.integrator = options.integrator;
  parameters.integrator_lambda = options.lambda > 0 ? options.lambda : 0.5;
  parameters.list_skin = options.list_skin;
  parameters.seed = static_cast<std::uint64_t>(seed);
  parameters.watchdog.evaporation = 1;
  parameters.observe_interval = 1000;  // the droplet tracker has nothing to track
  run.acceleration = acceleration;
  run.keeps_off = half_width - 15;
  // The slowest wave decays with rho h^2 / (pi^2 / 4 mu), some 350 tau. Lan: 2600 and 400 tau.
  run.settle = options.quick ? 20 : 2000;
  run.measure = options.quick ? 20 : 1000;
  return run;
}

}  // namespace

void study_poiseuille(const StudyOptions& options) {
  std::vector<std::string> labels;
  for (const Channel& channel : channels()) labels.push_back(channel.label);
  require_known(options, labels);
  ResultTable table(options.output + "/poiseuille_runs.csv",
                    {"u_max", "viscosity", "slip", "density", "temperature", "most_dense_at_wall",
                     "coolest_at_wall", "hottest_at_wall"});
  const auto key = [&](const Channel& channel, int seed) {
    return fmt::format("{}{} seed={}", channel.label, options_key(options), seed);
  };
  std::vector<Job> jobs;
  for (const Channel& channel : channels()) {
    if (!is_wanted(options, channel.label)) continue;
    for (int seed = 1; seed <= options.seeds; ++seed)
      jobs.push_back({key(channel, seed), [=] {
                        const ChannelProfile profile = run_channel(channel_run(channel, options, seed));
                        std::string name = "poiseuille_" + channel.label;
                        for (char& letter : name) letter = letter == ' ' ? '_' : letter;
                        write_profile(fmt::format("{}/{}_seed{}.csv", options.output, name, seed), profile);
                        const ChannelFlow flow = flow_of(profile, acceleration);
                        return std::vector<double>{
                            flow.fastest,         flow.viscosity,      flow.slip,
                            flow.density,         flow.temperature,    flow.most_dense_at_wall,
                            flow.coolest_at_wall, flow.hottest_at_wall};
                      }});
  }
  run_jobs("poiseuille", jobs, options, table);

  fmt::print("plain DPD, a 18.75, a_lw 9.68, phi 3, g 0.02 between walls at z = +-15.25, {} seeds\n",
             options.seeds);
  fmt::print("{:<16} {:>16} {:>7} {:>8} {:>17} {:>7} {:>15} {:>8} {:>7} {:>9} {:>15}\n", "", "u_max", "Lan",
             "theory", "viscosity", "theory", "slip velocity", "density", "k_BT", "density", "k_BT");
  fmt::print("{:>114} {:>15}\n", "at wall", "at wall");
  for (const Channel& channel : channels()) {
    if (!is_wanted(options, channel.label)) continue;
    const auto column = [&](std::size_t index) {
      std::vector<double> values;
      for (int seed = 1; seed <= options.seeds; ++seed)
        values.push_back(table.row(key(channel, seed))[index]);
      return mean_and_spread(values);
    };
    const double density = column(3).mean, viscosity = channel.theory(4);
    fmt::print(
        "{:<16} {:>8.3f} +- {:<4.2g} {:>7} {:>8.2f} {:>9.3f} +- {:<4.2g} {:>7.3f} {:>7.3f} +- {:<4.2g} "
        "{:>8.3f} "
        "{:>7.3f} {:>9.2f} {:>7.3f}-{:<7.3f}\n",
        channel.label, column(0).mean, column(0).deviation,
        channel.reported > 0 ? fmt::format("{:.2f}", channel.reported) : "",
        4 * acceleration * half_width * half_width / (2 * viscosity), column(1).mean, column(1).deviation,
        viscosity, column(2).mean, column(2).deviation, density, column(4).mean, column(5).mean,
        column(6).mean, column(7).mean);
  }
  // Lan (2.34): what an fcc lattice of 4 beads per r_c^3 would be dense in a plane.
  const double apparent = 4 * std::cbrt(4.0), viscosity = channels().back().theory(apparent);
  fmt::print("2D by Lan's apparent density {:.2f}: u_max {:.2f}\n", apparent,
             apparent * acceleration * half_width * half_width / (2 * viscosity));
}

}  // namespace dmf::tools
