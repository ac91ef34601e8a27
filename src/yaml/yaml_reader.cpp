#include "yaml/yaml_reader.h"

#include <filesystem>
#include <fstream>

#include "yaml/yaml_reader_internals.h"

namespace dmf {
namespace {

constexpr std::uintmax_t kMaxBytes = 1 << 20;
constexpr std::size_t kMaxPath = 4000;  // characters; file systems allow no more

}  // namespace

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
      document_->note(
          entry.line, mapping->path_of(entry.key),
          fmt::format("unknown key{} allowed: {}", hint.empty() ? "," : hint, yaml_detail::join(known)));
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

}  // namespace dmf
