#include "chip/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "chip/command_reader.h"
#include "chip/command_rules.h"
#include "chip/configuration.h"
#include "chip/scene_label_grid.h"
#include "chip/scene_mixture.h"
#include "chip/scene_sections.h"
#include "engine/yaml_reader.h"

namespace dmf::chip {

using engine::Dimension;
using engine::Range;
using engine::YamlReader;

namespace {

constexpr std::size_t kMaxScheduled = 10'000;  // commands of a schedule, and of a pattern

/// A command as it stands in the file, kept until everything that it may name has been read.
struct WrittenCommand {
  YamlReader entry;
  ScheduledCommand scheduled;
};
using WrittenSequence = std::vector<WrittenCommand>;

/// Reads `[{at: 20, set_electrodes: {channels: [1]}}, ...]`.
WrittenSequence read_sequence(const YamlReader& parent, const std::string& key, const engine::Units& units,
                              const std::vector<std::string>& allowed) {
  WrittenSequence sequence;
  for (const YamlReader& entry : parent.mappings(key, {0, kMaxScheduled})) {
    const double time = entry.quantity("at", Dimension::time, Range::at_least(0));
    std::vector<std::string> given;
    for (const std::string& name : allowed) {
      if (entry.has(name)) given.push_back(name);
    }
    if (given.size() != 1) {
      entry.report("",
                   fmt::format("{} commands, allowed: one of {}", given.size(), fmt::join(allowed, ", ")));
      continue;
    }
    const YamlReader arguments = entry.mapping(given[0]);
    sequence.push_back({entry, {time, read_command(given[0], arguments, units)}});
  }
  return sequence;
}

std::vector<ScheduledCommand> by_rising_time(const WrittenSequence& sequence) {
  std::vector<ScheduledCommand> commands;
  for (const WrittenCommand& written : sequence) commands.push_back(written.scheduled);
  std::stable_sort(commands.begin(), commands.end(),
                   [](const ScheduledCommand& a, const ScheduledCommand& b) { return a.time < b.time; });
  return commands;
}

/// Commands that a schedule may give: a reset would start the schedule anew without end.
std::vector<std::string> schedule_commands() {
  std::vector<std::string> names = command_names();
  names.erase(std::remove(names.begin(), names.end(), name_of(Reset{})), names.end());
  return names;
}

/// Commands that a pattern may give: one that loads patterns may never come to an end either.
std::vector<std::string> pattern_commands() {
  std::vector<std::string> names = schedule_commands();
  names.erase(std::remove(names.begin(), names.end(), name_of(LoadPattern{})), names.end());
  return names;
}

void check_command(const Command& command, const YamlReader& reader, const std::string& key,
                   const Scene& scene, const engine::ContactAngleCurve& curve) {
  for (const std::string& violation : violations(command, scene, curve)) reader.report(key, violation);
}

void check_sequence(const WrittenSequence& sequence, const Scene& scene,
                    const engine::ContactAngleCurve& curve) {
  for (const auto& [entry, scheduled] : sequence) {
    check_command(scheduled.command, entry, name_of(scheduled.command), scene, curve);
  }
}

/// The map of a scene file: every section in the order in which one needs the other.
Scene read_scene(SceneFiles files) {
  Scene scene;
  scene.files = std::move(files);
  const SceneFile* own = scene.files.look_up(file_role::kScene);
  if (!own) throw engine::InvalidInput("the record of the scene lacks the scene file itself");
  const std::string source = own->path;
  YamlReader root = YamlReader::parse(own->text, source);
  scene.source = source;
  scene.name = std::filesystem::path(source).stem().string();
  scene.description = root.text("description", "");

  scene.parameters.liquid = read_liquid(root);  // the units are matched with it
  scene.parameters.microparticles = read_microparticle_model(root);
  read_mixture(root, scene.parameters);
  scene.board = read_board(root, scene);  // and a board's size decides about one r_c
  scene.units = read_units(root, scene.parameters.liquid, scene.board);
  root.set_units(scene.units);
  read_engine(root, scene.parameters, scene.board);
  refuse_contact_angles(root, scene.parameters);
  scene.settle_time = root.quantity("settle_time", Dimension::time, Range::at_least(0), 0.0);
  scene.default_duration = root.quantity("duration", Dimension::time, Range::at_least(0), 100.0);

  const auto curve = read_wettability(root, scene);
  read_label_grid(root, scene);
  const bool has_layout = read_chip(root, scene);
  read_droplets(root, scene);
  read_microparticles(root, scene);
  read_fills(root, scene);
  read_chains(root, scene);
  read_membranes(root, scene);
  read_body_forces(root, scene);

  // Commands may name channels, angles, patterns and places: read them all, then look at each.
  const WrittenSequence schedule = read_sequence(root, "schedule", scene.units, schedule_commands());
  scene.schedule = by_rising_time(schedule);
  std::vector<WrittenSequence> patterns;
  if (const auto section = root.optional_mapping("patterns")) {
    for (const std::string& name : section->keys()) {
      patterns.push_back(read_sequence(*section, name, scene.units, pattern_commands()));
      scene.patterns[name] = by_rising_time(patterns.back());
    }
  }
  // What is wrong with the ground that commands stand on would be told again for each of them.
  if (curve && has_layout && !root.failed()) {
    check_angles(root, scene, *curve);
    if (scene.program) check_command(*scene.program, root.mapping("wettability"), "program", scene, *curve);
    check_sequence(schedule, scene, *curve);
    for (const WrittenSequence& pattern : patterns) check_sequence(pattern, scene, *curve);
  }
  root.finish();
  return scene;
}

}  // namespace

double surface_tension(const Scene& scene) {
  return scene.parameters.liquid.surface_tension * scene.units.surface_tension_N_per_m();
}

engine::ContactAngleCurve load_curve(const Scene& scene) {
  if (scene.calibration_file.empty()) return engine::ContactAngleCurve::lan2016();
  // A study may have put another calibration in the place of the scene's own.
  const SceneFile* own = scene.files.look_up(file_role::kCalibration);
  if (own && own->path == scene.calibration_file)
    return engine::ContactAngleCurve::parse(own->text, own->path);
  return engine::ContactAngleCurve::load(scene.calibration_file);
}

engine::ContactAngleCurve load_microparticle_curve(const Scene& scene) {
  if (scene.microparticle_calibration == kLanFormula) return engine::ContactAngleCurve::lan2016();
  const SceneFile file = scene.files.get(
      file_role::kMicroparticleCalibration,
      [&scene] { return find_config("calibration", scene.microparticle_calibration); }, YamlReader::text_of);
  return engine::ContactAngleCurve::parse(file.text, file.path);
}

double microparticle_attraction(const Scene& scene, double contact_angle_deg) {
  if (scene.parameters.dimensions == 2)
    throw engine::InvalidInput(
        "a microparticle's contact angle with dimensions: 2, allowed: attraction, for calibrations are of "
        "three dimensions");
  return load_microparticle_curve(scene).attraction(contact_angle_deg);
}

Scene load_scene(const std::string& file) {
  SceneFiles files;
  files.keep(
      file_role::kScene, [&file] { return find_config("scenes", file); }, YamlReader::text_of);
  return read_scene(std::move(files));
}

Scene load_board(const std::string& file, double resolution, const std::string& file_unit) {
  BoardFileOptions options;
  if (const auto unit = parse_quantity(file_unit, Dimension::length); unit && !unit->bare) {
    options.unit_m = unit->value;
  }
  // What is wrong with the file itself is told without a word about scenes.
  std::error_code error;
  const std::filesystem::path path = std::filesystem::absolute(file, error);
  if (std::filesystem::exists(path, error)) read_board_file(file, options);
  // JSON text is YAML text, whatever the name has in it.
  nlohmann::json chip{{"file", std::filesystem::exists(path, error) ? path.string() : file},
                      {"resolution", resolution}};
  if (!file_unit.empty()) chip["file_unit"] = file_unit;
  return parse_scene(nlohmann::json{{"chip", chip}}.dump(), file);
}

Scene parse_scene(const std::string& yaml, const std::string& name) {
  SceneFiles files;
  files.add({file_role::kScene, name, yaml});
  return read_scene(std::move(files));
}

Scene rebuild_scene(const std::vector<SceneFile>& files) { return read_scene(SceneFiles::recorded(files)); }

}  // namespace dmf::chip
