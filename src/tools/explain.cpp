#include "tools/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "chip/polygon.h"
#include "engine/droplet.h"
#include "engine/memory.h"
#include "engine/simulation.h"

namespace dmf::tools {
namespace {

/// Water at 20 degrees C, SI.
constexpr double water_density = 998.2, water_viscosity = 1.002e-3, water_tension = 0.0728, gravity = 9.81;
/// Thermal energy at 20 degrees C, J.
constexpr double thermal_energy = 4.047e-21;
/// Droplet speed that the dimensionless numbers are quoted at, r_c/tau: what the shipped scenes show.
constexpr double typical_speed = 0.05;
/// Beyond this factor two dimensionless numbers are not alike.
constexpr double alike_within = 3;
/// Below this a Bond number does not matter: gravity lowers a droplet by a twentieth of its height at most.
constexpr double small_bond = 0.1;

bool alike(double a, double b) { return a < alike_within * b && b < alike_within * a; }

std::string too(double ours, double waters, const char* more, const char* less) {
  return ours > waters ? fmt::format("{:.2g} times too {}", ours / waters, more)
                       : fmt::format("{:.2g} times too {}", waters / ours, less);
}

/// Beads of a droplet that fills one electrode: a sphere as wide as the pitch or, under a top plate, a column
/// on a square of the pitch.
double beads_on_one_electrode(const chip::Scene& scene, double pitch) {
  const double volume = scene.parameters.domain.has_top_plate()
                            ? pitch * pitch * engine::liquid_height(scene.parameters)
                            : M_PI / 6 * pitch * pitch * pitch;
  return volume * scene.parameters.liquid.bulk_density;
}

std::string about_electrodes(const chip::Scene& scene) {
  const double mm = scene.units.length_m * 1e3;
  std::string text;
  if (scene.board) {
    text +=
        fmt::format("board        {}, {:.4g} r_c per pitch\n", scene.board->path, scene.board->resolution);
  }
  text += fmt::format("electrodes   {}", scene.layout.electrodes().size());
  const auto pitch = pitch_of(scene);
  if (!pitch) return text + "\n";
  text += fmt::format(": channels {}\n", scene.layout.channels_text());
  text += fmt::format("pitch        {:.4g} r_c = {:.4g} mm, gap {:.4g} r_c = {:.4g} mm\n", *pitch,
                      *pitch * mm, scene.layout.gap(), scene.layout.gap() * mm);
  const double beads = beads_on_one_electrode(scene, *pitch);
  const double volume = beads / scene.parameters.liquid.bulk_density * mm * mm * mm;  // mm^3, which is ul
  text += fmt::format("one electrode is filled by {:.0f} beads, {:.3g} ul\n", beads, volume);
  return text;
}

double chain_count(const chip::Scene& scene) {
  double chains = 0;
  for (const auto& placement : scene.chains) chains += placement.count;
  return chains;
}

/// Of all chains and membranes of a scene.
double bonded_beads(const chip::Scene& scene) {
  double beads = 0;
  for (const auto& chains : scene.chains)
    beads +=
        chains.points.empty() ? 1.0 * chains.count * chains.beads : static_cast<double>(chains.points.size());
  for (const auto& membrane : scene.membranes) beads += static_cast<double>(membrane.mesh->vertices.size());
  return beads;
}

/// Of all microparticles of a scene; nearly, where the scene leaves the number to the engine.
double body_beads(const chip::Scene& scene) {
  double beads = 0;
  for (const auto& body : scene.microparticles) {
    beads += body.smooth            ? 1.0
             : !body.points.empty() ? static_cast<double>(body.points.size())
             : body.beads > 0       ? static_cast<double>(body.beads)
                                    : 612 * body.radius * body.radius;
  }
  return beads;
}

}  // namespace

std::vector<Likeness> likeness(const chip::Scene& scene, double radius, double speed) {
  // Reduced units throughout for ours: a bead has mass 1, so mass density is bead density.
  const engine::LiquidParameters& liquid = scene.parameters.liquid;
  const double R = radius * scene.units.length_m, U = speed * scene.units.velocity_m_per_s();
  const double g = scene.body_forces.gravity.norm();

  Likeness ohnesorge{"Ohnesorge, viscosity / sqrt(density tension R)",
                     liquid.viscosity / std::sqrt(liquid.bulk_density * liquid.surface_tension * radius),
                     water_viscosity / std::sqrt(water_density * water_tension * R), ""};
  Likeness capillary{"capillary, viscosity U / tension", liquid.viscosity * speed / liquid.surface_tension,
                     water_viscosity * U / water_tension, ""};
  // Between plates a droplet is as high as the liquid there, whatever its radius.
  const bool pancake = scene.parameters.domain.has_top_plate();
  const double half_height = pancake ? 0.5 * engine::liquid_height(scene.parameters) : radius;
  const double half_height_m = half_height * scene.units.length_m;
  Likeness bond{pancake ? "Bond, density g (height/2)^2 / tension" : "Bond, density g R^2 / tension",
                liquid.bulk_density * g * half_height * half_height / liquid.surface_tension,
                water_density * gravity * half_height_m * half_height_m / water_tension, ""};
  Likeness reynolds{"Reynolds, density U R / viscosity",
                    liquid.bulk_density * speed * radius / liquid.viscosity,
                    water_density * U * R / water_viscosity, ""};
  Likeness thermal{"thermal, k_BT / (tension R^2)",
                   liquid.temperature / (liquid.surface_tension * radius * radius),
                   thermal_energy / (water_tension * R * R), ""};

  if (!alike(ohnesorge.simulated, ohnesorge.water)) {
    ohnesorge.therefore =
        fmt::format("viscosity damps {}: how fast a droplet starts, swings, splits and merges is not water's",
                    too(ohnesorge.simulated, ohnesorge.water, "strongly", "weakly"));
  }
  if (!alike(capillary.simulated, capillary.water)) {
    capillary.therefore = fmt::format(
        "drag against capillary force is {} at this speed: travel times, dynamic angles and the voltage that "
        "a speed "
        "needs are not water's",
        too(capillary.simulated, capillary.water, "large", "small"));
  }
  // Two Bond numbers that are both small are alike, whatever their ratio.
  if (std::max(bond.simulated, bond.water) > small_bond && !alike(bond.simulated, bond.water)) {
    bond.therefore =
        bond.simulated < bond.water
            ? "water's own weight would flatten a droplet of this size, and here it does not: heights, "
              "footprints and what stands in a reservoir are not water's"
            : "gravity flattens the droplet more than it would water";
  }
  if (!alike(reynolds.simulated, reynolds.water)) {
    reynolds.therefore =
        fmt::format("inertia is {} against viscosity: swirls, mixing and overshoot are not water's",
                    too(reynolds.simulated, reynolds.water, "large", "small"));
  }
  if (thermal.simulated > 1e-3) {
    thermal.therefore =
        "the surface trembles by heat as water's does not: thin necks break and small droplets creep "
        "by chance";
  }
  return {ohnesorge, capillary, bond, reynolds, thermal};
}

std::optional<double> pitch_of(const chip::Scene& scene) {
  if (scene.board) return scene.board->resolution;
  const auto& electrodes = scene.layout.electrodes();
  if (electrodes.empty()) return std::nullopt;
  if (electrodes.size() == 1) return std::sqrt(chip::area(electrodes[0].outline));
  std::vector<double> nearest(electrodes.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < electrodes.size(); ++i) {
    for (std::size_t j = i + 1; j < electrodes.size(); ++j) {
      const double apart = (electrodes[i].centroid - electrodes[j].centroid).norm();
      nearest[i] = std::min(nearest[i], apart);
      nearest[j] = std::min(nearest[j], apart);
    }
  }
  const auto middle = nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2);
  std::nth_element(nearest.begin(), middle, nearest.end());
  return *middle;
}

std::string explain(const chip::Scene& scene) {
  const engine::Parameters& parameters = scene.parameters;
  const engine::Units& units = scene.units;
  const engine::Vector3d size = parameters.domain.size();

  double moving = 0, largest = 0;
  for (const auto& droplet : scene.droplets) {
    moving += 4.0 / 3 * M_PI * std::pow(droplet.radius, 3) * initial_density(parameters, droplet.species);
    largest = std::max(largest, droplet.radius);
  }
  // Less where droplets and microparticles are in the way.
  for (const auto& fill : scene.fills)
    moving += (fill.upper - fill.lower).prod() * initial_density(parameters, fill.species);
  const double bonded = bonded_beads(scene);
  const engine::MemoryNeed need = engine::memory_need(parameters, moving, body_beads(scene), bonded);
  std::string text = fmt::format("{}: {}\n", scene.name, scene.description);
  text += fmt::format("domain       {} x {} x {} r_c = {:.3g} x {:.3g} x {:.3g} mm\n", size.x(), size.y(),
                      size.z(), size.x() * units.length_m * 1e3, size.y() * units.length_m * 1e3,
                      size.z() * units.length_m * 1e3);
  text += fmt::format("liquid       {} droplets, about {:.0f} moving beads\n", scene.droplets.size(), moving);
  if (const auto& others = parameters.mixture.liquids; !others.empty()) {
    text += "species      liquid";
    for (const auto& other : others) text += ", " + other.name;
    text += fmt::format("; boxes filled: {}\n", scene.fills.size());
  }
  for (const std::string& notice : engine::notices(parameters)) text += "note         " + notice + "\n";
  if (bonded > 0)
    text += fmt::format("bonded       {:.0f} beads in {:.0f} chains and {} membranes: {:.1f} MB\n", bonded,
                        chain_count(scene), scene.membranes.size(), need.bonds / engine::bytes_per_megabyte);
  text += fmt::format("wall         about {:.0f} frozen beads (looked up, never looped over)\n",
                      engine::wall_beads(parameters));
  text += about_electrodes(scene);
  const auto megabytes = [](double bytes) { return bytes / engine::bytes_per_megabyte; };
  text += fmt::format(
      "memory       about {:.0f} MB: liquid {:.1f}, wall {:.1f}, cells {:.1f}, microparticles {:.1f}; "
      "allowed: "
      "{:.0f} MB, that is {} moving beads\n",
      megabytes(need.total()), megabytes(need.liquid), megabytes(need.wall), megabytes(need.cells),
      megabytes(need.bodies), parameters.max_memory,
      engine::most_moving_beads(parameters, body_beads(scene), bonded));
  text += fmt::format("one r_c      {:.4g} um, one tau {:.4g} us, one bead {:.4g} kg\n", units.length_m * 1e6,
                      units.time_s * 1e6, units.mass_kg);
  text += fmt::format("one r_c/tau  {:.4g} mm/s\n", units.velocity_m_per_s() * 1e3);
  text += fmt::format("time step    {} tau; {} tau to simulate = {:.0f} steps\n", parameters.time_step,
                      scene.default_duration + scene.settle_time,
                      (scene.default_duration + scene.settle_time) / parameters.time_step);

  const char* which = "the largest droplet";
  if (largest <= 0) {
    const auto pitch = pitch_of(scene);
    if (!pitch) return text + "no droplet and no electrode, so no dimensionless numbers\n";
    largest = 0.5 * *pitch;
    which = "a droplet that fills one electrode";
  }
  text += fmt::format("\nwhat is resolved, for {} (R {:.3g} um) at U {:.3g} mm/s:\n", which,
                      largest * units.length_m * 1e6, typical_speed * units.velocity_m_per_s() * 1e3);
  text += fmt::format("  {:<46} {:>11} {:>11} {:>10}\n", "", "simulated", "water", "ratio");
  std::string warnings;
  for (const Likeness& number : likeness(scene, largest, typical_speed)) {
    text += fmt::format("  {:<46} {:>11.3g} {:>11.3g} {:>10.3g}\n", number.name, number.simulated,
                        number.water, number.simulated / number.water);
    if (!number.therefore.empty()) {
      warnings += fmt::format("  {}: {}\n", number.name.substr(0, number.name.find(',')), number.therefore);
    }
  }
  if (warnings.empty()) return text;
  return text + "\nwhat not to trust:\n" + warnings +
         "  shapes at rest, who touches whom and which way a droplet goes follow the contact angles and are "
         "resolved\n";
}

}  // namespace dmf::tools
