// Sections of a scene whose beads are bound to each other: chains and membranes.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <limits>

#include "chip/command_reader.h"
#include "chip/scene_mixture.h"
#include "chip/scene_sections.h"
#include "engine/bonds/mesh.h"

namespace dmf::chip {

using engine::Dimension;
using engine::Range;
using engine::SpringKind;
using engine::Vector3d;
using engine::YamlReader;

namespace {

constexpr std::size_t kMaxSections = 10'000;
constexpr std::size_t kMaxSpecies = 100'000;  // as many as a chain may have beads
constexpr std::uint64_t kMaxSubdivisions = 6;
constexpr std::size_t kMaxVertices = 100'000;  // of all membranes: a line of the file makes up to 40,962
// The engine checks its own ranges (violations), so that each stands once; here any number goes.
constexpr std::uint64_t kAnyInteger = std::numeric_limits<std::uint32_t>::max();

SpringKind kind_named(const std::string& word) {
  return word == "wlc" ? SpringKind::wlc : word == "fene" ? SpringKind::fene : SpringKind::harmonic;
}

engine::Spring read_spring(const YamlReader& chain) {
  const YamlReader section = chain.mapping("spring");
  engine::Spring spring;
  spring.kind = kind_named(section.choice("kind", {"harmonic", "wlc", "fene"}));
  if (spring.kind != SpringKind::wlc) spring.stiffness = section.number("stiffness", {});
  if (spring.kind == SpringKind::harmonic)
    spring.length = section.quantity("length", Dimension::length, {});
  else
    spring.max_length = section.quantity("max_length", Dimension::length, {});
  if (spring.kind == SpringKind::wlc)
    spring.persistence_length = section.quantity("persistence_length", Dimension::length, {});
  return spring;
}

/// Nothing where it is not written.
std::optional<Vector3d> read_point(const YamlReader& section, const std::string& key) {
  if (!section.has(key)) return std::nullopt;
  const auto at = section.quantities(key, Dimension::length, {}, {3, 3});
  return at.size() == 3 ? std::optional<Vector3d>({at[0], at[1], at[2]}) : std::nullopt;
}

/// `species: oil`, of all beads, or `species: [liquid, oil]`, one a bead. The engine compares with their
/// number.
std::vector<std::uint32_t> read_species_of_beads(const YamlReader& section,
                                                 const engine::Parameters& parameters) {
  std::vector<std::uint32_t> species;
  for (const std::string& name : section.text_or_texts("species", {1, kMaxSpecies}))
    if (!attempt(section, "species", [&] { species.push_back(engine::liquid_named(parameters, name)); }))
      return {};
  return species;
}

engine::ChainPlacement read_chain(const YamlReader& section, const engine::Parameters& parameters) {
  const engine::Domain& domain = parameters.domain;
  engine::ChainPlacement placement;
  placement.spring = read_spring(section);
  placement.species = read_species_of_beads(section, parameters);
  placement.stretching_force = read_vector(section, "stretching_force", Dimension::force);
  if (section.has("points")) {
    for (const auto& row : section.rows("points", Dimension::length, {}, {2}, {3, 3}))
      placement.points.emplace_back(row[0], row[1], row[2]);
    return placement;
  }
  placement.count = static_cast<std::uint32_t>(section.integer("count", 0, kAnyInteger, 1));
  placement.beads = static_cast<std::uint32_t>(section.integer("beads", 0, kAnyInteger));
  const double usual = engine::usual_bond_length(placement.spring);
  placement.bond_length = section.quantity("bond_length", Dimension::length, {}, usual);
  if (section.choice("shape", {"random_walk", "straight"}, "random_walk") == "straight") {
    placement.shape = engine::ChainShape::straight;
    if (section.has("direction")) placement.direction = read_vector(section, "direction", Dimension::number);
  }
  placement.lower = domain.lower;
  placement.upper = domain.upper;
  if (const auto box = section.optional_mapping("box")) {
    placement.lower = read_point(*box, "lower").value_or(domain.lower);
    placement.upper = read_point(*box, "upper").value_or(domain.upper);
  }
  return placement;
}

engine::MembraneStiffness read_stiffness(const YamlReader& section) {
  engine::MembraneStiffness s;
  s.spring = kind_named(section.choice("spring", {"wlc", "harmonic"}, "wlc"));
  s.shear_modulus = section.number("shear_modulus", {}, s.shear_modulus);
  if (s.spring == SpringKind::wlc) s.max_stretch = section.number("max_stretch", {}, s.max_stretch);
  s.bending_rigidity = section.number("bending_rigidity", {}, s.bending_rigidity);
  s.flat = section.choice("unbent", {"shape", "flat"}, "shape") == "flat";
  s.area_stiffness = section.number("area_stiffness", {}, s.area_stiffness);
  s.local_area_stiffness = section.number("local_area_stiffness", {}, s.local_area_stiffness);
  s.volume_stiffness = section.number("volume_stiffness", {}, s.volume_stiffness);
  s.volume_ratio = section.number("volume_ratio", {}, s.volume_ratio);
  return s;
}

/// A mesh file's text, once for all membranes of it; a path counts from the scene's own file.
const SceneFile& mesh_file(const std::string& name, Scene& scene) {
  const auto find = [&] { return (std::filesystem::path(scene.source).parent_path() / name).string(); };
  return scene.files.keep(file_role::kMesh + (" " + name), find, YamlReader::text_of);
}

/// Of a file as it stands there, else a sphere or a red cell around the origin.
engine::TriangleMesh read_shape(const YamlReader& section, Scene& scene) {
  if (section.has("mesh")) {
    engine::TriangleMesh mesh;
    const std::string name = section.text("mesh");
    attempt(section, "mesh", [&] {
      const SceneFile& file = mesh_file(name, scene);
      mesh = engine::parse_obj(file.text, file.path);
    });
    const double scale = section.quantity("scale", Dimension::length, Range::above(0), 1.0);
    for (Vector3d& vertex : mesh.vertices) vertex *= scale;
    return mesh;
  }
  const bool red_cell = section.choice("shape", {"sphere", "red_cell"}, "sphere") == "red_cell";
  const double radius = section.quantity("radius", Dimension::length, Range::above(0));
  const auto subdivisions = static_cast<int>(section.integer(
      "subdivisions", 0, kMaxSubdivisions, static_cast<std::uint64_t>(engine::usual_subdivisions(radius))));
  if (red_cell) return engine::red_cell(subdivisions, radius);
  engine::TriangleMesh mesh = engine::icosphere(subdivisions);
  for (Vector3d& vertex : mesh.vertices) vertex *= radius;
  return mesh;
}

engine::MembranePlacement read_membrane(const YamlReader& section, Scene& scene) {
  engine::TriangleMesh mesh = read_shape(section, scene);
  const Vector3d centre = read_point(section, "center").value_or(Vector3d::Zero());
  Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();
  if (section.has("axis")) {
    const Vector3d axis = read_vector(section, "axis", Dimension::number);
    if (axis.isZero())
      section.report("axis", "(0, 0, 0), allowed: not zero");
    else
      turned = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), axis);
  }
  for (Vector3d& vertex : mesh.vertices) vertex = centre + turned * vertex;
  return {std::make_shared<const engine::TriangleMesh>(std::move(mesh)), read_stiffness(section),
          read_species(section, scene.parameters)};
}

/// What is wrong with the rest of the file may be the cause of what would be told here.
template <class Placement>
void check(const Placement& placement, const YamlReader& root, const YamlReader& section,
           const Scene& scene) {
  if (root.failed()) return;
  for (const std::string& violation : engine::violations(placement, scene.parameters))
    section.report("", violation);
}

}  // namespace

void read_chains(const YamlReader& root, Scene& scene) {
  for (const YamlReader& section : root.mappings("chains", {0, kMaxSections})) {
    scene.chains.push_back(read_chain(section, scene.parameters));
    check(scene.chains.back(), root, section, scene);
  }
}

void read_membranes(const YamlReader& root, Scene& scene) {
  std::size_t vertices = 0;
  for (const YamlReader& section : root.mappings("membranes", {0, kMaxSections})) {
    scene.membranes.push_back(read_membrane(section, scene));
    vertices += scene.membranes.back().mesh->vertices.size();
    if (vertices > kMaxVertices) {
      section.report("", fmt::format("{} vertices with the membranes before, allowed: up to {} in all",
                                     vertices, kMaxVertices));
      break;
    }
    check(scene.membranes.back(), root, section, scene);
  }
}

}  // namespace dmf::chip
