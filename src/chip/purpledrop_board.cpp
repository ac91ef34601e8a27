#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <nlohmann/json.hpp>

#include "chip/board_drawing.h"
#include "yaml/units.h"

namespace dmf::chip {

namespace {

using Eigen::Vector2d;
using Json = nlohmann::json;

/// Real files are nested 8 deep.
constexpr int kMaxDepth = 32;

std::string shown(const Json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("a list of {}", value.size());
  constexpr std::size_t kLongest = 40;
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

/// Reads a board definition; what is wrong is noted with its place, and reading goes on.
class PurpledropReader {
 public:
  explicit PurpledropReader(BoardFaults& faults) : faults_(faults) {}

  BoardDrawing read(const Json& root) {
    const Json* layout = member(root, "layout", "");
    if (!layout) {
      faults_.note("layout", "missing, allowed: an object with `grids`, `grid` or `peripherals`");
      return drawing_;
    }
    if (const Json* old = member(*layout, "grid", "layout")) {
      drawing_.unit_hint = "`layout.grid` counts in grid units";
      drawing_.pitch = 1;
      read_pins(*old, "layout.grid", {0, 0}, 1);
    } else {
      drawing_.unit_m = 1e-3;
      each(*layout, "grids", "layout",
           [this](const Json& grid, const std::string& place) { read_grid(grid, place); });
    }
    if (const Json* templates = member(*layout, "peripheral_templates", "layout")) templates_ = templates;
    each(*layout, "peripherals", "layout",
         [this](const Json& peripheral, const std::string& place) { read_peripheral(peripheral, place); });
    return drawing_;
  }

 private:
  /// A member that is there and not null.
  const Json* member(const Json& object, const char* key, const std::string& place) {
    if (!object.is_object()) {
      faults_.note(place, fmt::format("{}, allowed: an object", shown(object)));
      return nullptr;
    }
    const auto found = object.find(key);
    return found == object.end() || found->is_null() ? nullptr : &*found;
  }

  template <typename Action>
  void each(const Json& object, const char* key, const std::string& place, const Action& action) {
    const Json* list = member(object, key, place);
    if (!list) return;
    const std::string here = fmt::format("{}.{}", place, key);
    if (!list->is_array()) return faults_.note(here, fmt::format("{}, allowed: a list", shown(*list)));
    for (std::size_t i = 0; i < list->size() && !faults_.many(); ++i)
      action((*list)[i], fmt::format("{}[{}]", here, i));
  }

  std::optional<double> number(const Json& value, const std::string& place) {
    if (value.is_number()) {
      const double number = value.get<double>();
      if (std::abs(number) <= kMaxCoordinate) return number;
    }
    faults_.note(place, fmt::format("{}, allowed: a number from {} to {}", shown(value), -kMaxCoordinate,
                                    kMaxCoordinate));
    return std::nullopt;
  }

  std::optional<Vector2d> point(const Json& value, const std::string& place) {
    if (!value.is_array() || value.size() != 2) {
      faults_.note(place, fmt::format("{}, allowed: [x, y]", shown(value)));
      return std::nullopt;
    }
    const auto x = number(value[0], place), y = number(value[1], place);
    if (!x || !y) return std::nullopt;
    return Vector2d(*x, *y);
  }

  /// The pin, nothing for a hole (null or -1) or after noting what is wrong.
  std::optional<std::uint32_t> pin(const Json& value, const std::string& place) {
    if (value.is_null() || value == -1) return std::nullopt;
    if (value.is_number_unsigned() && value.get<std::uint64_t>() <= kMaxBoardChannel)
      return value.get<std::uint32_t>();
    faults_.note(place, fmt::format("{}, allowed: a pin from 0 to {}, or null or -1 for a hole", shown(value),
                                    kMaxBoardChannel));
    return std::nullopt;
  }

  void read_grid(const Json& grid, const std::string& place) {
    const Json* origin = member(grid, "origin", place);
    const Json* pitch = member(grid, "pitch", place);
    const Json* pins = member(grid, "pins", place);
    if (!origin || !pitch || !pins) {
      return faults_.note(
          place, "origin, pitch or pins missing, allowed: {origin: [x, y], pitch, pins: [[...], ...]}");
    }
    const auto corner = point(*origin, place + ".origin");
    const auto width = number(*pitch, place + ".pitch");
    if (!corner || !width) return;
    if (*width <= 0) return faults_.note(place + ".pitch", fmt::format("{}, allowed: more than 0", *width));
    drawing_.pitch = std::min(*width, drawing_.pitch.value_or(*width));
    read_pins(*pins, place + ".pins", *corner, *width);
  }

  /// Squares that touch; the origin is a corner of the first one, as in PurpleDrop's own electrode_board.py.
  void read_pins(const Json& rows, const std::string& place, const Vector2d& origin, double pitch) {
    if (!rows.is_array())
      return faults_.note(place, fmt::format("{}, allowed: a list of rows of pins", shown(rows)));
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const std::string in_row = fmt::format("{}[{}]", place, row);
      if (!rows[row].is_array()) {
        faults_.note(in_row, fmt::format("{}, allowed: a list of pins", shown(rows[row])));
        continue;
      }
      for (std::size_t column = 0; column < rows[row].size() && !faults_.many(); ++column) {
        const std::string here = fmt::format("{}[{}]", in_row, column);
        const auto channel = pin(rows[row][column], here);
        if (!channel) continue;
        const Vector2d near = origin + pitch * Vector2d(column, row);
        add(*channel,
            {near, near + Vector2d(pitch, 0), near + Vector2d(pitch, pitch), near + Vector2d(0, pitch)},
            here);
      }
    }
  }

  void read_peripheral(const Json& peripheral, const std::string& place) {
    const Json* written_origin = member(peripheral, "origin", place);
    if (!written_origin) return faults_.note(place + ".origin", "missing, allowed: [x, y]");
    const auto origin = point(*written_origin, place + ".origin");
    double rotation = 0;
    if (const Json* written = member(peripheral, "rotation", place)) {
      rotation = number(*written, place + ".rotation").value_or(0);
    }
    const Json* type = member(peripheral, "type", place);
    each(peripheral, "electrodes", place, [&](const Json& electrode, const std::string& here) {
      if (origin) read_electrode(electrode, here, template_of(type), *origin, rotation);
    });
  }

  /// The template of a peripheral's type, null without one.
  const Json* template_of(const Json* type) {
    if (!type || !type->is_string() || !templates_ || !templates_->is_object()) return nullptr;
    const auto found = templates_->find(type->get<std::string>());
    return found == templates_->end() ? nullptr : &*found;
  }

  /// What an electrode leaves out stands in its template, under the same id.
  const Json* inherited(const Json& electrode, const Json* from, const char* key, const std::string& place) {
    if (const Json* own = member(electrode, key, place)) return own;
    if (!from || !from->is_object() || !from->contains("electrodes") || !electrode.contains("id"))
      return nullptr;
    for (const Json& entry : from->at("electrodes")) {
      if (!entry.is_object() || !entry.contains("id") || entry["id"] != electrode["id"]) continue;
      return member(entry, key, place);
    }
    return nullptr;
  }

  /// Placed as PurpleDrop's own user interface draws it (layout.js): moved by both origins, then turned about
  /// the peripheral's. Its electrode_board.py leaves out the electrode's origin.
  void read_electrode(const Json& electrode, const std::string& place, const Json* from,
                      const Vector2d& origin, double rotation) {
    if (!electrode.is_object())
      return faults_.note(place, fmt::format("{}, allowed: an object", shown(electrode)));
    const auto written_pin = electrode.find("pin");
    if (written_pin == electrode.end())
      return faults_.note(place + ".pin", "missing, allowed: a pin, or null for none");
    const auto channel = pin(*written_pin, place + ".pin");
    if (!channel) return;
    const Json* corners = inherited(electrode, from, "polygon", place);
    if (!corners || !corners->is_array()) {
      return faults_.note(place + ".polygon",
                          "missing, allowed: [[x, y], ...], here or in the template of the type");
    }
    if (corners->size() > kMaxCorners) {
      return faults_.note(place + ".polygon",
                          fmt::format("{} corners, allowed: {}", corners->size(), kMaxCorners));
    }
    Vector2d moved = Vector2d::Zero();
    if (const Json* own = inherited(electrode, from, "origin", place)) {
      moved = point(*own, place + ".origin").value_or(moved);
    }
    const Eigen::Rotation2Dd turn(rotation * degree);
    Polygon outline;
    for (std::size_t i = 0; i < corners->size(); ++i) {
      const auto corner = point((*corners)[i], fmt::format("{}.polygon[{}]", place, i));
      if (!corner) return;
      outline.push_back(turn * (*corner + moved) + origin);
    }
    // Some boards repeat the first corner at the end, some do not.
    if (outline.size() > 1 && corners->front() == corners->back()) outline.pop_back();
    add(*channel, std::move(outline), place);
  }

  void add(std::uint32_t channel, Polygon outline, const std::string& place) {
    if (drawing_.electrodes.size() == kMaxBoardElectrodes) {
      faults_.note(place, fmt::format("one electrode too many, allowed: {}", kMaxBoardElectrodes));
    }
    if (drawing_.electrodes.size() <= kMaxBoardElectrodes) {
      drawing_.electrodes.push_back({channel, std::move(outline), place});
    }
  }

  BoardFaults& faults_;
  BoardDrawing drawing_;
  const Json* templates_ = nullptr;
};

}  // namespace

BoardDrawing read_purpledrop(const std::string& text, BoardFaults& faults) {
  // Numbers out of range and broken text end the parsing by exception, depth by the callback.
  bool too_deep = false;
  const auto watch_depth = [&too_deep](int depth, Json::parse_event_t, Json&) {
    too_deep = too_deep || depth > kMaxDepth;
    return depth <= kMaxDepth;
  };
  try {
    const Json root = Json::parse(text, watch_depth);
    if (!too_deep) return PurpledropReader(faults).read(root);
    faults.note("", fmt::format("nested too deep, allowed: {} levels", kMaxDepth));
  } catch (const Json::exception& error) {
    faults.note("", fmt::format("is not JSON: {}", error.what()));
  }
  return {};
}

}  // namespace dmf::chip
