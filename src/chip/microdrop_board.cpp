#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "chip/board_drawing.h"
#include "chip/svg_path.h"
#include "engine/parameters.h"
#include "yaml/quantity.h"

namespace dmf::chip {

namespace {

using Eigen::Affine2d;
using Eigen::Vector2d;
using tinyxml2::XMLElement;

constexpr const char* kChannels = "data-channels";

/// The name without its namespace prefix: files say `path`, `svg:path` or `ns0:path`.
std::string_view local_name(const XMLElement& element) {
  const std::string_view name = element.Name();
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

std::string shown(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  return text.size() <= kLongest ? std::string(text) : std::string(text.substr(0, kLongest)) + "...";
}

std::string place_of(const XMLElement& element) {
  const char* id = element.Attribute("id");
  return fmt::format("line {}: {}{}", element.GetLineNum(), local_name(element),
                     id ? fmt::format(" `{}`", shown(id)) : "");
}

std::string_view trimmed(std::string_view text) {
  constexpr const char* kSpace = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

/// A number and nothing else; "1mm" is none.
std::optional<double> whole_number(std::string_view text) {
  text = trimmed(text);
  const auto value = take_number(text);
  return text.empty() ? value : std::nullopt;
}

class MicrodropReader {
 public:
  explicit MicrodropReader(BoardFaults& faults) : faults_(faults) {
    drawing_.unit_hint = "no <scale> in its <metadata>";
  }

  BoardDrawing read(const XMLElement& root) {
    if (local_name(root) != "svg") {
      faults_.note(place_of(root), "allowed: svg as the outermost element");
      return drawing_;
    }
    visit(root, Affine2d::Identity());
    return drawing_;
  }

 private:
  /// The parser goes at most 100 elements deep, so this does too.
  void visit(const XMLElement& element, const Affine2d& outer) {
    const std::string_view name = local_name(element);
    if (name == "defs" || name == "symbol" || name == "clipPath" || name == "mask") return;  // not drawn
    if (name == "metadata") return read_scale(element);
    if (name == "svg" && element.Parent()->ToElement()) {
      return faults_.note(place_of(element), "a drawing in the drawing, allowed: one svg element");
    }
    if (const char* style = element.Attribute("style"); style && std::strstr(style, "transform")) {
      faults_.note(place_of(element), "a transform in its style, allowed: in the attribute `transform`");
    }
    Affine2d transform = outer;
    if (const char* own = element.Attribute("transform")) {
      attempt(element, "transform", [&] { transform = outer * svg_transform(own); });
    }
    if (element.Attribute(kChannels)) read_electrode(element, name, transform);
    for (const XMLElement* child = element.FirstChildElement(); child && !faults_.many();
         child = child->NextSiblingElement()) {
      visit(*child, transform);
    }
  }

  /// `<scale>` in the file's metadata: mm^2 on the board for one square unit of the drawing.
  void read_scale(const XMLElement& metadata) {
    for (const XMLElement* child = metadata.FirstChildElement(); child; child = child->NextSiblingElement()) {
      if (local_name(*child) != "scale") continue;
      const char* text = child->GetText();
      const auto area = whole_number(text ? text : "");
      if (!area || *area <= 0 || *area > kMaxCoordinate) {
        faults_.note(place_of(*child),
                     fmt::format("{}, allowed: more than 0 mm^2 for a square unit of the drawing",
                                 text ? shown(text) : "nothing"));
        continue;
      }
      if (drawing_.unit_m) faults_.note(place_of(*child), "given twice, allowed: one scale");
      drawing_.unit_m = std::sqrt(*area) * 1e-3;
    }
  }

  void read_electrode(const XMLElement& element, std::string_view name, const Affine2d& transform) {
    const auto channel = read_channel(element);
    Polygon outline;
    bool sound = false;
    if (name == "path" || name == "polygon") {
      const char* key = name == "path" ? "d" : "points";
      const char* data = element.Attribute(key);
      sound = attempt(element, key, [&] {
        outline = name == "path" ? closed_path(data ? data : "") : polygon_points(data ? data : "");
      });
    } else if (name == "rect") {
      sound = read_rect(element, outline);
    } else {
      faults_.note(place_of(element), "has channels, allowed: path, polygon or rect as an electrode");
    }
    if (!channel || !sound) return;
    for (Vector2d& corner : outline) {
      corner = transform * corner;
      if ((corner.array().abs() <= kMaxCoordinate).all()) continue;
      return faults_.note(
          place_of(element),
          fmt::format("the point ({:.6g}, {:.6g}) after all transforms, allowed: coordinates from {} to {}",
                      corner.x(), corner.y(), -kMaxCoordinate, kMaxCoordinate));
    }
    if (drawing_.electrodes.size() == kMaxBoardElectrodes) {
      faults_.note(place_of(element),
                   fmt::format("one electrode too many, allowed: {}", kMaxBoardElectrodes));
    }
    if (drawing_.electrodes.size() <= kMaxBoardElectrodes) {
      drawing_.electrodes.push_back({*channel, std::move(outline), place_of(element)});
    }
  }

  std::optional<std::uint32_t> read_channel(const XMLElement& element) {
    const std::string_view text = trimmed(element.Attribute(kChannels));
    std::uint32_t channel = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), channel);
    if (error == std::errc{} && end == text.data() + text.size() && channel <= kMaxBoardChannel)
      return channel;
    faults_.note(place_of(element), fmt::format("{} {}, allowed: one channel from 0 to {}", kChannels,
                                                shown(text), kMaxBoardChannel));
    return std::nullopt;
  }

  bool read_rect(const XMLElement& element, Polygon& outline) {
    constexpr std::array<const char*, 4> kKeys{"x", "y", "width", "height"};
    std::array<double, 4> value{};
    for (std::size_t i = 0; i < 4; ++i) {
      const char* text = element.Attribute(kKeys[i]);
      const auto number = text ? whole_number(text) : std::optional<double>(0);
      const bool fits = number && std::abs(*number) <= kMaxCoordinate && (i < 2 || *number > 0);
      if (!fits) {
        faults_.note(place_of(element),
                     fmt::format("{} {}, allowed: {}", kKeys[i], text ? shown(text) : "missing",
                                 i < 2 ? "a number" : "a number above 0"));
        return false;
      }
      value[i] = *number;
    }
    if (element.Attribute("rx") || element.Attribute("ry")) {
      faults_.note(place_of(element), "rounded corners (rx, ry), allowed: a rect without them, or a path");
      return false;
    }
    const auto [x, y, width, height] = value;
    outline = {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
    return true;
  }

  template <typename Action>
  bool attempt(const XMLElement& element, const char* attribute, const Action& action) {
    try {
      action();
      return true;
    } catch (const engine::InvalidInput& refusal) {
      faults_.note(place_of(element), fmt::format("{}: {}", attribute, refusal.what()));
      return false;
    }
  }

  BoardFaults& faults_;
  BoardDrawing drawing_;
};

}  // namespace

BoardDrawing read_microdrop(const std::string& text, BoardFaults& faults) {
  // TinyXML-2 expands no entities and loads nothing from elsewhere; a file that declares any means something
  // that it would not get.
  if (const std::size_t at = text.find("<!ENTITY"); at != std::string::npos) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    faults.note(fmt::format("line {}", line), "declares an entity, allowed: a drawing without <!ENTITY");
    return {};
  }
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  if (document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED) {
    faults.note(fmt::format("line {}", document.ErrorLineNum()), "nested too deep, allowed: 100 elements");
  } else if (document.Error() || !document.RootElement()) {
    faults.note(fmt::format("line {}", document.ErrorLineNum()),
                fmt::format("is not XML ({})", document.ErrorName()));
  } else {
    return MicrodropReader(faults).read(*document.RootElement());
  }
  return {};
}

}  // namespace dmf::chip
