#include "yaml/yaml_reader.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <set>

#include "yaml/invalid_input.h"
#include "yaml/yaml_document.h"

namespace dmf {

namespace {

// What a file may ask for. Real scenes have some kilobytes; the limits keep a file of another kind from
// taking minutes and gigabytes. yaml-cpp takes some 300 bytes for a value of two characters.
constexpr std::uintmax_t kMaxBytes = 1 << 20;
constexpr std::size_t kMaxPath = 4000;       // characters; file systems allow no more
constexpr std::size_t kMaxKeys = 10'000;     // of one mapping
constexpr std::size_t kMaxValues = 1 << 20;  // read from lists: an alias may stand for a list many times
constexpr std::size_t kMostTold = 100;       // violations

int line_of(const YAML::Node& node) { return std::max(node.Mark().line, 0) + 1; }

/// A value as it can stand in a message: as written when it is short, else what kind of thing it is.
std::string shown(const YAML::Node& node) {
  constexpr std::size_t kLongest = 60;
  if (node.IsNull()) return "nothing";
  if (node.IsMap()) return "a mapping";
  if (node.IsSequence()) return fmt::format("a list of {}", node.size());
  const std::string& text = node.Scalar();
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

/// YAML marks a scalar in quotes as text whatever it looks like.
bool is_quoted(const YAML::Node& node) { return node.Tag() == "!"; }

std::string allowed_quantity(Dimension dimension, const Range& range, bool needs_unit) {
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

std::string count_text(const Count& count) {
  if (count.least == count.most) return fmt::format("{}", count.least);
  if (count.most == Count{}.most) return fmt::format("{} or more", count.least);
  return fmt::format("{} to {}", count.least, count.most);
}

bool contains(const Count& count, std::size_t size) { return size >= count.least && size <= count.most; }

std::string join(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

}  // namespace

// ---- what a file holds ----

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
    if (violations.size() < kMostTold) {
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

/// What the getters share, kept out of the header so that it needs no yaml-cpp.
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
    mapping->line = line_of(node);
    if (node.size() > kMaxKeys) {
      document->note(mapping->line, path, fmt::format("{} keys, allowed: up to {}", node.size(), kMaxKeys));
      return {document, mapping};
    }
    for (const auto& pair : node) {
      const int line = line_of(pair.first);
      if (!pair.first.IsScalar()) {
        document->note(line, path, fmt::format("{} as a key, allowed: text", shown(pair.first)));
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
    int line = line_of(node);
    // A value that is not there is marked where the next thing stands, often a line below its key.
    for (const Mapping::Entry& entry : reader.mapping_->entries) {
      if (entry.value.IsNull() && entry.value.is(node)) line = entry.line;
    }
    reader.document_->note(line, path, fmt::format("{}, allowed: {}", shown(node), allowed));
  }

  static bool needs_unit(const YamlReader& reader, Dimension dimension) {
    return !reader.document_->units && is_reduced(dimension);
  }

  static std::optional<double> quantity(const YamlReader& reader, const YAML::Node& node,
                                        const std::string& path, Dimension dimension, const Range& range) {
    const bool unit_needed = needs_unit(reader, dimension);
    std::optional<WrittenQuantity> written;
    const bool text_for_number = dimension == Dimension::number && is_quoted(node);
    if (node.IsScalar() && !text_for_number) written = parse_quantity(node.Scalar(), dimension);
    if (written && !(written->bare && unit_needed)) {
      const std::optional<Units>& units = reader.document_->units;
      const double native =
          written->bare || !units ? written->value : written->value / native_in_base(dimension, *units);
      if (range.contains(native)) return native;
    }
    refuse_value(reader, node, path, allowed_quantity(dimension, range, unit_needed));
    return std::nullopt;
  }

  static std::optional<std::uint64_t> integer(const YamlReader& reader, const YAML::Node& node,
                                              const std::string& path, std::uint64_t least,
                                              std::uint64_t most) {
    if (node.IsScalar() && !is_quoted(node)) {
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
    if (!node.IsSequence() || !contains(count, node.size())) {
      refuse_value(reader, node, path, fmt::format("a list of {} {}", count_text(count), of));
      return values;
    }
    reader.document_->values += node.size();
    if (reader.document_->values > kMaxValues) {
      reader.document_->note(line_of(node), path,
                             fmt::format("too many values, allowed: {} in all lists", kMaxValues));
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
    const std::string allowed = fmt::format("a list of {} lists", count_text(row_count));
    const auto* entry = find(reader, key, row_count.least > 0, allowed);
    if (!entry) return {};
    using Row = std::vector<Value>;
    const auto read_row = [&](const YAML::Node& node, const std::string& path) -> std::optional<Row> {
      Row row = list<Value>(reader, path, node, column_count, of, read);
      if (!node.IsSequence() || row.size() != node.size() || !contains(column_count, row.size())) return {};
      return row;
    };
    return list<Row>(reader, reader.mapping_->path_of(key), entry->value, row_count, "lists", read_row);
  }
};

// ---- opening and closing ----

YamlReader::YamlReader(std::shared_ptr<Document> document, std::shared_ptr<Mapping> mapping)
    : document_(std::move(document)), mapping_(std::move(mapping)) {}

YamlReader YamlReader::load(const std::string& file) { return parse(text_of(file), file); }

std::string YamlReader::text_of(const std::string& file) {
  if (file.size() > kMaxPath)
    throw InvalidInput(fmt::format("{}...: a path of {} characters, allowed: up to {}", file.substr(0, 60),
                                   file.size(), kMaxPath));
  std::error_code error;
  // A pipe or a device would never come to an end.
  if (!std::filesystem::is_regular_file(file, error))
    throw InvalidInput(fmt::format("{}: can't be read, allowed: a file", file));
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (error || bytes == 0 || bytes > kMaxBytes)
    throw InvalidInput(fmt::format("{}: {} bytes, allowed: 1 to {}", file, bytes, kMaxBytes));
  std::string text(bytes, '\0');
  std::ifstream input(file, std::ios::binary);
  if (!input.read(text.data(), static_cast<std::streamsize>(bytes)))
    throw InvalidInput(fmt::format("{}: can't be read", file));
  return text;
}

YamlReader YamlReader::parse(const std::string& text, const std::string& name) {
  if (text.size() > kMaxBytes)
    throw InvalidInput(fmt::format("{}: {} bytes, allowed: up to {}", name, text.size(), kMaxBytes));
  return Internals::read(text, name);
}

void YamlReader::set_units(const Units& units) { document_->units = units; }

bool YamlReader::failed() const { return !document_->violations.empty(); }

void YamlReader::report(const std::string& key, const std::string& violation) const {
  if (!mapping_) return;
  const Mapping::Entry* entry = mapping_->look_up(key);
  document_->note(entry ? entry->line : mapping_->line, mapping_->path_of(key), violation);
}

void YamlReader::report_path(const std::string& violation) const {
  std::string path = violation.substr(0, violation.find(':'));
  int line = 1;
  // "liquid.attraction" may be written as a key of the mapping "liquid", or "liquid" may not be there at all.
  for (std::string part = path; !part.empty();) {
    const std::size_t dot = part.rfind('.');
    const auto parent = document_->mappings.find(dot == std::string::npos ? "" : part.substr(0, dot));
    if (parent != document_->mappings.end()) {
      if (const Mapping::Entry* entry = parent->second->look_up(part.substr(dot + 1))) {
        line = entry->line;
        break;
      }
    }
    part.resize(dot == std::string::npos ? 0 : dot);
  }
  document_->note(line, "", violation);
}

void YamlReader::finish() const {
  for (const auto& [path, mapping] : document_->mappings) {
    const std::vector<std::string> known(mapping->known.begin(), mapping->known.end());
    for (const Mapping::Entry& entry : mapping->entries) {
      if (mapping->known.count(entry.key)) continue;
      const std::string near = nearest_word(entry.key, known);
      const std::string hint = near.empty() ? "" : fmt::format(", did you mean `{}`?", near);
      document_->note(entry.line, mapping->path_of(entry.key),
                      fmt::format("unknown key{} allowed: {}", hint.empty() ? "," : hint, join(known)));
    }
  }
  if (!failed()) return;
  auto& violations = document_->violations;
  std::stable_sort(violations.begin(), violations.end(),
                   [](const auto& a, const auto& b) { return a.line < b.line; });
  std::vector<std::string> lines;
  for (const auto& violation : violations) lines.push_back(violation.text);
  if (document_->untold > 0)
    lines.push_back(fmt::format("{}: and {} more", document_->name, document_->untold));
  throw InvalidInput(fmt::format("{}", fmt::join(lines, "\n")));
}

// ---- getters ----

bool YamlReader::has(const std::string& key) const { return mapping_ && mapping_->find(key); }

double YamlReader::number(const std::string& key, const Range& range, std::optional<double> fallback) const {
  return quantity(key, Dimension::number, range, fallback);
}

double YamlReader::quantity(const std::string& key, Dimension dimension, const Range& range,
                            std::optional<double> fallback) const {
  const std::string allowed = allowed_quantity(dimension, range, Internals::needs_unit(*this, dimension));
  const auto* entry = Internals::find(*this, key, !fallback, allowed);
  if (!entry) return fallback.value_or(0);
  return Internals::quantity(*this, entry->value, mapping_->path_of(key), dimension, range)
      .value_or(fallback.value_or(0));
}

std::vector<double> YamlReader::quantities(const std::string& key, Dimension dimension, const Range& range,
                                           const Count& count) const {
  const auto* entry =
      Internals::find(*this, key, count.least > 0, fmt::format("a list of {} numbers", count_text(count)));
  if (!entry) return {};
  return Internals::list<double>(*this, mapping_->path_of(key), entry->value, count, "numbers",
                                 [&](const YAML::Node& node, const std::string& path) {
                                   return Internals::quantity(*this, node, path, dimension, range);
                                 });
}

std::vector<std::vector<double>> YamlReader::rows(const std::string& key, Dimension dimension,
                                                  const Range& range, const Count& row_count,
                                                  const Count& column_count) const {
  return Internals::rows<double>(*this, key, row_count, column_count, "numbers",
                                 [&](const YAML::Node& node, const std::string& path) {
                                   return Internals::quantity(*this, node, path, dimension, range);
                                 });
}

std::uint64_t YamlReader::integer(const std::string& key, std::uint64_t least, std::uint64_t most,
                                  std::optional<std::uint64_t> fallback) const {
  const auto* entry =
      Internals::find(*this, key, !fallback, fmt::format("a whole number from {} to {}", least, most));
  if (!entry) return fallback.value_or(least);
  return Internals::integer(*this, entry->value, mapping_->path_of(key), least, most)
      .value_or(fallback.value_or(least));
}

std::vector<std::uint64_t> YamlReader::integers(const std::string& key, std::uint64_t least,
                                                std::uint64_t most, const Count& count) const {
  // A list of integers may be empty and still has to be there: "channels: []" switches all off.
  const auto* entry =
      Internals::find(*this, key, true, fmt::format("a list of {} whole numbers", count_text(count)));
  if (!entry) return {};
  return Internals::list<std::uint64_t>(*this, mapping_->path_of(key), entry->value, count, "whole numbers",
                                        [&](const YAML::Node& node, const std::string& path) {
                                          return Internals::integer(*this, node, path, least, most);
                                        });
}

std::vector<std::vector<std::uint64_t>> YamlReader::integer_rows(const std::string& key, std::uint64_t least,
                                                                 std::uint64_t most, const Count& row_count,
                                                                 const Count& column_count) const {
  return Internals::rows<std::uint64_t>(*this, key, row_count, column_count, "whole numbers",
                                        [&](const YAML::Node& node, const std::string& path) {
                                          return Internals::integer(*this, node, path, least, most);
                                        });
}

bool YamlReader::boolean(const std::string& key, std::optional<bool> fallback) const {
  const auto* entry = Internals::find(*this, key, !fallback, "true or false");
  if (!entry) return fallback.value_or(false);
  const YAML::Node& node = entry->value;
  // YAML 1.1 also takes yes, on, y: too easily a switch's name.
  if (node.IsScalar() && !is_quoted(node) && (node.Scalar() == "true" || node.Scalar() == "false")) {
    return node.Scalar() == "true";
  }
  Internals::refuse_value(*this, node, mapping_->path_of(key), "true or false");
  return fallback.value_or(false);
}

std::string YamlReader::text(const std::string& key, std::optional<std::string> fallback) const {
  const auto* entry = Internals::find(*this, key, !fallback, "text");
  if (!entry) return fallback.value_or("");
  if (entry->value.IsScalar()) return entry->value.Scalar();
  Internals::refuse_value(*this, entry->value, mapping_->path_of(key), "text");
  return fallback.value_or("");
}

std::vector<std::string> YamlReader::texts(const std::string& key, const Count& count) const {
  const auto* entry = Internals::find(*this, key, true, fmt::format("a list of {} texts", count_text(count)));
  if (!entry) return {};
  return Internals::list<std::string>(
      *this, mapping_->path_of(key), entry->value, count, "texts",
      [&](const YAML::Node& node, const std::string& path) -> std::optional<std::string> {
        if (node.IsScalar()) return node.Scalar();
        Internals::refuse_value(*this, node, path, "text");
        return std::nullopt;
      });
}

std::string YamlReader::choice(const std::string& key, const std::vector<std::string>& words,
                               std::optional<std::string> fallback) const {
  const std::string otherwise = fallback.value_or(words.front());
  const auto* entry = Internals::find(*this, key, !fallback, join(words));
  if (!entry) return otherwise;
  const YAML::Node& node = entry->value;
  if (node.IsScalar() && std::count(words.begin(), words.end(), node.Scalar())) return node.Scalar();
  Internals::refuse_value(*this, node, mapping_->path_of(key), join(words));
  return otherwise;
}

YamlReader YamlReader::mapping(const std::string& key) const {
  const auto* entry = Internals::find(*this, key, true, "a mapping");
  if (!entry) return Internals::missing(*this);
  if (entry->value.IsMap()) return Internals::open(document_, entry->value, mapping_->path_of(key));
  Internals::refuse_value(*this, entry->value, mapping_->path_of(key), "a mapping");
  return Internals::missing(*this);
}

std::optional<YamlReader> YamlReader::optional_mapping(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  return mapping(key);
}

std::vector<YamlReader> YamlReader::mappings(const std::string& key, const Count& count) const {
  if (!has(key)) return {};
  const auto* entry = Internals::find(*this, key, false, "");
  return Internals::list<YamlReader>(
      *this, mapping_->path_of(key), entry->value, count, "mappings",
      [&](const YAML::Node& node, const std::string& path) -> std::optional<YamlReader> {
        if (node.IsMap()) return Internals::open(document_, node, path);
        Internals::refuse_value(*this, node, path, "a mapping");
        return std::nullopt;
      });
}

std::vector<std::string> YamlReader::keys() const {
  std::vector<std::string> keys;
  if (!mapping_) return keys;
  for (const Mapping::Entry& entry : mapping_->entries) {
    mapping_->known.insert(entry.key);
    keys.push_back(entry.key);
  }
  return keys;
}

// ---- words ----

bool Range::contains(double value) const {
  const bool above = lower_open ? value > lower : value >= lower;
  const bool below = upper_open ? value < upper : value <= upper;
  return std::isfinite(value) && above && below;
}

std::string Range::text(Dimension dimension) const {
  const std::string_view unit = native_unit(dimension);
  std::string text;
  if (!std::isfinite(lower) && !std::isfinite(upper)) {
    text = "a finite number";
  } else if (!std::isfinite(upper)) {
    text = fmt::format("{} {}", lower_open ? "more than" : "at least", lower);
  } else {
    text = fmt::format("{}{}, {}{}", lower_open ? '(' : '[', lower, upper, upper_open ? ')' : ']');
  }
  return unit.empty() ? text : fmt::format("{} {}", text, unit);
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates) {
  std::string nearest;
  std::size_t fewest = std::max<std::size_t>(word.size() / 3, 1) + 1;
  for (const std::string& candidate : candidates) {
    // Levenshtein's distance, row by row.
    std::vector<std::size_t> row(candidate.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 0; i < word.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i + 1;
      for (std::size_t j = 0; j < candidate.size(); ++j) {
        const std::size_t changed = diagonal + (word[i] != candidate[j]);
        diagonal = row[j + 1];
        row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, changed});
      }
    }
    if (row.back() < fewest) {
      fewest = row.back();
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace dmf
