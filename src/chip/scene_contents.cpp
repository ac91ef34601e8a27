#include <fmt/format.h>

#include <algorithm>

#include "chip/command_reader.h"
#include "chip/command_rules.h"
#include "chip/configuration.h"
#include "chip/scene_mixture.h"
#include "chip/scene_sections.h"

// What stands on the plate of a scene: droplets and microparticles, and what acts on them from afar.

namespace dmf::chip {

using engine::Dimension;
using engine::Domain;
using engine::Range;
using engine::YamlReader;

namespace {

constexpr const char* kDefaultMicroparticleCalibration = "microparticle";
constexpr std::size_t kMaxPlaced = 10'000;  // droplets, and microparticles

/// From the surface of one droplet to that of another, as they are placed, r_c.
double distance_between(const engine::DropletPlacement& a, const engine::DropletPlacement& b,
                        const engine::Parameters& parameters) {
  const double pancake_a = pancake_radius(a, parameters), pancake_b = pancake_radius(b, parameters);
  // A pancake stands from plate to plate: only x and y keep it from others.
  if (pancake_a > 0 || pancake_b > 0)
    return (a.center - b.center).head<2>().norm() - (pancake_a > 0 ? pancake_a : a.radius) -
           (pancake_b > 0 ? pancake_b : b.radius);
  return (a.center - b.center).norm() - a.radius - b.radius;
}

/// [x, y] or [x, y, z], empty after noting what is wrong. A droplet on an electrode stands over its centroid.
std::vector<double> read_droplet_centre(const YamlReader& section, const Scene& scene) {
  if (!section.has("electrode")) return section.quantities("center", Dimension::length, {}, {2, 3});
  if (section.has("center")) section.report("electrode", "given together with center, allowed: one of both");
  const auto channel = static_cast<std::uint32_t>(section.integer("electrode", 0, kMaxChannel));
  std::vector<double> centre;
  // Without the board's file every channel would be told as missing.
  if (scene.board && scene.board->file.electrodes.empty()) return centre;
  attempt(section, "electrode", [&] {
    const Vector2d at = scene.layout.electrodes()[scene.layout.index_of(channel)].centroid;
    centre = {at.x(), at.y()};
  });
  return centre;
}

}  // namespace

void read_droplets(const YamlReader& root, Scene& scene) {
  const Domain& domain = scene.parameters.domain;
  for (const YamlReader& section : root.mappings("droplets", {0, kMaxPlaced})) {
    const auto centre = read_droplet_centre(section, scene);
    const std::uint32_t species = read_species(section, scene.parameters);
    const bool fills = section.has("fills");
    if (fills && (section.has("radius") || section.has("volume")))
      section.report("fills", "given together with radius or volume, allowed: one of the three");
    double radius = fills ? 0.0 : read_radius(section);
    const double count = fills ? section.number("fills", Range::above(0)) : 0.0;
    if (centre.size() < 2) continue;
    if (count > 0)
      attempt(section, "fills", [&] {
        radius = sphere_radius(filling_volume(scene, {centre[0], centre[1]}, count));
      });
    if (radius <= 0) continue;
    const double touching = domain.lower.z() + radius;
    const engine::DropletPlacement placement{
        {centre[0], centre[1], centre.size() == 3 ? centre[2] : touching}, radius, species};
    for (const std::string& violation : violations(placement, scene)) section.report("", violation);
    for (const engine::DropletPlacement& other : scene.droplets) {
      // The engine wants r_c between beads of two droplets.
      const double between = distance_between(placement, other, scene.parameters);
      if (between < 1) {
        section.report("", fmt::format("{:.4g} r_c from another droplet, allowed: 1 r_c or more", between));
      }
    }
    scene.droplets.push_back(placement);
  }
}

void read_microparticles(const YamlReader& root, Scene& scene) {
  scene.microparticle_calibration = kDefaultMicroparticleCalibration;
  bool sound = true;
  if (const auto model = root.optional_mapping("microparticle_model"); model && model->has("calibration")) {
    scene.microparticle_calibration = model->text("calibration");
    sound = attempt(*model, "calibration", [&] { load_microparticle_curve(scene); });
  }
  if (scene.microparticle_calibration != kLanFormula) try {
      // A command may ask for a contact angle later. Without the file only those that do are refused.
      scene.files.keep(
          file_role::kMicroparticleCalibration,
          [&] { return find_config("calibration", scene.microparticle_calibration); }, YamlReader::text_of);
    } catch (const engine::InvalidInput&) {
    }
  for (const YamlReader& section : root.mappings("microparticles", {0, kMaxPlaced})) {
    const auto centre = section.quantities("center", Dimension::length, {}, {2, 3});
    WrittenMicroparticle written = read_microparticle(section);
    if (written.contact_angle && sound) {
      attempt(section, "contact_angle",
              [&] { written.body.attraction = microparticle_attraction(scene, *written.contact_angle); });
    }
    if (centre.size() < 2) continue;
    written.body.center = {centre[0], centre[1]};
    if (centre.size() == 3) written.body.z = centre[2];
    if (!root.failed())
      for (const std::string& violation : engine::violations(written.body, scene.parameters))
        section.report("", violation);
    scene.microparticles.push_back(std::move(written.body));
  }
}

void read_body_forces(const YamlReader& root, Scene& scene) {
  const auto section = root.optional_mapping("body_forces");
  if (!section) return;
  scene.body_forces.gravity = read_vector(*section, "gravity", Dimension::acceleration);
  scene.body_forces.magnetic = read_vector(*section, "magnetic", Dimension::force);
}

}  // namespace dmf::chip
