#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "chip/board_drawing.h"
#include "chip/configuration.h"
#include "chip/scene_sections.h"

namespace dmf::chip {

using engine::Dimension;
using engine::Domain;
using engine::Range;
using engine::YamlReader;

namespace fs = std::filesystem;

namespace {

constexpr double kDefaultResolution = 10;               // r_c per pitch
constexpr Range kResolutions{4, 100};                   // below, no droplet would fit on a pad
constexpr Range kLengths{1e-9, 1e-2};                   // of one r_c, m; as units.length
constexpr Range kUnits{1e-9, 1};                        // of a board file, m
constexpr double kUsualGap = 0.2;                       // of the pitch, as on the grids of our scenes
constexpr double kUsualMargin = 0.5, kUsualHeight = 2;  // of the domain, in pitches

/// Path of a board file: beside the scene, or a bare name in config/boards.
std::string find_board(const std::string& name, const std::string& scene_file) {
  const fs::path beside = fs::path(scene_file).parent_path() / name;
  std::error_code error;
  const bool bare = name.find('/') == std::string::npos;
  if (!bare || fs::exists(beside, error)) return beside.string();
  const fs::path directory = fs::path(config_directory()) / "boards";
  if (fs::exists(directory / name, error)) return (directory / name).string();
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory, error))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  names.push_back("a path from the scene's folder");
  throw engine::InvalidInput(fmt::format("{}: there is no such file beside the scene or in {}, allowed: {}",
                                         name, directory.string(), fmt::join(names, ", ")));
}

}  // namespace

std::optional<SceneBoard> read_board(const YamlReader& root, Scene& scene) {
  if (!root.has("chip")) return std::nullopt;
  const YamlReader chip = root.mapping("chip");
  if (!chip.has("file")) return std::nullopt;
  SceneBoard board;
  board.file.pitch_m = 1e-3;  // of the stand-in
  board.resolution = chip.number("resolution", kResolutions, kDefaultResolution);
  BoardFileOptions options;
  if (chip.has("file_unit")) {
    const double unit = chip.quantity("file_unit", Dimension::length, kUnits);
    if (unit > 0) options.unit_m = unit;
  }
  if (chip.has("leave_out")) {
    for (const std::uint64_t channel : chip.integers("leave_out", 0, kMaxBoardChannel, {})) {
      options.leave_out.push_back(static_cast<std::uint32_t>(channel));
    }
  }
  const std::string name = chip.text("file");
  if (name.empty()) {
    if (!root.failed()) chip.report("file", "no name, allowed: a board file (.json, .svg)");
    return board;
  }
  attempt(chip, "file", [&] {
    const SceneFile& text = scene.files.keep(
        file_role::kBoard, [&] { return find_board(name, scene.source); }, board_text);
    board.path = text.path;
    BoardFile file = parse_board_file(text.text, text.path, options);
    const double length_m = file.pitch_m / board.resolution;
    if (!kLengths.contains(length_m)) {
      throw engine::InvalidInput(
          fmt::format("one r_c would be {:.3g} m (a pitch of {:.3g} m at {} r_c), allowed: {} to {} m",
                      length_m, file.pitch_m, board.resolution, kLengths.lower, kLengths.upper));
    }
    board.file = std::move(file);
  });
  return board;
}

Domain domain_around(const SceneBoard& board) {
  const Vector2d half = 0.5 * board.file.extent_m / board.length_m();
  const Eigen::Array2d reach = (half.array() + kUsualMargin * board.resolution).ceil();
  Domain domain;
  domain.lower = {-reach.x(), -reach.y(), 0};
  domain.upper = {reach.x(), reach.y(), kUsualHeight * board.resolution};
  return domain;
}

double default_gap(const SceneBoard& board) {
  // Where the drawing leaves more, a little more than that: neighbours must stay neighbours.
  return std::max(kUsualGap * board.resolution, 1.1 * board.file.drawn_gap_m / board.length_m());
}

}  // namespace dmf::chip
