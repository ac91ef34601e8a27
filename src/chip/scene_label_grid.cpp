#include "chip/scene_label_grid.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "chip/label_files.h"
#include "chip/label_shape.h"
#include "chip/scene_sections.h"
#include "engine/walls/violations.h"

namespace dmf::chip {

using engine::Dimension;
using engine::LabelGrid;
using engine::Range;
using engine::Vector3d;
using engine::YamlReader;

namespace {

constexpr std::size_t kMaxPictures = 4000;
constexpr std::size_t kMaxShapes = 10'000;
constexpr std::size_t kMaxCorners = 1000;  // of a prism's outline
constexpr std::uint64_t kMaxRepeats = 1000;
/// Work on shapes that a scene may ask for: tests of a voxel against a shape, some seconds.
constexpr double kMaxTests = 2e9;

std::string beside(const Scene& scene, const std::string& name) {
  return (std::filesystem::path(scene.source).parent_path() / name).string();
}

Vector3d read_place(const YamlReader& reader, const std::string& key) {
  const auto values = reader.quantities(key, Dimension::length, {}, {3, 3});
  return values.size() == 3 ? Vector3d(values[0], values[1], values[2]) : Vector3d(0, 0, 0);
}

/// A number for all axes, or one for each. Zero when it is not given.
Vector3d read_voxel_size(const YamlReader& section) {
  if (!section.has("voxel_size")) return Vector3d::Zero();
  const Range range{LabelGrid::smallest, LabelGrid::largest};
  const auto values = section.quantities("voxel_size", Dimension::length, range, {3, 3});
  return values.size() == 3 ? Vector3d(values[0], values[1], values[2]) : Vector3d::Zero();
}

/// Where voxels of a file lie: from the origin on, or over all of the domain.
void place(const YamlReader& section, const engine::Domain& domain, LabelGrid& grid) {
  grid.origin = section.has("origin") ? read_place(section, "origin") : domain.lower;
  grid.voxel_size = read_voxel_size(section);
  if (!grid.voxel_size.isZero()) return;
  if (section.has("origin")) section.report("origin", "given without voxel_size, allowed: with both or none");
  grid.voxel_size = domain.size().cwiseQuotient(Vector3d(grid.voxels[0], grid.voxels[1], grid.voxels[2]));
}

LabelGrid read_raw(const YamlReader& raw, Scene& scene) {
  LabelGrid grid;
  const std::string name = raw.text("file");
  const auto voxels = raw.integers("voxels", 1, LabelGrid::most_along, {3, 3});
  if (voxels.size() != 3 || name.empty()) return grid;
  for (int axis = 0; axis < 3; ++axis) grid.voxels[axis] = static_cast<int>(voxels[axis]);
  attempt(raw, "file", [&] {
    const SceneFile& file = scene.files.keep(
        file_role::kLabelGrid, [&] { return beside(scene, name); }, label_file_bytes);
    grid.labels = raw_labels(file.text, grid.voxels);
  });
  return grid;
}

/// The voxel of a pixel: pictures are stacked along an axis, their top is where the second of the other axes
/// is highest.
std::array<int, 3> voxel_of(int axis, int picture, int column, int row_from_below) {
  switch (axis) {
    case 0:
      return {picture, column, row_from_below};
    case 1:
      return {column, picture, row_from_below};
    default:
      return {column, row_from_below, picture};
  }
}

LabelGrid read_pictures(const YamlReader& png, Scene& scene) {
  LabelGrid grid;
  const auto names = png.texts("files", {1, kMaxPictures});
  const int threshold = static_cast<int>(png.integer("threshold", 1, 255, 128));
  const int layers = static_cast<int>(png.integer("layers", 1, LabelGrid::most_along, 1));
  const std::string along = png.choice("along", {"x", "y", "z"}, "z");
  const int axis = along[0] - 'x';
  std::vector<LabelPicture> pictures;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const bool read = attempt(png, "files", [&] {
      const SceneFile& file = scene.files.keep(
          fmt::format("{}_{}", file_role::kLabelGrid, k), [&] { return beside(scene, names[k]); },
          label_file_bytes);
      try {
        pictures.push_back(png_labels(file.text, threshold));
      } catch (const engine::InvalidInput& problem) {
        throw engine::InvalidInput(fmt::format("{}: {}", names[k], problem.what()));
      }
      const LabelPicture &first = pictures.front(), &last = pictures.back();
      if (last.columns != first.columns || last.rows != first.rows)
        throw engine::InvalidInput(fmt::format("{}: {} x {} pixels, allowed: {} x {}, as the first picture",
                                               names[k], last.columns, last.rows, first.columns, first.rows));
      if (const double all = double(first.columns) * first.rows * static_cast<double>(names.size()) * layers;
          all > LabelGrid::most)
        throw engine::InvalidInput(fmt::format("{:.0f} voxels, allowed: up to {}", all, LabelGrid::most));
    });
    if (!read) return grid;
  }
  if (pictures.empty()) return grid;
  const int columns = pictures.front().columns, rows = pictures.front().rows;
  grid.voxels = voxel_of(axis, static_cast<int>(pictures.size()) * layers, columns, rows);
  grid.labels.resize(static_cast<std::size_t>(grid.voxels[0]) * grid.voxels[1] * grid.voxels[2]);
  for (int layer = 0; layer < static_cast<int>(pictures.size()) * layers; ++layer)
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const auto [x, y, z] = voxel_of(axis, layer, column, rows - 1 - row);
        grid.labels[grid.index(x, y, z)] = pictures[static_cast<std::size_t>(layer / layers)]
                                               .labels[static_cast<std::size_t>(row) * columns + column];
      }
  return grid;
}

LabelShape read_shape(const YamlReader& entry) {
  LabelShape shape;
  if (const auto box = entry.optional_mapping("box")) {
    shape.lower = read_place(*box, "lower");
    shape.upper = read_place(*box, "upper");
    if (!(shape.lower.array() < shape.upper.array()).all())
      box->report("", "lower is not below upper, allowed: below it along every axis");
  } else if (const auto ball = entry.optional_mapping("ball")) {
    shape.kind = LabelShape::Kind::ball;
    shape.center = read_place(*ball, "center");
    shape.radius = ball->quantity("radius", Dimension::length, Range::above(0));
  } else if (const auto cylinder = entry.optional_mapping("cylinder")) {
    shape.kind = LabelShape::Kind::cylinder;
    shape.axis = cylinder->choice("axis", {"x", "y", "z"})[0] - 'x';
    shape.center = read_place(*cylinder, "center");
    shape.radius = cylinder->quantity("radius", Dimension::length, Range::above(0));
  } else if (const auto prism = entry.optional_mapping("prism")) {
    shape.kind = LabelShape::Kind::prism;
    shape.axis = prism->choice("axis", {"x", "y", "z"})[0] - 'x';
    for (const auto& row : prism->rows("outline", Dimension::length, {}, {3, kMaxCorners}, {2, 2}))
      shape.outline.emplace_back(row[0], row[1]);
    if (const std::string fault = polygon_fault(shape.outline); !fault.empty() && !prism->failed())
      prism->report("outline", fault);
  }
  return shape;
}

/// The places of a shape: where it is, and so many steps on.
std::vector<Vector3d> read_shifts(const YamlReader& entry) {
  std::vector<Vector3d> shifts{Vector3d::Zero()};
  if (const auto repeat = entry.optional_mapping("repeat")) {
    const Vector3d step = read_place(*repeat, "step");
    const std::uint64_t count = repeat->integer("count", 1, kMaxRepeats);
    for (std::uint64_t k = 1; k < count; ++k) shifts.push_back(static_cast<double>(k) * step);
  }
  return shifts;
}

void read_shapes(const YamlReader& section, const engine::Domain& domain, LabelGrid& grid) {
  double tests = 0;
  for (const YamlReader& entry : section.mappings("shapes", {0, kMaxShapes})) {
    int given = 0;
    for (const char* kind : {"box", "ball", "cylinder", "prism"}) given += entry.has(kind);
    if (given != 1)
      entry.report("", fmt::format("{} shapes, allowed: one of box, ball, cylinder, prism", given));
    const LabelShape shape = read_shape(entry);
    const std::vector<Vector3d> shifts = read_shifts(entry);
    const bool solid = entry.choice("label", {"solid", "fluid"}, "solid") == "solid";
    tests += static_cast<double>(shifts.size() * grid.labels.size());
    if (tests > kMaxTests) {
      entry.report("", fmt::format("{:.2g} voxels times shapes up to this one, allowed: up to {:.0g}", tests,
                                   kMaxTests));
      return;
    }
    if (section.failed()) continue;
    for (const Vector3d& shift : shifts)
      if (label(grid, domain, shape, shift, solid ? LabelGrid::solid : LabelGrid::fluid) == 0) {
        entry.report("", fmt::format("moved by ({:g}, {:g}, {:g}) it holds the middle of no voxel, allowed: "
                                     "of one or more",
                                     shift.x(), shift.y(), shift.z()));
        break;
      }
  }
}

LabelGrid read_labels(const YamlReader& section, Scene& scene) {
  const engine::Domain& domain = scene.parameters.domain;
  const auto raw = section.optional_mapping("raw");
  const auto png = section.optional_mapping("png");
  if (raw && png) section.report("png", "given together with raw, allowed: one of both");
  LabelGrid grid;
  if (raw || png) {
    grid = raw ? read_raw(*raw, scene) : read_pictures(*png, scene);
    if (grid.labels.empty()) return grid;
    place(section, domain, grid);
    return grid;
  }
  if (section.has("origin"))
    section.report("origin",
                   "given without raw or png, allowed: with one of both; else the grid spans the "
                   "domain");
  const Vector3d given = read_voxel_size(section);
  const double usual = 0.5 * scene.parameters.label_grid.lattice_constant;
  const Vector3d size = given.isZero() ? Vector3d::Constant(usual) : given;
  const double voxels = domain.size().cwiseQuotient(size).array().round().max(1.0).prod();
  if (!(voxels <= static_cast<double>(LabelGrid::most))) {
    section.report("voxel_size",
                   fmt::format("{:.3g} voxels over the domain, allowed: up to {}", voxels, LabelGrid::most));
    return grid;
  }
  return grid_over(domain, size);
}

}  // namespace

void read_label_grid(const YamlReader& root, Scene& scene) {
  const auto section = root.optional_mapping("label_grid");
  if (!section) return;
  engine::LabelGridParameters& solid = scene.parameters.label_grid;
  solid.lattice_constant = scene.parameters.wall.lattice_constant;
  if (section->has("density"))
    solid.lattice_constant = std::cbrt(4 / section->number("density", Range{1.2, 32}));
  solid.contact_angle =
      section->quantity("contact_angle", Dimension::angle, {}, scene.electrowetting.rest_angle);
  if (section->has("attraction")) {
    if (section->has("contact_angle"))
      section->report("attraction", "given together with contact_angle, allowed: one of both");
    solid.attraction = section->number("attraction", {});
  }
  if (!section->has("raw") && !section->has("png") && !section->has("shapes"))
    section->report("", "neither raw nor png nor shapes, allowed: one of them or more");
  if (root.failed()) {  // without a sound domain there is no grid: its keys are no misspelt ones
    for (const char* key : {"voxel_size", "origin", "raw", "png", "shapes"}) section->has(key);
    return;
  }
  LabelGrid grid = read_labels(*section, scene);
  if (grid.labels.empty()) return;
  read_shapes(*section, scene.parameters.domain, grid);
  solid.grid = std::make_shared<const LabelGrid>(std::move(grid));
  const std::vector<std::string> found = engine::label_grid_violations(scene.parameters);
  for (const std::string& violation : found) root.report_path(violation);
  if (found.empty() && !root.failed())
    for (const std::string& violation : engine::violations(scene.parameters)) root.report_path(violation);
}

}  // namespace dmf::chip
