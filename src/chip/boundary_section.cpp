#include "chip/boundary_section.h"

#include <algorithm>
#include <string>
#include <vector>

namespace dmf::chip {

using engine::BoundaryParameters;
using engine::Dimension;
using engine::Reflection;
using engine::YamlReader;

namespace {

const std::vector<std::string> kReflections{"bounce_back", "bounce_forward", "specular",        "maxwellian",
                                            "thin_layer",  "symmetric",      "frozen_particles"};

Reflection read_reflection(const YamlReader& section, const std::string& key, Reflection otherwise) {
  if (!section.has(key)) return otherwise;
  const std::string word = section.choice(key, kReflections, kReflections.front());
  return static_cast<Reflection>(std::find(kReflections.begin(), kReflections.end(), word) -
                                 kReflections.begin());
}

Eigen::Vector2d read_velocity(const YamlReader& section, const std::string& key) {
  if (!section.has(key)) return Eigen::Vector2d::Zero();
  const auto components = section.quantities(key, Dimension::number, {}, {2, 2});
  return components.size() == 2 ? Eigen::Vector2d(components[0], components[1]) : Eigen::Vector2d::Zero();
}

}  // namespace

void read_boundaries(const YamlReader& root, engine::Parameters& parameters) {
  constexpr std::uint64_t kMostDimensions = 1000;  // the engine says what goes
  parameters.dimensions =
      static_cast<int>(root.integer("dimensions", 0, kMostDimensions, parameters.dimensions));
  if (const auto wall = root.optional_mapping("wall"); wall && wall->has("attraction"))
    parameters.wall.attraction = wall->number("attraction", {});
  const auto section = root.optional_mapping("boundaries");
  if (!section) return;
  BoundaryParameters& boundaries = parameters.boundaries;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const Reflection both = read_reflection(*section, name, Reflection::bounce_back);
    boundaries.lower_reflection[axis] = read_reflection(*section, "lower_" + name, both);
    boundaries.upper_reflection[axis] = read_reflection(*section, "upper_" + name, both);
  }
  boundaries.layer_thickness =
      section->quantity("layer_thickness", Dimension::length, {}, boundaries.layer_thickness);
  if (const auto frozen = section->optional_mapping("frozen_particles")) {
    if (frozen->has("attraction")) boundaries.frozen_particles.attraction = frozen->number("attraction", {});
    boundaries.frozen_particles.lateral_friction =
        frozen->number("lateral_friction", {}, boundaries.frozen_particles.lateral_friction);
  }
  boundaries.lower_velocity = read_velocity(*section, "lower_velocity");
  boundaries.upper_velocity = read_velocity(*section, "upper_velocity");
  boundaries.shear_rate = section->number("shear_rate", {}, boundaries.shear_rate);
}

}  // namespace dmf::chip
