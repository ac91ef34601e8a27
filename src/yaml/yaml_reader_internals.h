#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "yaml/invalid_input.h"
#include "yaml/yaml_document.h"
#include "yaml/yaml_reader.h"

// What the sources of YamlReader share, kept out of its header so that nobody else needs yaml-cpp.

namespace dmf {
namespace yaml_detail {

// What a file may ask for. Real scenes have some kilobytes; the limits keep a file of another kind from
// taking minutes and gigabytes. yaml-cpp takes some 300 bytes for a value of two characters.
inline constexpr std::size_t kMaxKeys = 10'000;  // of one mapping
inline constexpr std::size_t kMaxValues = 1
                                          << 20;  // read from lists: an alias may stand for a list many times
inline constexpr std::size_t kMostTold = 100;     // violations

inline int line_of(const YAML::Node& node) { return std::max(node.Mark().line, 0) + 1; }

/// A value as it can stand in a message: as written when it is short, else what kind of thing it is.
inline std::string shown(const YAML::Node& node) {
  constexpr std::size_t kLongest = 60;
  if (node.IsNull()) return "nothing";
  if (node.IsMap()) return "a mapping";
  if (node.IsSequence()) return fmt::format("a list of {}", node.size());
  const std::string& text = node.Scalar();
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

/// YAML marks a scalar in quotes as text whatever it looks like.
inline bool is_quoted(const YAML::Node& node) { return node.Tag() == "!"; }

inline std::string allowed_quantity(Dimension dimension, const Range& range, bool needs_unit) {
  const std::string units = unit_names(dimension);
  if (needs_unit) {
    const bool any = !std::isfinite(range.lower) && !std::isfinite(range.upper);
    const std::string base = units.substr(0, units.find(','));
    return fmt::format("{} with a unit ({})", any ? "a number" : range.text() + " " + base + ",", units);
  }
  std::string text = range.text(dimension);
  if (!units.empty()) text += fmt::format(" (units: {})", units);
  return text;
}

inline std::string count_text(const Count& count) {
  if (count.least == count.most) return fmt::format("{}", count.least);
  if (count.most == Count{}.most) return fmt::format("{} or more", count.least);
  return fmt::format("{} to {}", count.least, count.most);
}

inline bool contains(const Count& count, std::size_t size) {
  return size >= count.least && size <= count.most;
}

inline std::string join(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace yaml_detail

struct YamlReader::Document {
  struct Violation {
    int line;
    std::string text;
  };

  std::string name;
  std::optional<Units> units;
  std::vector<Violation> violations;
  std::size_t untold = 0;  ///< more violations
  std::size_t values = 0;  ///< read from lists
  /// Every mapping that was handed out, by path, so that reading one twice shares what is known of its keys.
  std::map<std::string, std::shared_ptr<Mapping>> mappings;

  void note(int line, const std::string& path, const std::string& violation) {
    const std::string where = path.empty() ? "" : path + ": ";
    const std::string text = fmt::format("{}:{}: {}{}", name, line, where, violation);
    // What is read twice is wrong twice, and told once.
    const auto same = [&text](const Violation& told) { return told.text == text; };
    if (std::any_of(violations.begin(), violations.end(), same)) return;
    if (violations.size() < yaml_detail::kMostTold) {
      violations.push_back({line, text});
    } else {
      ++untold;
    }
  }

  [[noreturn]] void refuse(int line, const std::string& violation) {
    throw InvalidInput(fmt::format("{}:{}: {}", name, line, violation));
  }
};

struct YamlReader::Mapping {
  struct Entry {
    std::string key;
    YAML::Node value;
    int line;
  };

  std::string path;
  int line = 1;
  std::vector<Entry> entries;
  std::set<std::string> known;

  const Entry* look_up(const std::string& key) const {
    for (const Entry& entry : entries) {
      if (entry.key == key) return &entry;
    }
    return nullptr;
  }

  /// Looks up for a getter: the key is known from now on.
  const Entry* find(const std::string& key) {
    known.insert(key);
    return look_up(key);
  }

  std::string path_of(const std::string& key) const {
    if (key.empty() || path.empty()) return path + key;
    return path + "." + key;
  }
};

/// What the getters share.
class YamlReader::Internals {
 public:
  static YamlReader read(const std::string& text, const std::string& name) {
    auto document = std::make_shared<Document>();
    document->name = name;
    try {
      const YAML::Node root = load_document(text);
      if (!root.IsMap()) document->refuse(1, "allowed: one mapping, `key: value` lines");
      return open(document, root, "");
    } catch (const YAML::Exception& error) {
      document->refuse(std::max(error.mark.line, 0) + 1, fmt::format("is not YAML: {}", error.msg));
    }
  }

  static YamlReader open(const std::shared_ptr<Document>& document, const YAML::Node& node,
                         const std::string& path) {
    std::shared_ptr<Mapping>& mapping = document->mappings[path];
    if (mapping) return {document, mapping};
    mapping = std::make_shared<Mapping>();
    mapping->path = path;
    mapping->line = yaml_detail::line_of(node);
    if (node.size() > yaml_detail::kMaxKeys) {
      document->note(mapping->line, path,
                     fmt::format("{} keys, allowed: up to {}", node.size(), yaml_detail::kMaxKeys));
      return {document, mapping};
    }
    for (const auto& pair : node) {
      const int line = yaml_detail::line_of(pair.first);
      if (!pair.first.IsScalar()) {
        document->note(line, path, fmt::format("{} as a key, allowed: text", yaml_detail::shown(pair.first)));
        continue;
      }
      const std::string& key = pair.first.Scalar();
      const auto same = [&key](const Mapping::Entry& entry) { return entry.key == key; };
      const auto first = std::find_if(mapping->entries.begin(), mapping->entries.end(), same);
      if (first == mapping->entries.end()) {
        mapping->entries.push_back({key, pair.second, line});
      } else {
        document->note(line, mapping->path_of(key),
                       fmt::format("given twice, first in line {}", first->line));
      }
    }
    return {document, mapping};
  }

  static YamlReader missing(const YamlReader& reader) { return {reader.document_, nullptr}; }

  /// The value of a key, or null after noting that it is required.
  static const Mapping::Entry* find(const YamlReader& reader, const std::string& key, bool required,
                                    const std::string& allowed) {
    if (!reader.mapping_) return nullptr;
    const Mapping::Entry* entry = reader.mapping_->find(key);
    if (!entry && required) {
      reader.document_->note(reader.mapping_->line, reader.mapping_->path_of(key),
                             fmt::format("missing, allowed: {}", allowed));
    }
    return entry;
  }

  static void refuse_value(const YamlReader& reader, const YAML::Node& node, const std::string& path,
                           const std::string& allowed) {
    int line = yaml_detail::line_of(node);
    // A value that is not there is marked where the next thing stands, often a line below its key.
    for (const Mapping::Entry& entry : reader.mapping_->entries) {
      if (entry.value.IsNull() && entry.value.is(node)) line = entry.line;
    }
    reader.document_->note(line, path, fmt::format("{}, allowed: {}", yaml_detail::shown(node), allowed));
  }

  static bool needs_unit(const YamlReader& reader, Dimension dimension) {
    return !reader.document_->units && is_reduced(dimension);
  }

  static std::optional<double> quantity(const YamlReader& reader, const YAML::Node& node,
                                        const std::string& path, Dimension dimension, const Range& range) {
    const bool unit_needed = needs_unit(reader, dimension);
    std::optional<WrittenQuantity> written;
    const bool text_for_number = dimension == Dimension::number && yaml_detail::is_quoted(node);
    if (node.IsScalar() && !text_for_number) written = parse_quantity(node.Scalar(), dimension);
    if (written && !(written->bare && unit_needed)) {
      const std::optional<Units>& units = reader.document_->units;
      const double native =
          written->bare || !units ? written->value : written->value / native_in_base(dimension, *units);
      if (range.contains(native)) return native;
    }
    refuse_value(reader, node, path, yaml_detail::allowed_quantity(dimension, range, unit_needed));
    return std::nullopt;
  }

  static std::optional<std::uint64_t> integer(const YamlReader& reader, const YAML::Node& node,
                                              const std::string& path, std::uint64_t least,
                                              std::uint64_t most) {
    if (node.IsScalar() && !yaml_detail::is_quoted(node)) {
      const std::string& text = node.Scalar();
      std::uint64_t value = 0;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      const bool whole = error == std::errc{} && end == text.data() + text.size();
      if (whole && value >= least && value <= most) return value;
    }
    refuse_value(reader, node, path, fmt::format("a whole number from {} to {}", least, most));
    return std::nullopt;
  }

  /// Reads each element of a list with `read(element, path)`; those that it refuses are left out.
  template <typename Value, typename Read>
  static std::vector<Value> list(const YamlReader& reader, const std::string& path, const YAML::Node& node,
                                 const Count& count, const char* of, const Read& read) {
    std::vector<Value> values;
    if (!node.IsSequence() || !yaml_detail::contains(count, node.size())) {
      refuse_value(reader, node, path, fmt::format("a list of {} {}", yaml_detail::count_text(count), of));
      return values;
    }
    reader.document_->values += node.size();
    if (reader.document_->values > yaml_detail::kMaxValues) {
      reader.document_->note(
          yaml_detail::line_of(node), path,
          fmt::format("too many values, allowed: {} in all lists", yaml_detail::kMaxValues));
      return values;
    }
    std::size_t index = 0;
    for (const YAML::Node& element : node) {
      if (auto value = read(element, fmt::format("{}[{}]", path, index++))) values.push_back(*value);
    }
    return values;
  }

  /// A list of lists under a key; a row that is wrong is left out.
  template <typename Value, typename Read>
  static std::vector<std::vector<Value>> rows(const YamlReader& reader, const std::string& key,
                                              const Count& row_count, const Count& column_count,
                                              const char* of, const Read& read) {
    const std::string allowed = fmt::format("a list of {} lists", yaml_detail::count_text(row_count));
    const auto* entry = find(reader, key, row_count.least > 0, allowed);
    if (!entry) return {};
    using Row = std::vector<Value>;
    const auto read_row = [&](const YAML::Node& node, const std::string& path) -> std::optional<Row> {
      Row row = list<Value>(reader, path, node, column_count, of, read);
      if (!node.IsSequence() || row.size() != node.size() || !yaml_detail::contains(column_count, row.size()))
        return {};
      return row;
    };
    return list<Row>(reader, reader.mapping_->path_of(key), entry->value, row_count, "lists", read_row);
  }
};

}  // namespace dmf
