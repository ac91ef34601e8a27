#include "yaml/yaml_reader_internals.h"

// The getters of YamlReader that give values.

namespace dmf {

using namespace yaml_detail;

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

std::vector<std::string> YamlReader::text_or_texts(const std::string& key, const Count& count) const {
  const auto* entry = Internals::find(*this, key, false, "text");
  if (!entry) return {};
  if (entry->value.IsScalar()) return {entry->value.Scalar()};
  return texts(key, count);
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

}  // namespace dmf
