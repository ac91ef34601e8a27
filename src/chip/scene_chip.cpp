#include <fmt/format.h>

#include <algorithm>

#include "chip/board_drawing.h"
#include "chip/capacitance.h"
#include "chip/command_reader.h"
#include "chip/configuration.h"
#include "chip/polygon.h"
#include "chip/scene_sections.h"

// The plate of a scene: wettability, electrodes, what a voltage makes of them, and what a board senses.

namespace dmf::chip {

using engine::Dimension;
using engine::Domain;
using engine::Range;
using engine::YamlReader;

namespace {

constexpr const char* kDefaultCalibration = "water_like";
constexpr std::uint64_t kMaxPerSide = 1000;  // columns, rows
constexpr double kMaxPermittivity = 1e5;
constexpr std::size_t kMaxElectrodes = 10'000;  // of a scene; docs/scene_format.md says what they take

// Of the capacitance of a pad that liquid covers: what the sensing of a good board is off by.
constexpr double kNoiseShare = 0.005;
constexpr double kOffsetShare = 0.05;

bool read_grid(const YamlReader& section, double gap, std::vector<Electrode>& electrodes) {
  ElectrodeGrid grid;
  const auto origin = section.quantities("origin", Dimension::length, {}, {2, 2});
  if (origin.size() == 2) grid.origin = {origin[0], origin[1]};
  grid.columns = static_cast<std::uint32_t>(section.integer("columns", 1, kMaxPerSide));
  grid.rows = static_cast<std::uint32_t>(section.integer("rows", 1, kMaxPerSide));
  grid.pitch = section.quantity("pitch", Dimension::length, Range::above(0));
  grid.first_channel = static_cast<std::uint32_t>(section.integer("first_channel", 0, kMaxChannel, 0));
  for (const auto& hole : section.integer_rows("holes", 0, kMaxPerSide, {}, {2, 2})) {
    grid.holes.push_back({static_cast<std::uint32_t>(hole[0]), static_cast<std::uint32_t>(hole[1])});
  }
  if (const std::uint64_t count = std::uint64_t{grid.columns} * grid.rows; count > kMaxElectrodes) {
    section.report("columns", fmt::format("{} x {} = {} electrodes, allowed: up to {}", grid.columns,
                                          grid.rows, count, kMaxElectrodes));
    return false;
  }
  return attempt(section, "", [&] {
    const auto more = electrodes_of(grid, gap);
    electrodes.insert(electrodes.end(), more.begin(), more.end());
  });
}

Electrode read_polygon(const YamlReader& section) {
  Electrode electrode;
  electrode.channel = static_cast<std::uint32_t>(section.integer("channel", 0, kMaxChannel));
  for (const auto& corner : section.rows("outline", Dimension::length, {}, {3, kMaxCorners}, {2, 2})) {
    electrode.outline.emplace_back(corner[0], corner[1]);
  }
  return electrode;
}

/// The insulating layer, when the law is to follow from it instead of from a reference point.
std::optional<Dielectric> read_dielectric(const YamlReader& electrowetting, const engine::Units& units) {
  const auto section = electrowetting.optional_mapping("dielectric");
  if (!section) return std::nullopt;
  for (const char* key : {"reference_voltage", "reference_angle"}) {
    if (electrowetting.has(key))
      electrowetting.report(key, "given together with dielectric, allowed: one of both");
  }
  Dielectric dielectric;
  dielectric.relative_permittivity = section->number("relative_permittivity", Range{1, kMaxPermittivity});
  dielectric.thickness = section->quantity("thickness", Dimension::length, Range::above(0)) * units.length_m;
  return dielectric;
}

void read_electrowetting(const YamlReader& chip, const Scene& scene, Electrowetting& law) {
  const auto section = chip.optional_mapping("electrowetting");
  std::optional<Dielectric> dielectric;
  if (section) {
    law.reference_voltage =
        section->quantity("reference_voltage", Dimension::voltage, {}, law.reference_voltage);
    law.reference_angle = section->quantity("reference_angle", Dimension::angle, {}, law.reference_angle);
    law.saturation_angle = section->quantity("saturation_angle", Dimension::angle, {}, law.saturation_angle);
    law.max_voltage = section->quantity("max_voltage", Dimension::voltage, {}, law.max_voltage);
    law.threshold_voltage =
        section->quantity("threshold_voltage", Dimension::voltage, {}, law.threshold_voltage);
    law.cutoff_frequency =
        section->quantity("cutoff_frequency", Dimension::frequency, {}, law.cutoff_frequency);
    law.breakdown_voltage =
        section->quantity("breakdown_voltage", Dimension::voltage, {}, law.breakdown_voltage);
    law.charging_time = section->quantity("charging_time", Dimension::time, {}, law.charging_time);
    dielectric = read_dielectric(*section, scene.units);
  }
  if (dielectric) {
    // Until its own is known: one that has no part in what the other members are held to.
    law.reference_voltage = law.max_voltage;
    law.reference_angle = law.saturation_angle;
  }
  const std::vector<std::string> found = violations(law);
  for (const std::string& violation : found) chip.report("electrowetting", violation);
  if (dielectric && found.empty() && dielectric->thickness > 0) {
    law = with_dielectric(law, *dielectric, surface_tension(scene));
  }
}

/// `sensing`: without words of its own, noise and offset are those of a board of this size of pads.
void read_sensing(const YamlReader& chip, Scene& scene) {
  double pads = 0;  // r_c^2
  for (const Electrode& electrode : scene.layout.electrodes()) pads += area(electrode.outline);
  const double full_pad = liquid_capacitance(scene) * pads * scene.units.area_m2() /
                          static_cast<double>(scene.layout.electrodes().size());
  Sensing& sensing = scene.sensing;
  sensing.noise = kNoiseShare * full_pad;
  sensing.offset = kOffsetShare * full_pad;
  const auto section = chip.optional_mapping("sensing");
  if (!section) return;
  sensing.interval = section->quantity("interval", Dimension::time, Range::above(0), sensing.interval);
  sensing.noise = section->quantity("noise", Dimension::capacitance, Range::at_least(0), sensing.noise);
  sensing.offset = section->quantity("offset", Dimension::capacitance, Range::at_least(0), sensing.offset);
  sensing.filler_permittivity =
      section->number("filler_permittivity", Range{1, kMaxPermittivity}, sensing.filler_permittivity);
}

/// Says which electrodes reach beyond the plate.
void check_on_plate(const YamlReader& chip, const Layout& layout, const Domain& domain) {
  for (const Electrode& electrode : layout.electrodes()) {
    const auto box = bounding_box(electrode.outline);
    if ((box.min().array() >= domain.lower.head<2>().array()).all() &&
        (box.max().array() <= domain.upper.head<2>().array()).all()) {
      continue;
    }
    chip.report("",
                fmt::format("channel {}: x {} to {}, y {} to {} r_c, allowed: inside the domain, x {} to {}, "
                            "y {} to {} r_c",
                            electrode.channel, box.min().x(), box.max().x(), box.min().y(), box.max().y(),
                            domain.lower.x(), domain.upper.x(), domain.lower.y(), domain.upper.y()));
  }
}

}  // namespace

std::optional<engine::ContactAngleCurve> read_wettability(const YamlReader& root, Scene& scene) {
  std::string calibration = kDefaultCalibration;
  // The section is optional, and so is what is wrong with the default calibration: noted at the root then.
  const auto section = root.optional_mapping("wettability");
  std::optional<double> top_angle;  // of an unpowered plate like the other one, unless told
  if (section) {
    calibration = section->text("calibration", calibration);
    scene.electrowetting.rest_angle =
        section->quantity("rest_angle", Dimension::angle, {}, scene.electrowetting.rest_angle);
    if (section->has("top_angle")) {
      if (!scene.parameters.domain.has_top_plate())
        section->report("top_angle", "given without a top plate, allowed: with domain.sides.z: plates");
      top_angle = section->quantity("top_angle", Dimension::angle, {});
    }
    if (const auto program = section->optional_mapping("program")) {
      scene.program = std::get<SetWettability>(read_command("set_wettability", *program, scene.units));
    }
  }
  scene.parameters.wall.top_contact_angle = top_angle.value_or(scene.electrowetting.rest_angle);
  std::optional<engine::ContactAngleCurve> curve;
  attempt(section.value_or(root), section ? "calibration" : "", [&] {
    if (calibration != kLanFormula) {
      const auto find = [&] { return find_config("calibration", calibration); };
      scene.calibration_file = scene.files.keep(file_role::kCalibration, find, YamlReader::text_of).path;
    }
    curve = load_curve(scene);
  });
  return curve;
}

bool read_chip(const YamlReader& root, Scene& scene) {
  const auto chip = root.optional_mapping("chip");
  if (!chip) return true;
  if (const auto rail = chip->optional_mapping("rail")) {
    scene.rail.current_limit = rail->quantity("current_limit", Dimension::current, Range::at_least(0), 0.0);
  }
  const Domain& domain = scene.parameters.domain;
  if (!domain.has_wall()) chip->report("", "electrodes without a wall, allowed: domain.sides.z: wall");
  if (scene.parameters.dimensions == 2)
    chip->report("", "electrodes in a scene of two dimensions, allowed: in one of three");
  read_electrowetting(*chip, scene, scene.electrowetting);

  std::optional<double> usual_gap;
  if (scene.board) usual_gap = default_gap(*scene.board);
  const double gap = chip->quantity("gap", Dimension::length, Range::above(0), usual_gap);
  if (gap <= 0) return false;
  std::vector<Electrode> electrodes;
  bool sound = true;
  if (scene.board) {
    if (scene.board->file.electrodes.empty()) return false;
    for (const char* key : {"grids", "polygons"}) {
      if (chip->has(key)) chip->report(key, "given together with file, allowed: one of both");
    }
    sound = attempt(*chip, "file",
                    [&] { electrodes = electrodes_of(scene.board->file, scene.board->length_m(), gap); });
  }
  for (const YamlReader& grid : chip->mappings("grids")) sound &= read_grid(grid, gap, electrodes);
  for (const YamlReader& polygon : chip->mappings("polygons")) electrodes.push_back(read_polygon(polygon));
  if (electrodes.size() > kMaxElectrodes) {
    chip->report("", fmt::format("{} electrodes, allowed: up to {}", electrodes.size(), kMaxElectrodes));
    return false;
  }
  if (electrodes.empty() && sound) {
    chip->report("", "no electrodes, allowed: one or more under `grids` or `polygons`");
    return false;
  }
  // With a grid or an outline left out, the layout would only complain about what follows from that.
  if (root.failed()) return false;
  if (!attempt(*chip, "", [&] { scene.layout = Layout(std::move(electrodes), gap); })) return false;
  check_on_plate(*chip, scene.layout, domain);
  read_sensing(*chip, scene);
  return true;
}

void check_angles(const YamlReader& root, const Scene& scene, const engine::ContactAngleCurve& curve) {
  const Electrowetting& law = scene.electrowetting;
  const std::string allowed = fmt::format("allowed: {:.4g} to {:.4g} degrees, the calibrated range",
                                          curve.min_angle(), curve.max_angle());
  const auto inside = [&curve](double angle) {
    return angle >= curve.min_angle() && angle <= curve.max_angle();
  };
  if (!inside(law.rest_angle)) {
    root.report_path(fmt::format("wettability.rest_angle: {} degrees, {}", law.rest_angle, allowed));
  }
  const double top = scene.parameters.wall.top_contact_angle;
  if (scene.parameters.domain.has_top_plate() && !inside(top)) {
    root.report_path(fmt::format("wettability.top_angle: {} degrees, {}", top, allowed));
  }
  const engine::LabelGridParameters& solid = scene.parameters.label_grid;
  if (solid.grid && !solid.attraction && !inside(solid.contact_angle)) {
    root.report_path(fmt::format("label_grid.contact_angle: {} degrees, {}", solid.contact_angle, allowed));
  }
  const double lowest = law.contact_angle(law.max_voltage);
  if (!scene.layout.electrodes().empty() && !inside(lowest)) {
    root.report_path(fmt::format("chip.electrowetting.max_voltage: {} V leads to {:.4g} degrees, {}",
                                 law.max_voltage, lowest, allowed));
  }
}

}  // namespace dmf::chip
