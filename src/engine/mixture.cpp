#include "engine/mixture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "engine/parameters.h"

namespace dmf::engine {

namespace {

std::vector<std::string> names_of_liquids(const Parameters& parameters) {
  std::vector<std::string> names{first_liquid_name};
  for (const FurtherLiquid& liquid : parameters.mixture.liquids) names.push_back(liquid.name);
  return names;
}

bool within(double value, double lower, double upper) { return value >= lower && value <= upper; }

/// Unordered.
using NamePair = std::pair<std::string, std::string>;
NamePair name_pair(const std::string& one, const std::string& other) { return std::minmax(one, other); }
NamePair name_pair(const PairOfSpecies& pair) { return name_pair(pair.first, pair.second); }

bool same(const PairCoefficients& a, const PairCoefficients& b) {
  return a.attraction == b.attraction && a.repulsion == b.repulsion &&
         a.random_amplitude == b.random_amplitude;
}

/// Coefficients of one pair, at `key` of the scene.
void check_coefficients(const std::string& key, const PairCoefficients& pair,
                        std::vector<std::string>& found) {
  const auto check = [&](const char* name, double value, double lower, double upper, const char* allowed) {
    if (!within(value, lower, upper))
      found.push_back(fmt::format("{}.{}: {}, allowed: {}", key, name, value, allowed));
  };
  check("repulsion", pair.repulsion, 0, 500, "0 to 500");
  if (pair.repulsion == 0)
    check("attraction", pair.attraction, 0, 200, "0 to 200 with repulsion 0 (plain DPD)");
  else
    check("attraction", pair.attraction, -200, 200, "-200 to 200 (attraction is negative)");
  check("random_amplitude", pair.random_amplitude, 0, 50, "0 to 50");
}

void check_liquids(const Parameters& parameters, std::vector<std::string>& found) {
  const auto& liquids = parameters.mixture.liquids;
  if (liquids.size() + 1 > most_liquids)
    found.push_back(
        fmt::format("species: {} beside liquid, allowed: up to {}", liquids.size(), most_liquids - 1));
  std::set<std::string> known{first_liquid_name, wall_name, microparticle_name};
  for (const FurtherLiquid& liquid : liquids) {
    const std::string key = "species." + liquid.name;
    if (liquid.name.empty() || !known.insert(liquid.name).second)
      found.push_back(
          fmt::format("{}: name, allowed: one that no other species has, and none of liquid, "
                      "wall, microparticle",
                      key));
    check_coefficients(key, liquid.own, found);
    // A liquid of its own that only repels many-body-wise would fill any box, and one that only attracts
    // collapse; the first one is held to the same.
    if (liquid.own.repulsion > 0 && !(liquid.own.attraction < 0))
      found.push_back(
          fmt::format("{}.attraction: {}, allowed: -200 up to below 0 (attraction is negative), "
                      "or with repulsion 0 0 to 200 (plain DPD)",
                      key, liquid.own.attraction));
    if (!within(liquid.initial_density, 1, 12))
      found.push_back(fmt::format("{}.initial_density: {}, allowed: 1 to 12 (beads per r_c^3)", key,
                                  liquid.initial_density));
    if (!within(liquid.bulk_density, 1, 20))
      found.push_back(
          fmt::format("{}.bulk_density: {}, allowed: 1 to 20 (beads per r_c^3)", key, liquid.bulk_density));
  }
}

bool is_with_microparticles(const PairOfSpecies& pair) {
  return pair.first == microparticle_name || pair.second == microparticle_name;
}

bool is_of_further_liquid(const Parameters& parameters, const PairOfSpecies& pair) {
  const auto& liquids = parameters.mixture.liquids;
  return std::any_of(liquids.begin(), liquids.end(), [&](const FurtherLiquid& liquid) {
    return liquid.name == pair.first || liquid.name == pair.second;
  });
}

/// Says which pairs are unknown, given twice, asymmetric or missing.
void check_pairs(const Parameters& parameters, std::vector<std::string>& found) {
  std::vector<std::string> names = names_of_liquids(parameters);
  names.push_back(wall_name);
  const auto known = [&](const std::string& name) {
    return name == microparticle_name || std::find(names.begin(), names.end(), name) != names.end();
  };
  std::map<NamePair, const PairOfSpecies*> given;
  for (const PairOfSpecies& pair : parameters.mixture.pairs) {
    const std::string key = fmt::format("pairs.{}.{}", pair.first, pair.second);
    for (const std::string& name : {pair.first, pair.second})
      if (!known(name))
        found.push_back(fmt::format("{}: unknown species {}, allowed: {}, {}", key, name,
                                    fmt::join(names, ", "), microparticle_name));
    if (pair.first == pair.second && known(pair.first))
      found.push_back(
          fmt::format("{}: a species with itself, allowed: two different ones (its own law stands "
                      "under species.{})",
                      key, pair.first));
    else if (is_with_microparticles(pair) && !is_of_further_liquid(parameters, pair))
      found.push_back(fmt::format(
          "{}: allowed: a species that is listed (what liquid has with a microparticle is the attraction of "
          "each, what walls have is microparticle_model.wall_attraction)",
          key));
    check_coefficients(key, pair.coefficients, found);
    const auto [before, is_new] = given.emplace(name_pair(pair), &pair);
    if (is_new) continue;
    found.push_back(fmt::format("{}: given twice{}, allowed: one law for a pair", key,
                                same(before->second->coefficients, pair.coefficients)
                                    ? ""
                                    : ", and an asymmetric table: forces would not be equal and opposite"));
  }
  const bool has_wall = parameters.domain.has_wall() || parameters.label_grid.grid;
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = i + 1; j < names.size(); ++j) {
      const bool with_wall = names[j] == wall_name;
      // The wall's wettability is the law of the first liquid with it.
      if (with_wall && (i == 0 || !has_wall)) continue;
      if (given.count(std::minmax(names[i], names[j])) == 0)
        found.push_back(fmt::format("pairs: no law for {} and {}, allowed: one for every pair of species",
                                    names[i], names[j]));
    }
}

}  // namespace

std::vector<std::string> mixture_violations(const Parameters& parameters) {
  std::vector<std::string> found;
  check_liquids(parameters, found);
  check_pairs(parameters, found);
  if (wall_coefficients(parameters) && parameters.wall.attraction)
    found.push_back(fmt::format("wall.attraction: {} beside pairs.liquid.wall, allowed: one of both",
                                *parameters.wall.attraction));
  return found;
}

std::vector<std::string> notices(const Parameters& parameters) {
  std::set<double> repulsions{parameters.liquid.repulsion};
  for (const FurtherLiquid& liquid : parameters.mixture.liquids) repulsions.insert(liquid.own.repulsion);
  for (const PairOfSpecies& pair : parameters.mixture.pairs)
    if (pair.first != wall_name && pair.second != wall_name && !is_with_microparticles(pair))
      repulsions.insert(pair.coefficients.repulsion);
  if (repulsions.size() < 2) return {};
  return {
      fmt::format("the many-body repulsion differs among pairs of liquids that share a density (B {}): their "
                  "force has no potential (Warren 2013), so that pressures and energies are not those of an "
                  "equilibrium",
                  fmt::join(repulsions, ", "))};
}

std::string liquid_name(const Parameters& parameters, std::uint32_t liquid) {
  return liquid == 0 ? first_liquid_name : parameters.mixture.liquids.at(liquid - 1).name;
}

double initial_density(const Parameters& parameters, std::uint32_t liquid) {
  return liquid == 0 ? parameters.liquid.initial_density
                     : parameters.mixture.liquids.at(liquid - 1).initial_density;
}

double bulk_density(const Parameters& parameters, std::uint32_t liquid) {
  return liquid == 0 ? parameters.liquid.bulk_density
                     : parameters.mixture.liquids.at(liquid - 1).bulk_density;
}

const PairCoefficients* coefficients_of(const Parameters& parameters, const std::string& one,
                                        const std::string& other) {
  for (const PairOfSpecies& pair : parameters.mixture.pairs)
    if (name_pair(pair) == name_pair(one, other)) return &pair.coefficients;
  return nullptr;
}

const PairCoefficients* wall_coefficients(const Parameters& parameters) {
  return coefficients_of(parameters, first_liquid_name, wall_name);
}

std::optional<double> fixed_wall_attraction(const Parameters& parameters) {
  if (const PairCoefficients* pair = wall_coefficients(parameters)) return pair->attraction;
  return parameters.wall.attraction;
}

std::uint32_t liquid_named(const Parameters& parameters, const std::string& name) {
  const std::vector<std::string> names = names_of_liquids(parameters);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InvalidInput(fmt::format("species {}, allowed: {}", name, fmt::join(names, ", ")));
  return static_cast<std::uint32_t>(found - names.begin());
}

}  // namespace dmf::engine
