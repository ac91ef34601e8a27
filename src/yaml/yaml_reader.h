#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "yaml/quantity.h"
#include "yaml/units.h"

namespace dmf {

/// Allowed values, in the native unit of what is read. Ends belong to the range unless they are said to be
/// open.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = false;
  bool upper_open = false;

  static Range above(double lower) { return {lower, std::numeric_limits<double>::infinity(), true, false}; }
  static Range at_least(double lower) { return {lower}; }

  bool contains(double value) const;
  /// "[0, 80] V", "(0, inf) tau", "any finite number".
  std::string text(Dimension dimension = Dimension::number) const;
};

/// How many entries a list may have.
struct Count {
  std::size_t least = 0;
  std::size_t most = std::numeric_limits<std::size_t>::max();
};

/// A mapping of a YAML file, read strictly. A getter never throws: what is wrong is noted with file and line,
/// the getter returns the default (or zero), and reading goes on, so that `finish()` can tell *everything*
/// that is wrong:
///
///     YamlReader root = YamlReader::load(file);
///     const double step = root.number("time_step", {0, 0.1, true}, 0.01);         // has a default
///     const auto points = root.rows("points", Dimension::number, {}, {2}, {3, 3});  // no default: required
///     root.finish();  // throws for missing, unknown, duplicate keys, wrong types, units and values
///
/// A key is known once a getter asked for it; every other key of the file is an error. Copies are handles on
/// the same file. Lines read "file:line: key.path: value, allowed: ...".
class YamlReader {
 public:
  /// @throws InvalidInput when the file can't be read, is not YAML, or is not one mapping.
  static YamlReader load(const std::string& file);
  /// The text that load() reads. @throws InvalidInput when the file can't be read.
  static std::string text_of(const std::string& file);
  /// Same from text; `name` stands for the file in messages.
  static YamlReader parse(const std::string& text, const std::string& name);

  /// What a reduced unit is from here on, for quantities that are written with a unit. Until then what has a
  /// reduced native unit (a length, a time, a mass) must have a unit, and is returned in SI.
  void set_units(const Units& units);

  bool has(const std::string& key) const;
  /// A plain number. Without a default the key is required, here and below. NaN and infinity are refused.
  double number(const std::string& key, const Range& range, std::optional<double> fallback = {}) const;
  /// A number in the native unit, or text with a unit. Returned, and compared with the range, in the native
  /// unit.
  double quantity(const std::string& key, Dimension dimension, const Range& range,
                  std::optional<double> fallback = {}) const;
  /// A list of quantities; empty when it is absent and `count` allows that.
  std::vector<double> quantities(const std::string& key, Dimension dimension, const Range& range,
                                 const Count& count) const;
  /// A list of lists of quantities, [[x, y], ...]; a row that is wrong is left out.
  std::vector<std::vector<double>> rows(const std::string& key, Dimension dimension, const Range& range,
                                        const Count& row_count, const Count& column_count) const;
  std::uint64_t integer(const std::string& key, std::uint64_t least, std::uint64_t most,
                        std::optional<std::uint64_t> fallback = {}) const;
  /// A list that has to be there, if only as [].
  std::vector<std::uint64_t> integers(const std::string& key, std::uint64_t least, std::uint64_t most,
                                      const Count& count) const;
  /// A list of lists of integers as rows() reads it.
  std::vector<std::vector<std::uint64_t>> integer_rows(const std::string& key, std::uint64_t least,
                                                       std::uint64_t most, const Count& row_count,
                                                       const Count& column_count) const;
  bool boolean(const std::string& key, std::optional<bool> fallback = {}) const;
  std::string text(const std::string& key, std::optional<std::string> fallback = {}) const;
  /// A list of texts, which has to be there.
  std::vector<std::string> texts(const std::string& key, const Count& count) const;
  /// A text by itself or a list of texts; empty when it is absent.
  std::vector<std::string> text_or_texts(const std::string& key, const Count& count) const;
  /// One of the given words. On a violation the default, or else the first word.
  std::string choice(const std::string& key, const std::vector<std::string>& words,
                     std::optional<std::string> fallback = {}) const;

  /// A mapping under a key. When it is required but missing, the reader that comes back gives defaults and
  /// notes nothing more.
  YamlReader mapping(const std::string& key) const;
  std::optional<YamlReader> optional_mapping(const std::string& key) const;
  /// A list of mappings; empty when absent.
  std::vector<YamlReader> mappings(const std::string& key, const Count& count = {}) const;
  /// The keys of a mapping whose keys are free, such as names. All count as known.
  std::vector<std::string> keys() const;

  /// Notes a violation that the caller found: "value, allowed: ...". An empty key means this mapping itself.
  void report(const std::string& key, const std::string& violation) const;
  /// Notes "key.path: value, allowed: ..." at the line of that path, or of the deepest part of it that is
  /// written.
  void report_path(const std::string& violation) const;
  /// So far something is wrong.
  bool failed() const;

  /// @throws InvalidInput with everything that is wrong, one line each, by rising line.
  void finish() const;

 private:
  struct Document;
  struct Mapping;
  class Internals;
  YamlReader(std::shared_ptr<Document> document, std::shared_ptr<Mapping> mapping);

  std::shared_ptr<Document> document_;
  std::shared_ptr<Mapping> mapping_;  ///< null: the mapping is missing, which has been noted
};

/// The candidate that `word` was probably meant to be: at most a third of its letters differ. Empty when none
/// is near.
std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace dmf
