#include "chip/scene_hash.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <optional>
#include <type_traits>
#include <vector>

#include "engine/noise.h"

namespace dmf::chip {
namespace {

/// Folds values into a hash, in the order in which they are given.
class Digest {
 public:
  template <class... Values>
  Digest& operator()(const Values&... values) {
    (add(values), ...);
    return *this;
  }
  std::uint64_t value() const { return hash_; }

 private:
  void word(std::uint64_t bits) { hash_ = engine::mix64(hash_ ^ bits) + 1; }

  template <class T>
  std::enable_if_t<std::is_integral_v<T> || std::is_enum_v<T>> add(const T& value) {
    word(static_cast<std::uint64_t>(value));
  }
  void add(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    word(bits);
  }
  void add(const std::string& text) {
    word(text.size());
    for (const char c : text) word(static_cast<unsigned char>(c));
  }
  template <class T, int rows>
  void add(const Eigen::Matrix<T, rows, 1>& vector) {
    for (const T component : vector) add(component);
  }
  template <class T, std::size_t size>
  void add(const std::array<T, size>& values) {
    for (const T& value : values) add(value);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    word(values.size());
    for (const T& value : values) add(value);
  }
  template <class T>
  void add(const std::optional<T>& value) {
    add(value.has_value());
    if (value) add(*value);
  }
  void add(const ScheduledCommand& scheduled) {
    add(scheduled.time);
    add(to_json(scheduled.command));
  }
  void add(const engine::ContactAngleCurve& curve) {
    for (const auto& point : curve.points()) (*this)(point.attraction, point.angle);
  }
  void add(const Electrode& electrode) { (*this)(electrode.channel, electrode.outline); }
  void add(const engine::DropletPlacement& droplet) {
    const auto& [center, radius, species] = droplet;
    (*this)(center, radius);
    if (species > 0) add(species);
  }
  // Structured bindings name every member: what is added to one of these does not compile before somebody has
  // said here whether it counts.
  void add(const engine::MicroparticlePlacement& placement) {
    const auto& [center, z, radius, beads, smooth, points, mass, attraction, static_friction,
                 kinetic_friction, rolling_friction, magnetic] = placement;
    (*this)(center, z, radius, beads, smooth, points, mass, attraction, static_friction, kinetic_friction,
            rolling_friction, magnetic);
  }
  void add(const engine::Spring& spring) {
    const auto& [kind, stiffness, length, max_length, persistence_length] = spring;
    (*this)(kind, stiffness, length, max_length, persistence_length);
  }
  void add(const engine::ChainPlacement& placement) {
    const auto& [spring, species, points, count, beads, shape, bond_length, lower, upper, direction,
                 stretching_force] = placement;
    (*this)(spring, points, count, beads, shape, bond_length, lower, upper, direction, stretching_force);
    // Only where they are told: the hashes of older scenes stay.
    if (!species.empty()) add(species);
  }
  void add(const engine::MembraneStiffness& stiffness) {
    const auto& [spring, shear_modulus, max_stretch, bending_rigidity, flat, area_stiffness,
                 local_area_stiffness, volume_stiffness, volume_ratio] = stiffness;
    (*this)(spring, shear_modulus, max_stretch, bending_rigidity, flat, area_stiffness, local_area_stiffness,
            volume_stiffness, volume_ratio);
  }
  void add(const engine::MembranePlacement& placement) {
    const auto& [mesh, stiffness, species] = placement;
    (*this)(mesh->vertices, mesh->triangles, stiffness);
    if (species > 0) add(species);
  }
  void add(const engine::LiquidParameters& liquid) {
    const auto& [attraction, repulsion, cutoff_radius, repulsion_radius, random_amplitude,
                 dissipation_exponent, dissipation_radius, temperature, initial_density, bulk_density,
                 surface_tension, viscosity, wall_distance] = liquid;
    (*this)(attraction, repulsion, cutoff_radius, repulsion_radius, random_amplitude, dissipation_exponent,
            dissipation_radius, temperature, initial_density, bulk_density, surface_tension, viscosity,
            wall_distance);
  }
  void add(const engine::WallParameters& wall) {
    const auto& [lattice_constant, layers, top_contact_angle, attraction] = wall;
    (*this)(lattice_constant, layers, top_contact_angle);
    if (attraction) (*this)(*attraction);
  }
  void add(const engine::LabelGridParameters& solid) {
    const auto& [grid, lattice_constant, contact_angle, attraction] = solid;
    (*this)(lattice_constant, contact_angle, attraction);
    if (!grid) return;
    const auto& [origin, voxel_size, voxels, labels] = *grid;
    (*this)(origin, voxel_size, voxels, labels);
  }
  void add(const engine::MicroparticleParameters& model) {
    const auto& [contact, elastic_modulus, contact_damping, wall_attraction, liquid_repulsion,
                 particle_adhesion, counts_own_beads, counts_liquid, counted_by_liquid] = model;
    (*this)(contact, elastic_modulus, contact_damping, wall_attraction, liquid_repulsion, particle_adhesion,
            counts_own_beads, counts_liquid, counted_by_liquid);
  }
  void add(const engine::BoundaryParameters& boundaries) {
    const auto& [lower_reflection, upper_reflection, layer_thickness, frozen_particles, lower_velocity,
                 upper_velocity, shear_rate] = boundaries;
    (*this)(lower_reflection, upper_reflection, layer_thickness, lower_velocity, upper_velocity, shear_rate);
    if (!boundaries.has(engine::Reflection::frozen_particles)) return;
    const auto& [attraction, lateral_friction] = frozen_particles;
    (*this)(attraction, lateral_friction);
  }
  void add(const engine::Domain& domain) {
    const auto& [lower, upper, lower_side, upper_side] = domain;
    (*this)(lower, upper, lower_side, upper_side);
  }
  void add(const Units& units) {
    const auto& [length_m, mass_kg, time_s] = units;
    (*this)(length_m, mass_kg, time_s);
  }
  void add(const Electrowetting& law) {
    const auto& [rest_angle, reference_voltage, reference_angle, saturation_angle, max_voltage,
                 threshold_voltage, cutoff_frequency, breakdown_voltage, charging_time] = law;
    (*this)(rest_angle, reference_voltage, reference_angle, saturation_angle, max_voltage, threshold_voltage,
            cutoff_frequency, breakdown_voltage, charging_time);
  }
  void add(const Rail& rail) {
    const auto& [current_limit] = rail;
    (*this)(current_limit);
  }
  void add(const Sensing& sensing) {
    const auto& [interval, noise, offset, filler_permittivity] = sensing;
    (*this)(interval, noise, offset, filler_permittivity);
  }
  void add(const engine::PairCoefficients& pair) {
    const auto& [attraction, repulsion, random_amplitude] = pair;
    (*this)(attraction, repulsion, random_amplitude);
  }
  void add(const engine::FurtherLiquid& liquid) {
    const auto& [name, own, initial_density, bulk_density] = liquid;
    (*this)(name, own, initial_density, bulk_density);
  }
  void add(const engine::PairOfSpecies& pair) {
    const auto& [first, second, coefficients] = pair;
    (*this)(first, second, coefficients);
  }
  void add(const engine::SplineParameters& spline) {
    const auto& [used, repulsion, repulsion_radius, attraction, attraction_radius] = spline;
    (*this)(used, repulsion, repulsion_radius, attraction, attraction_radius);
  }
  void add(const engine::FillPlacement& fill) {
    const auto& [lower, upper, species] = fill;
    (*this)(lower, upper, species);
  }
  void add(const engine::BodyForces& forces) {
    const auto& [gravity, magnetic] = forces;
    (*this)(gravity, magnetic);
  }

  std::uint64_t hash_ = 0x646d665f73696d00u;
};

template <class... Values>
std::uint64_t digest(const Values&... values) {
  return Digest()(values...).value();
}

/// It is read when a contact angle is asked for: a scene without it runs, too.
std::uint64_t digest_of_microparticle_curve(const Scene& scene) {
  try {
    return digest(load_microparticle_curve(scene));
  } catch (const engine::InvalidInput&) {
    return digest(scene.microparticle_calibration);
  }
}

}  // namespace

SceneContent content_of(const Scene& scene) {
  // Texts of files count by what was read from them. What stops a run does not say how it goes until then.
  const auto& [name, description, source, files, parameters, units, calibration_file, electrowetting, rail,
               sensing, board, layout, program, default_duration, settle_time, droplets, fills,
               microparticle_calibration, microparticles, chains, membranes, body_forces, schedule,
               patterns] = scene;
  const auto& [liquid, wall, label_grid, microparticle_model, domain, boundaries, dimensions, time_step,
               integrator, integrator_lambda, list_skin, seed, observe_interval, angle_window, max_beads,
               max_memory, watchdog, mixture, spline] = parameters;
  SceneContent content;
  content["liquid"] = digest(liquid);
  // What a scene does not use is no part of it: its saved runs are those of the same scene before.
  if (const auto& [liquids, pairs] = mixture; !liquids.empty() || !pairs.empty())
    content["species"] = digest(liquids, pairs);
  if (spline.used) content["spline"] = digest(spline);
  if (!fills.empty()) content["fills"] = digest(fills);
  content["wall"] = digest(wall);
  if (label_grid.grid) content["label_grid"] = digest(label_grid);
  content["microparticle_model"] = digest(microparticle_model, digest_of_microparticle_curve(scene));
  content["domain"] = digest(domain);
  // Only where they are not the usual ones: the hashes of older scenes stay.
  if (const std::uint64_t given = digest(boundaries); given != digest(engine::BoundaryParameters{}))
    content["boundaries"] = given;
  if (dimensions != 3) content["dimensions"] = digest(dimensions);
  content["engine"] =
      digest(time_step, integrator, integrator_lambda, list_skin, observe_interval, angle_window);
  content["units"] = digest(units);
  content["wettability"] = digest(load_curve(scene));
  if (program) content["wettability"] = digest(content["wettability"], to_json(*program));
  content["electrowetting"] = digest(electrowetting);
  content["chip"] = digest(layout.electrodes(), layout.gap(), rail, sensing);
  content["settle_time"] = digest(settle_time);
  content["droplets"] = digest(droplets);
  content["microparticles"] = digest(microparticles);
  if (!chains.empty()) content["chains"] = digest(chains);
  if (!membranes.empty()) content["membranes"] = digest(membranes);
  content["body_forces"] = digest(body_forces);
  content["schedule"] = digest(schedule);
  Digest of_patterns;
  for (const auto& [pattern, commands] : patterns) of_patterns(pattern, commands);
  content["patterns"] = of_patterns.value();
  return content;
}

std::uint64_t hash_of(const SceneContent& content) {
  Digest all;
  for (const auto& [part, hash] : content) all(part, hash);
  return all.value() != 0 ? all.value() : 1;
}

std::string differing_parts(const SceneContent& one, const SceneContent& other) {
  std::vector<std::string> parts;
  for (const auto& [part, hash] : one) {
    const auto found = other.find(part);
    if (found == other.end() || found->second != hash) parts.push_back(part);
  }
  for (const auto& [part, hash] : other)
    if (one.count(part) == 0) parts.push_back(part);
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace dmf::chip
