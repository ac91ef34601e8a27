#include "engine/spline.h"

#include <fmt/format.h>

#include "engine/parameters.h"

namespace dmf::engine {

std::vector<std::string> spline_violations(const Parameters& parameters) {
  const SplineParameters& spline = parameters.spline;
  if (!spline.used) return {};
  std::vector<std::string> found;
  const auto check = [&](const char* key, double value, bool allowed, const char* range) {
    if (!allowed) found.push_back(fmt::format("spline.{}: {}, allowed: {}", key, value, range));
  };
  const auto within = [](double value, double lower, double upper) {
    return value >= lower && value <= upper;
  };
  check("repulsion", spline.repulsion, within(spline.repulsion, 1e-9, 100), "above 0 up to 100");
  check("attraction", spline.attraction, spline.attraction >= 0 && spline.attraction < spline.repulsion,
        "0 up to below repulsion, so that two beads in one place repel each other");
  check("repulsion_radius", spline.repulsion_radius, within(spline.repulsion_radius, 0.1, 1),
        "0.1 to 1 (r_c, the cutoff of all pairs)");
  check("attraction_radius", spline.attraction_radius, within(spline.attraction_radius, 0.1, 1),
        "0.1 to 1 (r_c, the cutoff of all pairs)");
  bool many_body = parameters.liquid.repulsion != 0;
  for (const FurtherLiquid& liquid : parameters.mixture.liquids) many_body |= liquid.own.repulsion != 0;
  for (const PairOfSpecies& pair : parameters.mixture.pairs) many_body |= pair.coefficients.repulsion != 0;
  if (many_body)
    found.push_back(
        "spline: together with a many-body repulsion, allowed: with repulsion 0 for liquid and every pair, "
        "whose attraction is then the strength a_ij");
  return found;
}

}  // namespace dmf::engine
