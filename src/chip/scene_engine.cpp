#include <fmt/format.h>

#include <limits>

#include "chip/boundary_section.h"
#include "chip/scene_mixture.h"
#include "chip/scene_sections.h"

// What the engine is told by a scene: liquid, units, walls, domain, and how to compute.

namespace dmf::chip {

using engine::Dimension;
using engine::Domain;
using engine::LiquidParameters;
using engine::Range;
using engine::Side;
using engine::YamlReader;

namespace {

// The engine checks its own ranges (engine::violations), so that each stands once; here any number goes.
constexpr std::uint64_t kAnyInteger = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint64_t kAnyLayers = 1000;

Eigen::Vector3d read_corner(const YamlReader& domain, const std::string& key,
                            const Eigen::Vector3d& otherwise, bool may_lack) {
  if (may_lack && !domain.has(key)) return otherwise;
  const auto corner = domain.quantities(key, Dimension::length, {}, {3, 3});
  return corner.size() == 3 ? Eigen::Vector3d(corner[0], corner[1], corner[2]) : otherwise;
}

Domain read_domain(const YamlReader& root, const std::optional<SceneBoard>& board) {
  Domain domain;
  if (board) {
    domain = domain_around(*board);
    if (!root.has("domain")) return domain;
  }
  const YamlReader section = root.mapping("domain");
  domain.lower = read_corner(section, "lower", domain.lower, board.has_value());
  domain.upper = read_corner(section, "upper", domain.upper, board.has_value());
  if (board && section.has("height")) {
    if (section.has("upper")) section.report("height", "given together with upper, allowed: one of both");
    domain.upper.z() = domain.lower.z() + section.quantity("height", Dimension::length, Range::above(0));
  }
  const auto sides = section.optional_mapping("sides");
  if (!sides) return domain;
  constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::string> words{"closed", "periodic"};
    if (axis == 2) words.insert(words.begin(), {"wall", "plates"});
    const std::string word = sides->choice(kAxes[axis], words, words.front());
    domain.upper_side[axis] = word == "periodic" ? Side::periodic
                              : word == "plates" ? Side::wall
                                                 : Side::reflecting;
    domain.lower_side[axis] = word == "wall" ? Side::wall : domain.upper_side[axis];
  }
  return domain;
}

engine::WatchdogParameters read_watchdog(const YamlReader& root) {
  engine::WatchdogParameters watchdog;
  const auto section = root.optional_mapping("watchdog");
  if (!section) return watchdog;
  if (section->has("temperature")) {
    const auto band = section->quantities("temperature", Dimension::number, {}, {2, 2});
    if (band.size() == 2) {
      watchdog.lowest_temperature = band[0];
      watchdog.highest_temperature = band[1];
    }
  }
  watchdog.evaporation = section->number("evaporation", {}, watchdog.evaporation);
  watchdog.leak = static_cast<std::uint32_t>(section->integer("leak", 0, kAnyInteger, watchdog.leak));
  return watchdog;
}

}  // namespace

engine::MicroparticleParameters read_microparticle_model(const YamlReader& root) {
  engine::MicroparticleParameters model;
  const auto section = root.optional_mapping("microparticle_model");
  if (!section) return model;
  model.contact = section->choice("contact", {"lan2016", "coulomb"}, "lan2016") == "coulomb"
                      ? engine::ContactModel::coulomb
                      : engine::ContactModel::lan2016;
  model.elastic_modulus = section->number("elastic_modulus", {}, model.elastic_modulus);
  model.contact_damping = section->number("contact_damping", {}, model.contact_damping);
  model.wall_attraction = section->number("wall_attraction", {}, model.wall_attraction);
  model.liquid_repulsion = section->number("liquid_repulsion", {}, model.liquid_repulsion);
  model.particle_adhesion = section->number("particle_adhesion", {}, model.particle_adhesion);
  model.counts_own_beads = section->boolean("counts_own_beads", model.counts_own_beads);
  model.counts_liquid = section->boolean("counts_liquid", model.counts_liquid);
  model.counted_by_liquid = section->boolean("counted_by_liquid", model.counted_by_liquid);
  return model;
}

LiquidParameters read_liquid(const YamlReader& root) {
  LiquidParameters liquid;
  const auto section = root.optional_mapping("liquid");
  if (!section) return liquid;
  liquid.attraction = section->number("attraction", {}, liquid.attraction);
  liquid.repulsion = section->number("repulsion", {}, liquid.repulsion);
  liquid.repulsion_radius = section->number("repulsion_radius", {}, liquid.repulsion_radius);
  liquid.random_amplitude = section->number("random_amplitude", {}, liquid.random_amplitude);
  liquid.dissipation_exponent = section->number("dissipation_exponent", {}, liquid.dissipation_exponent);
  liquid.dissipation_radius = section->number("dissipation_radius", {}, liquid.dissipation_radius);
  liquid.temperature = section->number("temperature", {}, liquid.temperature);
  liquid.initial_density = section->number("initial_density", {}, liquid.initial_density);
  liquid.bulk_density = section->number("bulk_density", {}, liquid.bulk_density);
  liquid.surface_tension = section->number("surface_tension", {}, liquid.surface_tension);
  liquid.viscosity = section->number("viscosity", {}, liquid.viscosity);
  liquid.wall_distance = section->number("wall_distance", {}, liquid.wall_distance);
  return liquid;
}

engine::Units read_units(const YamlReader& root, const LiquidParameters& liquid,
                         const std::optional<SceneBoard>& board) {
  double length = board ? board->length_m() : 10e-6;  // m
  double density = 1000;                              // kg/m^3, water
  double surface_tension = 0.072;                     // N/m, water in air at 25 degrees C
  if (const auto section = root.optional_mapping("units")) {
    for (const char* key : {"preset", "length"}) {
      if (board && section->has(key)) {
        section->report(
            key, "given together with chip.file, allowed: chip.resolution, from which the length follows");
      }
    }
    if (section->has("preset")) {
      section->choice("preset", {"lan2016"});
      return engine::Units::lan2016();
    }
    length = section->quantity("length", Dimension::length, {1e-9, 1e-2}, length);
    density = section->quantity("density", Dimension::density, {1, 1e5}, density);
    surface_tension =
        section->quantity("surface_tension", Dimension::surface_tension, {1e-6, 10}, surface_tension);
  }
  return engine::Units::matching(length, density, surface_tension, liquid.bulk_density,
                                 liquid.surface_tension);
}

void read_engine(const YamlReader& root, engine::Parameters& parameters,
                 const std::optional<SceneBoard>& board) {
  if (const auto wall = root.optional_mapping("wall")) {
    parameters.wall.lattice_constant = wall->number("lattice_constant", {}, parameters.wall.lattice_constant);
    parameters.wall.layers = static_cast<int>(wall->integer("layers", 0, kAnyLayers, parameters.wall.layers));
  }
  parameters.domain = read_domain(root, board);
  read_boundaries(root, parameters);
  parameters.seed = root.integer("seed", 0, std::numeric_limits<std::uint64_t>::max(), parameters.seed);
  parameters.time_step = root.quantity("time_step", Dimension::time, {}, parameters.time_step);
  parameters.integrator = root.choice("integrator", {"groot_warren", "baoab"}, "groot_warren") == "baoab"
                              ? engine::Integrator::baoab
                              : engine::Integrator::groot_warren;
  parameters.integrator_lambda = root.number("integrator_lambda", {}, parameters.integrator_lambda);
  parameters.list_skin = root.quantity("list_skin", Dimension::length, {}, parameters.list_skin);
  parameters.observe_interval = static_cast<std::uint32_t>(
      root.integer("observe_interval", 0, kAnyInteger, parameters.observe_interval));
  parameters.angle_window = root.quantity("angle_window", Dimension::time, {}, parameters.angle_window);
  parameters.max_beads = root.integer("max_beads", 0, kAnyInteger, parameters.max_beads);
  parameters.max_memory = root.number("max_memory", {}, parameters.max_memory);
  parameters.watchdog = read_watchdog(root);
  for (const std::string& violation : engine::violations(parameters)) root.report_path(violation);
}

}  // namespace dmf::chip
