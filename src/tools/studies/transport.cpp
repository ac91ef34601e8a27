#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tools/cases.h"
#include "tools/studies/transport_table.h"

namespace dmf::tools {
namespace {

std::string label_of(const TransportStudy& study, const VariedValue& value) {
  return value.label.empty() ? "" : fmt::format("{}={}", study.varied, value.label);
}

/// Of ours, or of Lan's.
double largest_over_smallest(const std::vector<std::pair<double, double>>& pairs,
                             double std::pair<double, double>::*whose) {
  const auto [smallest, largest] = std::minmax_element(
      pairs.begin(), pairs.end(), [whose](const auto& a, const auto& b) { return a.*whose < b.*whose; });
  return (*largest).*whose / (*smallest).*whose;
}

std::vector<Case> cases_of(const TransportStudy& study, const StudyOptions& options) {
  std::vector<Case> cases;
  for (const VariedValue& value : study.values) {
    chip::Scene scene = scene_for(options, study.name);
    value.apply(scene);
    TransportRun run;
    run.limit = study.limit;
    run.goal = study.goal;
    run.after_drop_off = study.after_drop_off;
    run.folder = options.output + "/runs";
    const std::string label = label_of(study, value);
    run.key = fmt::format("{} {}{}", study.name, label.empty() ? "scene" : label, options_key(options));
    if (options.quick) {
      shorten_the_approach(scene);
      run.limit = 60;
      run.record_every = 1;
    }
    cases.push_back({label, [&study, scene, run](std::uint64_t seed) {
                       TransportRun seeded = run;
                       seeded.key += fmt::format(" seed={}", seed);
                       const Transport transport = run_transport(scene, seed, seeded);
                       ResultRow row;
                       for (const Quantity& quantity : study.quantities)
                         row.values.push_back(quantity.measure(transport.records));
                       row.computing = transport.earlier_computing;
                       return row;
                     }});
  }
  return cases;
}

/// Lan's runs are single ones: that the values stand in his order, or are as alike as his, says more than
/// each of them.
void compare_values(const TransportStudy& study, const Results& results, Findings& findings) {
  using Pair = std::pair<double, double>;  // ours, Lan's
  for (const Quantity& quantity : study.quantities) {
    std::vector<Pair> pairs;
    for (std::size_t k = 0; k < std::min(study.values.size(), quantity.lan.size()); ++k) {
      const std::string label = label_of(study, study.values[k]);
      char* end = nullptr;
      const double lan = std::strtod(quantity.lan[k], &end);
      const bool known = end != quantity.lan[k] && *end == '\0';
      if (known && !results.of(label, quantity.name).empty())
        pairs.emplace_back(results.mean(label, quantity.name).mean, lan);
    }
    if (pairs.size() < 3) continue;
    const std::string name = quantity.name, title = quantity.title;
    const auto range = [&pairs](double Pair::*whose) { return largest_over_smallest(pairs, whose); };
    if (quantity.alike)
      findings.push_back(
          results.derived("", "range_of_" + name, title + ": largest over smallest", 2, {range(&Pair::first)})
              .against_paper(reference(range(&Pair::second), 2, "Lan"))
              .within(0.1));
    else
      findings.push_back(results
                             .derived("", "order_of_" + name, title + ": order, rank correlation", 2,
                                      {rank_correlation(pairs)})
                             .against_paper({"1", "Lan's order"}));
  }
}

Findings run_study(const TransportStudy& study, const StudyOptions& options) {
  std::vector<std::string> columns;
  for (const Quantity& quantity : study.quantities) columns.push_back(quantity.name);
  const Results results = run_cases(study.name, columns, cases_of(study, options), options);
  Findings findings;
  for (std::size_t k = 0; k < study.values.size(); ++k)
    for (const Quantity& quantity : study.quantities) {
      Finding finding =
          results.finding(label_of(study, study.values[k]), quantity.name, quantity.title, quantity.decimals);
      if (k < quantity.lan.size() && *quantity.lan[k]) finding.against_paper({quantity.lan[k], "Lan"});
      quantity.margin > 0 ? finding.within_margin(quantity.margin) : finding.within(0.1);
      if (!finding.values.empty()) findings.push_back(std::move(finding));
    }
  if (study.name == std::string("pickup"))
    if (const std::vector<double> alone = recorded_crossings(options); !alone.empty()) {
      std::vector<double> longer = results.of("", "droplet_passes_40");
      for (double& time : longer) time /= mean_and_spread(alone).mean;
      findings.push_back(
          results.derived("", "times_alone", "the droplet to x = 40, of its time alone", 2, longer)
              .against_paper({"1.61", "Lan"})
              .within(0.1));
    }
  compare_values(study, results, findings);
  return findings;
}

}  // namespace

std::vector<Study> transport_studies() {
  std::vector<Study> studies;
  for (const TransportStudy& study : transport_table())
    studies.push_back({study.name, study.about,
                       [&study](const StudyOptions& options) { return run_study(study, options); }});
  return studies;
}

}  // namespace dmf::tools
