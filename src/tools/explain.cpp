#include "tools/explain.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/simulation.h"

namespace dmf::tools {
namespace {

/// Water at 20 degrees C, SI.
constexpr double water_density = 998.2, water_viscosity = 1.002e-3, water_tension = 0.0728, gravity = 9.81;
/// Thermal energy at 20 degrees C, J.
constexpr double thermal_energy = 4.047e-21;
/// Droplet speed that the dimensionless numbers are quoted at, r_c/tau: what the shipped scenes show.
constexpr double typical_speed = 0.05;
/// Memory of a moving bead with all that goes with it and of a wall bead, bytes: measured, see
/// docs/performance.md.
constexpr double bytes_per_moving_bead = 180, bytes_per_wall_bead = 30;

std::string line(const char* name, double ours, double water) {
  return fmt::format("  {:<46} {:>11.3g} {:>11.3g} {:>10.3g}\n", name, ours, water, ours / water);
}

}  // namespace

std::string explain(const chip::Scene& scene) {
  const engine::Parameters& parameters = scene.parameters;
  const engine::LiquidParameters& liquid = parameters.liquid;
  const engine::Units& units = scene.units;
  const engine::Vector3d size = parameters.domain.size();

  double moving = 0, largest = 0;
  for (const auto& droplet : scene.droplets) {
    moving += 4.0 / 3 * 3.14159265 * std::pow(droplet.radius, 3) * liquid.initial_density;
    largest = std::max(largest, droplet.radius);
  }
  const double wall = parameters.domain.has_wall() ? 2 * parameters.wall.layers * size.x() * size.y() /
                                                         std::pow(parameters.wall.lattice_constant, 2)
                                                   : 0;
  std::string text = fmt::format("{}: {}\n", scene.name, scene.description);
  text += fmt::format("domain       {} x {} x {} r_c = {:.3g} x {:.3g} x {:.3g} mm\n", size.x(), size.y(),
                      size.z(), size.x() * units.length_m * 1e3, size.y() * units.length_m * 1e3,
                      size.z() * units.length_m * 1e3);
  text += fmt::format("liquid       {} droplets, about {:.0f} moving beads\n", scene.droplets.size(), moving);
  text += fmt::format("wall         about {:.0f} frozen beads (looked up, never looped over)\n", wall);
  text += fmt::format("electrodes   {}\n", scene.layout.electrodes().size());
  text += fmt::format("memory       about {:.0f} MB\n",
                      (moving * bytes_per_moving_bead + wall * bytes_per_wall_bead) / 1e6);
  text += fmt::format("one r_c      {:.4g} um, one tau {:.4g} us, one bead {:.4g} kg\n", units.length_m * 1e6,
                      units.time_s * 1e6, units.mass_kg);
  text += fmt::format("one r_c/tau  {:.4g} mm/s\n", units.velocity_m_per_s() * 1e3);
  text += fmt::format("time step    {} tau; {} tau to simulate = {:.0f} steps\n", parameters.time_step,
                      scene.default_duration + scene.settle_time,
                      (scene.default_duration + scene.settle_time) / parameters.time_step);
  if (largest <= 0) return text + "no droplet, so no dimensionless numbers\n";

  // Reduced units throughout for ours: a bead has mass 1, so mass density is bead density.
  const double length = largest * units.length_m, speed = typical_speed * units.velocity_m_per_s();
  text += fmt::format("\nwhat is resolved, for the largest droplet (radius {:.3g} um) at {:.3g} mm/s:\n",
                      length * 1e6, speed * 1e3);
  text += fmt::format("  {:<46} {:>11} {:>11} {:>10}\n", "", "simulated", "water", "ratio");
  text += line("Ohnesorge, viscosity / sqrt(density tension R)",
               liquid.viscosity / std::sqrt(liquid.bulk_density * liquid.surface_tension * largest),
               water_viscosity / std::sqrt(water_density * water_tension * length));
  text += line("capillary, viscosity U / tension", liquid.viscosity * typical_speed / liquid.surface_tension,
               water_viscosity * speed / water_tension);
  text += line("Reynolds, density U R / viscosity",
               liquid.bulk_density * typical_speed * largest / liquid.viscosity,
               water_density * speed * length / water_viscosity);
  text += line("Bond, density g R^2 / tension (no gravity here)", 0.0,
               water_density * gravity * length * length / water_tension);
  text +=
      line("thermal, k_BT / (tension R^2)", liquid.temperature / (liquid.surface_tension * largest * largest),
           thermal_energy / (water_tension * length * length));
  return text;
}

}  // namespace dmf::tools
