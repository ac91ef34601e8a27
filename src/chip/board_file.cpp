#include "chip/board_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>

#include "chip/board_drawing.h"
#include "chip/polygon.h"
#include "engine/parameters.h"

namespace dmf::chip {

namespace {

namespace fs = std::filesystem;

/// The largest board of the public collections has half a megabyte.
constexpr std::uintmax_t kMaxBytes = 4 << 20;

/// Drawings round their corners: what two electrodes may share, of the smaller one.
constexpr double kTolerableOverlap = 1e-3;

/// Neighbours after drawing in are this part of the gap apart.
constexpr double kDistanceOfNeighbours = 0.9;

/// And what is left of an electrode is so much of it in one piece.
constexpr double kMainPart = 0.9;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Of an electrode that was drawn in: the tips of its teeth may have come off. Empty when more than that has.
Polygon main_piece(std::vector<Polygon> pieces) {
  double all = 0;
  for (const Polygon& piece : pieces) all += area(piece);
  for (Polygon& piece : pieces) {
    if (area(piece) >= kMainPart * all) return std::move(piece);
  }
  return {};
}

void leave_out(const std::vector<std::uint32_t>& channels, BoardDrawing& drawing, BoardFaults& faults) {
  auto& electrodes = drawing.electrodes;
  for (const std::uint32_t channel : channels) {
    const auto of_channel = [channel](const DrawnElectrode& electrode) {
      return electrode.channel == channel;
    };
    const auto rest = std::remove_if(electrodes.begin(), electrodes.end(), of_channel);
    if (rest == electrodes.end()) {
      faults.note("", fmt::format("leave_out: channel {}, allowed: channels of the file", channel));
    }
    electrodes.erase(rest, electrodes.end());
  }
}

void check_each(const BoardDrawing& drawing, BoardFaults& faults) {
  std::size_t corners = 0;
  for (const DrawnElectrode& electrode : drawing.electrodes) corners += electrode.outline.size();
  if (corners > kMaxBoardCorners) {
    return faults.note("", fmt::format("{} corners, allowed: {} in all", corners, kMaxBoardCorners));
  }
  std::map<std::uint32_t, std::string> first;
  for (const DrawnElectrode& electrode : drawing.electrodes) {
    const auto [earlier, is_new] = first.emplace(electrode.channel, electrode.place);
    if (!is_new) {
      faults.note(electrode.place,
                  fmt::format("channel {} given twice, first at {}, allowed: one electrode a channel "
                              "(`leave_out` passes over a channel)",
                              electrode.channel, earlier->second));
    }
    const std::string fault = polygon_fault(electrode.outline);
    if (!fault.empty()) faults.note(electrode.place, fmt::format("channel {}: {}", electrode.channel, fault));
  }
}

/// Notes what overlaps. @returns the distance of each electrode to the nearest other one.
std::vector<double> check_pairs(const BoardDrawing& drawing, BoardFaults& faults) {
  const auto& electrodes = drawing.electrodes;
  const std::size_t count = electrodes.size();
  std::vector<double> nearest(count, std::numeric_limits<double>::infinity());
  std::vector<Eigen::AlignedBox2d> boxes;
  std::vector<Polygon> outlines;
  for (const DrawnElectrode& electrode : electrodes) {
    boxes.push_back(bounding_box(electrode.outline));
    outlines.push_back(counter_clockwise(electrode.outline));
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count && !faults.many(); ++j) {
      const double apart = boxes[i].exteriorDistance(boxes[j]);
      if (apart > 0 && apart >= nearest[i] && apart >= nearest[j]) continue;
      const double between = distance(outlines[i], outlines[j]);
      nearest[i] = std::min(nearest[i], between);
      nearest[j] = std::min(nearest[j], between);
      if (between > 0) continue;
      // Where edges lie on each other, rounding makes them cross now and then; the area decides. Outlines
      // that cross everywhere need no area, which would take minutes.
      const double smaller = std::min(area(outlines[i]), area(outlines[j]));
      if (crossings(outlines[i], outlines[j]) <= kMaxCorners &&
          shared_area(outlines[i], outlines[j]) <= kTolerableOverlap * smaller) {
        continue;
      }
      faults.note(electrodes[j].place,
                  fmt::format("channel {} overlaps channel {} ({}), allowed: outlines that touch",
                              electrodes[j].channel, electrodes[i].channel, electrodes[i].place));
    }
  }
  return nearest;
}

/// To metres, y up, the middle of the bounding box at (0, 0).
BoardFile scaled(const BoardDrawing& drawing, double unit_m, const std::vector<double>& nearest) {
  BoardFile board;
  Eigen::AlignedBox2d box;
  std::vector<double> areas;
  for (const DrawnElectrode& electrode : drawing.electrodes) {
    box.extend(bounding_box(electrode.outline));
    areas.push_back(area(electrode.outline));
  }
  for (const DrawnElectrode& drawn : drawing.electrodes) {
    Electrode electrode;
    electrode.channel = drawn.channel;
    for (const Vector2d& corner : drawn.outline) {
      const Vector2d from_middle = (corner - box.center()) * unit_m;
      electrode.outline.emplace_back(from_middle.x(), -from_middle.y());
    }
    electrode.outline = counter_clockwise(electrode.outline);
    electrode.centroid = centroid(electrode.outline);
    board.electrodes.push_back(std::move(electrode));
  }
  board.extent_m = box.sizes() * unit_m;
  board.pitch_m = drawing.pitch.value_or(std::sqrt(median(areas))) * unit_m;
  if (nearest.size() > 1) board.drawn_gap_m = median(nearest) * unit_m;
  return board;
}

double unit_of(const BoardDrawing& drawing, const BoardFileOptions& options, bool is_json,
               BoardFaults& faults) {
  if (!drawing.unit_m && !options.unit_m) {
    faults.note(
        "", fmt::format("{}, allowed: with `file_unit`, what one unit of the file is", drawing.unit_hint));
  }
  if (drawing.unit_m && options.unit_m && !is_json) {
    faults.note("", "has a <scale>, and `file_unit` is given too, allowed: one of both");
  }
  return options.unit_m.value_or(drawing.unit_m.value_or(1));
}

}  // namespace

void BoardFaults::note(const std::string& place, const std::string& violation) {
  if (count_++ < kMostTold) told_.push_back(place.empty() ? violation : place + ": " + violation);
}

void BoardFaults::refuse_if_any(const std::string& file) const {
  if (!any()) return;
  std::string text;
  for (const std::string& fault : told_)
    text += fmt::format("{}{}: {}", text.empty() ? "" : "\n", file, fault);
  if (count_ > told_.size()) text += fmt::format("\n{}: and {} more", file, count_ - told_.size());
  throw engine::InvalidInput(text);
}

bool is_board_file(const std::string& file) {
  const std::string extension = fs::path(file).extension().string();
  return extension == ".json" || extension == ".svg";
}

BoardFile parse_board_file(const std::string& text, const std::string& name,
                           const BoardFileOptions& options) {
  BoardFaults faults;
  const bool is_json = fs::path(name).extension() == ".json";
  if (!is_board_file(name)) {
    faults.note("", "allowed: a PurpleDrop board definition (.json) or a MicroDrop device drawing (.svg)");
    faults.refuse_if_any(name);
  }
  BoardDrawing drawing = is_json ? read_purpledrop(text, faults) : read_microdrop(text, faults);
  faults.refuse_if_any(name);
  leave_out(options.leave_out, drawing, faults);
  if (drawing.electrodes.empty()) {
    faults.note("", is_json ? "no electrodes, allowed: one or more pins in `grids`, `grid` or `peripherals`"
                            : "no electrodes, allowed: one or more path, polygon or rect with data-channels");
  }
  const double unit_m = unit_of(drawing, options, is_json, faults);
  check_each(drawing, faults);
  faults.refuse_if_any(name);
  const std::vector<double> nearest = check_pairs(drawing, faults);
  faults.refuse_if_any(name);
  return scaled(drawing, unit_m, nearest);
}

BoardFile read_board_file(const std::string& file, const BoardFileOptions& options) {
  return parse_board_file(board_text(file), file, options);
}

std::string board_text(const std::string& file) {
  std::error_code error;
  // A pipe or a device would never come to an end.
  if (!fs::is_regular_file(file, error)) throw engine::InvalidInput(fmt::format("{}: is no file", file));
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error || bytes > kMaxBytes) {
    throw engine::InvalidInput(fmt::format("{}: {} bytes, allowed: up to {}", file, bytes, kMaxBytes));
  }
  std::string text(bytes, '\0');
  std::ifstream input(file, std::ios::binary);
  if (!input.read(text.data(), static_cast<std::streamsize>(bytes))) {
    throw engine::InvalidInput(fmt::format("{}: can't be read", file));
  }
  return text;
}

std::vector<Electrode> electrodes_of(const BoardFile& board, double length_m, double gap) {
  const double inwards = 0.5 * (kDistanceOfNeighbours * gap - board.drawn_gap_m / length_m);
  std::vector<std::string> violations;
  std::vector<Electrode> electrodes;
  for (const Electrode& in_metres : board.electrodes) {
    Electrode electrode;
    electrode.channel = in_metres.channel;
    for (const Vector2d& corner : in_metres.outline) electrode.outline.push_back(corner / length_m);
    if (inwards > 0) electrode.outline = main_piece(drawn_in(electrode.outline, inwards));
    if (!polygon_fault(electrode.outline).empty()) {
      violations.push_back(fmt::format(
          "channel {}: too narrow to be drawn in by {:.3g} r_c, allowed: a smaller gap (now {:.3g} "
          "r_c), a finer resolution, or `leave_out`",
          electrode.channel, inwards, gap));
    }
    electrodes.push_back(std::move(electrode));
  }
  if (!violations.empty()) throw engine::InvalidInput(fmt::format("{}", fmt::join(violations, "\n")));
  return electrodes;
}

}  // namespace dmf::chip
