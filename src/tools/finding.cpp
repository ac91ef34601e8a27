#include "tools/finding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

namespace dmf::tools {
namespace {

/// A reference as a stretch of numbers: a single one has no length.
std::optional<std::pair<double, double>> numbers_of(std::string text) {
  if (text.rfind("about ", 0) == 0) text.erase(0, 6);
  const char* begin = text.c_str();
  char* end = nullptr;
  const double low = std::strtod(begin, &end);
  if (end == begin) return std::nullopt;
  if (*end == '\0') return std::pair{low, low};
  if (std::string(end, 4) != " to ") return std::nullopt;
  begin = end + 4;
  const double high = std::strtod(begin, &end);
  if (end == begin || *end != '\0') return std::nullopt;
  return std::pair{low, high};
}

const Reference& compared_with(const Finding& finding) {
  return finding.paper.value.empty() ? finding.theory : finding.paper;
}

std::string quoted(const Reference& reference) {
  return reference.value.empty() ? "" : fmt::format("{} ({})", reference.value, reference.source);
}

/// A cell of a Markdown table.
std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find("+-", at)) != std::string::npos;) text.replace(at, 2, "±");
  return text;
}

/// A field of a CSV file: no commas.
std::string field(std::string text) {
  std::replace(text.begin(), text.end(), ',', ';');
  return text;
}

}  // namespace

MeanAndSpread mean_and_spread(const std::vector<double>& values) {
  MeanAndSpread result;
  const double count = static_cast<double>(values.size());
  for (const double value : values) result.mean += value / count;
  if (values.size() < 2) return result;
  double squares = 0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  result.deviation = std::sqrt(squares / (count - 1));
  result.standard_error = result.deviation / std::sqrt(count);
  return result;
}

Reference reference(double value, int decimals, const std::string& source) {
  return {fmt::format("{:.{}f}", value, decimals), source};
}

Finding& Finding::against_paper(Reference reference) {
  paper = std::move(reference);
  return *this;
}

Finding& Finding::against_theory(Reference reference) {
  theory = std::move(reference);
  return *this;
}

Finding& Finding::within(double share_of_reference) {
  tolerance = share_of_reference;
  return *this;
}

Finding& Finding::within_margin(double of_either_side) {
  tolerance = 0;
  margin = of_either_side;
  return *this;
}

MeanAndSpread Finding::mean() const {
  std::vector<double> found;
  std::copy_if(values.begin(), values.end(), std::back_inserter(found),
               [](double value) { return std::isfinite(value); });
  return mean_and_spread(found);
}

int Finding::happened() const {
  return static_cast<int>(
      std::count_if(values.begin(), values.end(), [](double value) { return std::isfinite(value); }));
}

std::string Finding::ours() const {
  const int found = happened();
  if (found == 0) return "never";
  const MeanAndSpread result = mean();
  std::string text = fmt::format("{:.{}f}", result.mean, decimals);
  if (found > 1) text += fmt::format(" +- {:.{}f}", result.deviation, decimals);
  if (found < static_cast<int>(values.size())) text += fmt::format(" in {} of {}", found, values.size());
  return text;
}

std::string Finding::verdict() const {
  const Reference& other = compared_with(*this);
  if (values.empty() || other.value.empty()) return "";
  const int found = happened();
  if (other.value == "never")
    return found == 0 ? "as there" : fmt::format("happened in {} of {}", found, values.size());
  const auto numbers = numbers_of(other.value);
  if (!numbers) return "";
  if (found == 0) return "did not happen";
  const auto [low, high] = *numbers;
  const double value = mean().mean;
  if (low < high && value >= low && value <= high) return "agrees";
  const double nearest = std::clamp(value, low, high), off = value - nearest;
  const bool agrees = std::abs(off) <= std::max(margin, tolerance * std::abs(nearest));
  const std::string by = margin > 0 || nearest == 0
                             ? fmt::format("{:+.{}f}", off, decimals)
                             : fmt::format("{:+.1f} %", 100 * off / std::abs(nearest) + 0.0);
  return fmt::format("{}, {}", agrees ? "agrees" : "off", by);
}

double rank_correlation(const std::vector<std::pair<double, double>>& pairs) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double product = (pairs[i].first - pairs[j].first) * (pairs[i].second - pairs[j].second);
      if (!std::isfinite(product) || pairs[i].second == pairs[j].second) continue;
      sum += product > 0 ? 1 : product < 0 ? -1 : 0;
      count += 1;
    }
  return count > 0 ? sum / count : NAN;
}

std::string as_text(const Findings& findings) {
  std::size_t of = 0, title = 0, ours = 0;
  for (const Finding& finding : findings) {
    of = std::max(of, finding.of.size());
    title = std::max(title, finding.title.size());
    ours = std::max(ours, finding.ours().size());
  }
  std::string text;
  for (const Finding& finding : findings) {
    std::string line =
        fmt::format("{:<{}}  {:<{}}  {:>{}}", finding.of, of, finding.title, title, finding.ours(), ours);
    for (const Reference& other : {finding.paper, finding.theory})
      if (!other.value.empty()) line += fmt::format("  {}: {}", other.source, other.value);
    if (const std::string verdict = finding.verdict(); !verdict.empty()) line += "  " + verdict;
    text += line + "\n";
  }
  return text;
}

std::string as_csv(const Findings& findings) {
  std::string text =
      "case,quantity,mean,standard_deviation,happened,runs,paper,paper_source,theory,theory_source,verdict,"
      "computing_s,engine,title\n";
  for (const Finding& one : findings) {
    const MeanAndSpread result = one.mean();
    text += fmt::format("{},{},{:.6g},{:.3g},{},{},{},{},{},{},{},{:.0f},{},{}\n", field(one.of),
                        one.quantity, one.happened() > 0 ? result.mean : NAN, result.deviation,
                        one.happened(), one.values.size(), field(one.paper.value), field(one.paper.source),
                        field(one.theory.value), field(one.theory.source), field(one.verdict()),
                        one.computing, fmt::join(one.engine, " "), field(one.title));
  }
  return text;
}

std::string as_markdown(const Findings& findings) {
  std::string text;
  for (const Finding& one : findings) {
    if (compared_with(one).value.empty() || one.values.empty()) continue;
    const std::string computing = std::isfinite(one.computing) ? fmt::format("{:.0f}", one.computing) : "";
    text += fmt::format("| `{}`{} | {} | {} | {} | {} | {} | {} | {} |\n", one.study,
                        one.of.empty() ? "" : " " + cell(one.of), cell(one.title), quoted(one.paper),
                        quoted(one.theory), cell(one.ours()), one.values.size(), one.verdict(), computing);
  }
  return text;
}

}  // namespace dmf::tools
