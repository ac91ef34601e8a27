#include "chip/scene_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "chip/board_drawing.h"
#include "chip/boundary_section.h"
#include "chip/capacitance.h"
#include "chip/command_reader.h"
#include "chip/command_rules.h"
#include "chip/configuration.h"
#include "chip/polygon.h"
#include "chip/scene_mixture.h"

namespace dmf::chip {

using engine::Dimension;
using engine::Domain;
using engine::LiquidParameters;
using engine::Range;
using engine::Side;
using engine::YamlReader;

namespace {

constexpr const char* kDefaultCalibration = "water_like";
constexpr const char* kDefaultMicroparticleCalibration = "microparticle";

constexpr std::uint64_t kMaxPerSide = 1000;       // columns, rows
constexpr std::uint64_t kMaxChannel = 1'000'000;  // of a grid's first electrode and of a polygon
constexpr double kMaxPermittivity = 1e5;
constexpr std::size_t kMaxElectrodes = 10'000;  // of a scene; docs/scene_format.md says what they take
constexpr std::size_t kMaxPlaced = 10'000;      // droplets, and microparticles

// Of the capacitance of a pad that liquid covers: what the sensing of a good board is off by.
constexpr double kNoiseShare = 0.005;
constexpr double kOffsetShare = 0.05;

// The engine checks its own ranges (engine::violations), so that each stands once; here any number goes.
constexpr std::uint64_t kAnyInteger = std::numeric_limits<std::uint32_t>::max();

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
    parameters.wall.layers =
        static_cast<int>(wall->integer("layers", 0, kMaxPerSide, parameters.wall.layers));
  }
  parameters.domain = read_domain(root, board);
  read_boundaries(root, parameters);
  parameters.microparticles = read_microparticle_model(root);
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
  std::optional<engine::ContactAngleCurve> curve;
  bool sound = true;
  if (const auto model = root.optional_mapping("microparticle_model"); model && model->has("calibration")) {
    scene.microparticle_calibration = model->text("calibration");
    sound = attempt(*model, "calibration", [&] { curve = load_microparticle_curve(scene); });
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
      attempt(section, "contact_angle", [&] {
        if (!curve) curve = load_microparticle_curve(scene);
        written.body.attraction = curve->attraction(*written.contact_angle);
      });
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
