#include "chip/scene_mixture.h"

#include <fmt/format.h>

#include "chip/scene_sections.h"

namespace dmf::chip {

using engine::Dimension;
using engine::YamlReader;

namespace {

constexpr std::size_t kMaxFills = 1000;

/// The engine checks the ranges.
engine::PairCoefficients read_coefficients(const YamlReader& section, const engine::LiquidParameters& liquid,
                                           double usual_repulsion) {
  engine::PairCoefficients pair;
  pair.attraction = section.number("attraction", {});
  pair.repulsion = section.number("repulsion", {}, usual_repulsion);
  pair.random_amplitude = section.number("random_amplitude", {}, liquid.random_amplitude);
  return pair;
}

void read_spline(const YamlReader& root, engine::SplineParameters& spline) {
  const auto section = root.optional_mapping("spline");
  if (!section) return;
  spline.used = true;
  spline.repulsion = section->number("repulsion", {}, spline.repulsion);
  spline.repulsion_radius = section->number("repulsion_radius", {}, spline.repulsion_radius);
  spline.attraction = section->number("attraction", {}, spline.attraction);
  spline.attraction_radius = section->number("attraction_radius", {}, spline.attraction_radius);
}

}  // namespace

void read_mixture(const YamlReader& root, engine::Parameters& parameters) {
  const engine::LiquidParameters& liquid = parameters.liquid;
  engine::MixtureParameters& mixture = parameters.mixture;
  if (const auto section = root.optional_mapping("species")) {
    for (const std::string& name : section->keys()) {
      const YamlReader one = section->mapping(name);
      engine::FurtherLiquid further;
      further.name = name;
      further.own = read_coefficients(one, liquid, liquid.repulsion);
      further.initial_density = one.number("initial_density", {}, liquid.initial_density);
      further.bulk_density = one.number("bulk_density", {}, liquid.bulk_density);
      mixture.liquids.push_back(std::move(further));
    }
  }
  if (const auto table = root.optional_mapping("pairs")) {
    for (const std::string& first : table->keys()) {
      const YamlReader row = table->mapping(first);
      for (const std::string& second : row.keys()) {
        const bool on_microparticles =
            first == engine::microparticle_name || second == engine::microparticle_name;
        mixture.pairs.push_back(
            {first, second,
             read_coefficients(
                 row.mapping(second), liquid,
                 on_microparticles ? parameters.microparticles.liquid_repulsion : liquid.repulsion)});
      }
    }
  }
  read_spline(root, parameters.spline);
}

void refuse_contact_angles(const YamlReader& root, const engine::Parameters& parameters) {
  if (!fixed_wall_attraction(parameters)) return;
  for (const char* key : {"wettability", "chip"}) {
    if (root.has(key))
      root.report(
          key,
          "given together with wall.attraction or pairs.liquid.wall, which is the same all over the wall, "
          "allowed: one of both");
  }
}

std::uint32_t read_species(const YamlReader& section, const engine::Parameters& parameters) {
  std::uint32_t species = 0;
  attempt(section, "species", [&] {
    species = engine::liquid_named(parameters, section.text("species", engine::first_liquid_name));
  });
  return species;
}

void read_fills(const YamlReader& root, Scene& scene) {
  const engine::Domain& domain = scene.parameters.domain;
  for (const YamlReader& section : root.mappings("fills", {0, kMaxFills})) {
    engine::FillPlacement fill{domain.lower, domain.upper, read_species(section, scene.parameters)};
    for (const auto& [key, corner] : {std::pair{"lower", &fill.lower}, {"upper", &fill.upper}}) {
      if (!section.has(key)) continue;
      const auto given = section.quantities(key, Dimension::length, {}, {3, 3});
      if (given.size() != 3) continue;
      *corner = {given[0], given[1], given[2]};
      if (!domain.contains(*corner))
        section.report(
            key, fmt::format("({}, {}, {}) r_c, allowed: inside the domain", given[0], given[1], given[2]));
    }
    if (!(fill.lower.array() < fill.upper.array()).all())
      section.report("", "lower is not below upper, allowed: a box");
    scene.fills.push_back(fill);
  }
}

}  // namespace dmf::chip
