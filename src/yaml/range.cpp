#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "yaml/yaml_reader.h"

// Ranges and words, as messages tell them.

namespace dmf {

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
