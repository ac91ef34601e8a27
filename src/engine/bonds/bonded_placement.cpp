#include "engine/bonds/bonded_placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/cell_grid.h"
#include "engine/noise.h"
#include "engine/placement.h"
#include "engine/walls/solid.h"

namespace dmf::engine {
namespace {

constexpr int most_tries = 200;    ///< for the next bead of a walk, and for a whole chain
constexpr double rounding = 1e-9;  ///< of a number that was told and is given back
constexpr const char* in_solid = "in the solid of the label grid, allowed: outside of it (r_c)";

/// Uniform numbers of one chain.
class Draws {
 public:
  Draws(std::uint64_t seed, std::uint64_t step, std::uint32_t chain)
      : key_(step_key(seed, step, Stream::chain)) {
    key_.first ^= mix32(chain);
  }
  double uniform(double lower, double upper) {
    return lower + (upper - lower) * ((bead_key(key_, count_++) + 0.5) / 4294967296.0);
  }
  /// Evenly over the sphere, or the circle in a plane, without a sine or cosine.
  Vector3d direction(bool flat) {
    for (;;) {
      const Vector3d d(uniform(-1, 1), flat ? 0 : uniform(-1, 1), uniform(-1, 1));
      const double square = d.squaredNorm();
      if (square < 1 && square > 0.01) return d / std::sqrt(square);
    }
  }

 private:
  StepKey key_;
  std::uint32_t count_ = 0;
};

/// The box that beads must lie in, outside of the solid; without sides where it is a whole period.
bool inside(const Vector3d& p, const ChainPlacement& placement, const Domain& domain, const Solid& solid) {
  for (int axis = 0; axis < 3; ++axis) {
    const bool endless = domain.periodic(axis) && placement.lower[axis] <= domain.lower[axis] &&
                         placement.upper[axis] >= domain.upper[axis];
    if (!endless && (p[axis] < placement.lower[axis] || p[axis] > placement.upper[axis])) return false;
  }
  return !solid.contains(p.cast<float>());
}

Vector3d somewhere(Draws& draws, const ChainPlacement& placement, const Parameters& parameters) {
  Vector3d p;
  for (int axis = 0; axis < 3; ++axis)
    p[axis] = parameters.flat(axis) ? parameters.plane()
                                    : draws.uniform(placement.lower[axis], placement.upper[axis]);
  return p;
}

std::optional<std::vector<Vector3d>> walk(Draws& draws, const ChainPlacement& placement,
                                          const Parameters& parameters, const Solid& solid) {
  const Domain& domain = parameters.domain;
  std::vector<Vector3d> sites{somewhere(draws, placement, parameters)};
  if (!inside(sites.front(), placement, domain, solid)) return std::nullopt;
  while (sites.size() < placement.beads) {
    int tries = 0;
    Vector3d next;
    do {
      if (++tries > most_tries) return std::nullopt;
      next = sites.back() + placement.bond_length * draws.direction(parameters.dimensions == 2);
    } while (!inside(next, placement, domain, solid));
    sites.push_back(next);
  }
  return sites;
}

std::optional<std::vector<Vector3d>> line(Draws& draws, const ChainPlacement& placement,
                                          const Parameters& parameters, const Solid& solid) {
  const Vector3d bond = placement.bond_length * placement.direction.normalized();
  const Vector3d first = somewhere(draws, placement, parameters);
  std::vector<Vector3d> sites;
  for (std::uint32_t k = 0; k < placement.beads; ++k) {
    sites.push_back(first + static_cast<double>(k) * bond);
    if (!inside(sites.back(), placement, parameters.domain, solid)) return std::nullopt;
  }
  return sites;
}

/// The time step that is fine enough for an oscillation, rounded down.
double fine_enough(double highest_frequency) {
  const double most = largest_phase_step / highest_frequency;
  const double digit = std::pow(10.0, std::floor(std::log10(most)) - 2);
  return digit * std::floor(most / digit * (1 + rounding));
}

std::string too_coarse(const char* what, double highest_frequency, const Parameters& parameters) {
  if (!(parameters.time_step * highest_frequency > largest_phase_step * (1 + rounding))) return "";
  return fmt::format(
      "{} oscillates with {:.4g} / tau, too fast for time_step {}, allowed: a time_step of up to "
      "{:.4g}, or less stiffness",
      what, highest_frequency, parameters.time_step, fine_enough(highest_frequency));
}

std::string text_of(const Vector3d& p) { return fmt::format("({:g}, {:g}, {:g})", p.x(), p.y(), p.z()); }

/// Along periodic axes any place will do.
bool in_domain(const Vector3d& p, const Domain& domain) {
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(p[axis]) ||
        (!domain.periodic(axis) && (p[axis] < domain.lower[axis] || p[axis] > domain.upper[axis])))
      return false;
  return true;
}

/// @param ids  of beads that are there. @param species  of each of them.
void give_species(Beads& beads, const std::vector<std::uint32_t>& ids,
                  const std::vector<std::uint8_t>& species) {
  const bool all_first = std::all_of(species.begin(), species.end(), [](std::uint8_t k) { return k == 0; });
  if (beads.species.empty() && all_first) return;
  if (beads.species.empty()) beads.species.assign(beads.size(), 0);
  std::vector<std::size_t> index_of_id(*std::max_element(beads.id.begin(), beads.id.end()) + 1);
  for (std::size_t i = 0; i < beads.size(); ++i) index_of_id[beads.id[i]] = i;
  for (std::size_t k = 0; k < ids.size(); ++k) beads.species[index_of_id[ids[k]]] = species[k];
}

/// Empty when there is a liquid of that number.
std::string unknown_species(std::uint32_t species, const Parameters& parameters) {
  const std::size_t last = parameters.mixture.liquids.size();
  return species <= last ? "" : fmt::format("species: {}, allowed: 0 to {}", species, last);
}

std::string outside_of(const Domain& domain) {
  return fmt::format("allowed: within {} to {} where sides are not periodic (r_c)", text_of(domain.lower),
                     text_of(domain.upper));
}

}  // namespace

double usual_bond_length(const Spring& spring) {
  return spring.kind == SpringKind::harmonic ? spring.length : 0.5 * spring.max_length;
}

std::vector<std::string> violations(const ChainPlacement& placement, const Parameters& parameters) {
  std::vector<std::string> found = violations(placement.spring);
  if (!found.empty()) return found;
  const Domain& domain = parameters.domain;
  const Solid solid(parameters);
  const SpringLaw law = SpringLaw::of(placement.spring, parameters.liquid.temperature);
  const double longest = std::min(law.max_length(), longest_bond(domain));
  const auto of_longest = [&] {
    return fmt::format("allowed: less than {:.4g}, {}", longest,
                       law.max_length() <= longest ? "the spring's maximum" : "a third of a periodic side");
  };
  const std::size_t beads = placement.points.empty() ? placement.beads : placement.points.size();
  const std::size_t of_species = placement.species.size();
  if (of_species > 1 && of_species != beads)
    found.push_back(fmt::format("species: {} of them, allowed: 1, or {}, one a bead", of_species, beads));
  for (const std::uint32_t species : placement.species)
    if (const std::string unknown = unknown_species(species, parameters); !unknown.empty()) {
      found.push_back(unknown);
      break;
    }
  if (!placement.stretching_force.allFinite())
    found.push_back(
        fmt::format("stretching_force: {}, allowed: finite", text_of(placement.stretching_force)));
  const double plane = parameters.plane();
  const bool flat = parameters.dimensions == 2;
  if (flat && placement.stretching_force.y() != 0)
    found.push_back(fmt::format("stretching_force: {} along y, allowed: 0 with dimensions: 2",
                                placement.stretching_force.y()));
  if (placement.points.empty()) {
    if (flat && placement.shape == ChainShape::straight && placement.direction.y() != 0)
      found.push_back(
          fmt::format("direction: {} along y, allowed: 0 with dimensions: 2", placement.direction.y()));
    if (placement.beads < 2 || placement.beads > 100'000)
      found.push_back(fmt::format("beads: {}, allowed: 2 to 100000", placement.beads));
    if (placement.count < 1 || placement.count > 1'000'000)
      found.push_back(fmt::format("count: {}, allowed: 1 to 1000000", placement.count));
    if (!(placement.bond_length > 0))
      found.push_back(fmt::format("bond_length: {}, allowed: above 0 (r_c)", placement.bond_length));
    else if (!(placement.bond_length < longest))
      found.push_back(fmt::format("bond_length: {}, chain beads farther apart than the spring's maximum, {}",
                                  placement.bond_length, of_longest()));
    if (!domain.contains(placement.lower) || !domain.contains(placement.upper) ||
        !(placement.lower.array() <= placement.upper.array()).all())
      found.push_back(fmt::format("box: {} to {}, allowed: lower up to upper, both within {} to {} (r_c)",
                                  text_of(placement.lower), text_of(placement.upper), text_of(domain.lower),
                                  text_of(domain.upper)));
    if (placement.shape == ChainShape::straight &&
        !(placement.direction.allFinite() && placement.direction.norm() > 0))
      found.push_back(fmt::format("direction: {}, allowed: finite, not zero", text_of(placement.direction)));
  } else {
    if (placement.points.size() < 2 || placement.points.size() > 100'000)
      found.push_back(fmt::format("points: {} of them, allowed: 2 to 100000", placement.points.size()));
    if (placement.count != 1)
      found.push_back(fmt::format("count: {}, allowed: 1 with points", placement.count));
    for (std::size_t k = 0; k < placement.points.size() && found.size() < 5; ++k) {
      if (!in_domain(placement.points[k], domain))
        found.push_back(
            fmt::format("points[{}]: {}, {}", k, text_of(placement.points[k]), outside_of(domain)));
      else if (solid.contains(placement.points[k].cast<float>()))
        found.push_back(fmt::format("points[{}]: {}, {}", k, text_of(placement.points[k]), in_solid));
      else if (flat && placement.points[k].y() != plane)
        found.push_back(fmt::format("points[{}]: {} along y, allowed: {}, the plane's, with dimensions: 2", k,
                                    placement.points[k].y(), plane));
      else if (const double r = k > 0 ? (placement.points[k] - placement.points[k - 1]).norm() : 0;
               !(r < longest))
        found.push_back(
            fmt::format("points[{}]: {:.4g} r_c from the one before, chain beads farther apart than the "
                        "spring's maximum, {}",
                        k, r, of_longest()));
    }
  }
  // A bond between two beads of mass 1 oscillates with sqrt(2 k), the beads of a long chain with up to twice
  // sqrt(k).
  const bool is_pair = beads == 2;
  const double steepest = law.slope(law.reach(spring_reach_energy * parameters.liquid.temperature));
  const std::string coarse =
      too_coarse("a chain of this spring", std::sqrt((is_pair ? 2 : 4) * steepest), parameters);
  if (!coarse.empty()) found.push_back("spring: " + coarse);
  return found;
}

std::vector<std::string> violations(const MembranePlacement& placement, const Parameters& parameters) {
  std::vector<std::string> found;
  const MembraneStiffness& s = placement.stiffness;
  const auto within = [&found](const char* key, double value, double lower, double upper,
                               const char* allowed) {
    if (!(value >= lower && value <= upper))
      found.push_back(fmt::format("{}: {}, allowed: {}", key, value, allowed));
  };
  if (s.spring == SpringKind::fene) found.push_back("spring: fene, allowed: wlc, harmonic");
  if (const std::string unknown = unknown_species(placement.species, parameters); !unknown.empty())
    found.push_back(unknown);
  within("shear_modulus", s.shear_modulus, 1e-9, 1e5, "above 0 up to 1e5 (k_BT / r_c^2)");
  within("max_stretch", s.max_stretch, 1.2, 10, "1.2 to 10");
  within("bending_rigidity", s.bending_rigidity, 0, 1e5, "0 to 1e5 (k_BT)");
  within("area_stiffness", s.area_stiffness, 0, 1e6, "0 to 1e6 (k_BT / r_c^2)");
  within("local_area_stiffness", s.local_area_stiffness, 0, 1e6, "0 to 1e6 (k_BT / r_c^2)");
  within("volume_stiffness", s.volume_stiffness, 0, 1e6, "0 to 1e6 (k_BT / r_c^3)");
  within("volume_ratio", s.volume_ratio, 0.1, 2, "0.1 to 2");
  if (parameters.dimensions == 2)
    found.push_back("membrane: with dimensions: 2, allowed: a chain, or three dimensions");
  const TriangleMesh& mesh = *placement.mesh;
  if (mesh.vertices.size() > 100'000)
    found.push_back(fmt::format("mesh: {} vertices, allowed: 4 to 100000", mesh.vertices.size()));
  if (!found.empty()) return found;
  found = violations(mesh);
  if (!found.empty()) return found;
  for (std::size_t k = 0; k < mesh.vertices.size() && found.size() < 3; ++k)
    if (!in_domain(mesh.vertices[k], parameters.domain))
      found.push_back(fmt::format("mesh: vertex {} at {}, {}", k, text_of(mesh.vertices[k]),
                                  outside_of(parameters.domain)));
  const Solid solid(parameters);
  for (std::size_t k = 0; k < mesh.vertices.size() && found.empty(); ++k)
    if (solid.contains(mesh.vertices[k].cast<float>()))
      found.push_back(fmt::format("mesh: vertex {} at {}, {}", k, text_of(mesh.vertices[k]), in_solid));
  const MembraneNetwork network(mesh, s);
  const double longest = longest_bond(parameters.domain);
  for (const MembraneNetwork::SpringEdge& edge : network.edges()) {
    const double most = std::min(edge.law.max_length(), (edge.law.rest_length() * s.max_stretch));
    if (most < longest) continue;
    found.push_back(
        fmt::format("mesh: the edge of vertices {} and {} can be {:.4g} r_c long, allowed: less than "
                    "{:.4g}, a third of a periodic side",
                    edge.a, edge.b, most, longest));
    break;
  }
  const std::string coarse = too_coarse("the membrane", network.highest_frequency(mesh.vertices), parameters);
  if (!coarse.empty()) found.push_back("stiffness: " + coarse);
  return found;
}

std::vector<std::vector<Vector3d>> chain_sites(const ChainPlacement& placement, const Parameters& parameters,
                                               std::uint64_t step, std::uint32_t first_id) {
  const Solid solid(parameters);
  std::vector<std::vector<Vector3d>> chains;
  if (!placement.points.empty()) chains.push_back(placement.points);
  for (std::uint32_t k = 0; chains.size() < placement.count; ++k) {
    Draws draws(parameters.seed, step, first_id + k);
    std::optional<std::vector<Vector3d>> sites;
    for (int tries = 0; !sites && tries < most_tries; ++tries)
      sites = placement.shape == ChainShape::straight ? line(draws, placement, parameters, solid)
                                                      : walk(draws, placement, parameters, solid);
    if (!sites)
      throw InvalidInput(fmt::format(
          "chain {} of {}: {} beads with bonds of {:.4g} r_c find no room in the box from {} to {}, allowed: "
          "a larger box, or shorter chains",
          k + 1, placement.count, placement.beads, placement.bond_length, text_of(placement.lower),
          text_of(placement.upper)));
    chains.push_back(std::move(*sites));
  }
  return chains;
}

std::vector<std::uint32_t> take_sites(Beads& beads, const std::vector<Vector3d>& sites,
                                      const std::vector<std::uint8_t>& species, const Bonds& bonds,
                                      const Parameters& parameters, const ShearedDomain& images,
                                      std::uint64_t step, std::uint32_t& next_id) {
  Domain domain = parameters.domain;
  // What is near beyond a sheared side stays: it has an image there, not a place.
  if (images.speed != 0) domain.lower_side[2] = domain.upper_side[2] = Side::reflecting;
  const auto reach = static_cast<float>(parameters.liquid.cutoff_radius);
  std::vector<bool> bound(next_id, false);  // by id
  for (const Chain& chain : bonds.chains())
    for (const std::uint32_t id : chain.beads) bound[id] = true;
  for (const Membrane& membrane : bonds.membranes())
    for (const std::uint32_t id : membrane.beads) bound[id] = true;
  CellGrid grid;
  std::vector<std::uint32_t> order;
  AlignedVector<Record> where = beads.position;
  for (Record& p : where) {
    Vector3d at(p.x, p.y, p.z);
    at += images.shift_into(at);
    p = {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z()), 0};
  }
  grid.lay(domain, domain.lower.cast<float>(), domain.upper.cast<float>(), std::max(reach, 1.f));
  grid.sort(where.data(), where.size(), order);
  const PeriodicImages shifts(domain.size().cast<float>());

  std::vector<std::uint32_t> ids(sites.size(), 0);
  std::vector<std::size_t> without;  // sites
  std::vector<Vector3d> free_sites;
  std::vector<double> slower;  // all are at rest where they were asked for
  std::vector<BeadRun> runs;
  for (std::size_t k = 0; k < sites.size(); ++k) {
    const Vector3d shift = images.shift_into(sites[k]);
    const Eigen::Vector3f site = (sites[k] + shift).cast<float>();
    runs.clear();
    append_runs(grid, domain, site.array() - reach, site.array() + reach, runs);
    float nearest = reach * reach;
    std::uint32_t found = std::numeric_limits<std::uint32_t>::max();
    for (const BeadRun& run : runs)
      for (std::uint32_t place = run.begin; place < run.end; ++place) {
        const std::uint32_t i = order[place];
        if (bound[beads.id[i]]) continue;
        const Record& p = where[i];
        const float apart = (Eigen::Vector3f(p.x, p.y, p.z) + shifts.shift(run.image) - site).squaredNorm();
        // Of two at one distance the one with the lower id: storage order does not matter.
        if (apart > nearest || (apart == nearest && found < where.size() && beads.id[found] < beads.id[i]))
          continue;
        nearest = apart;
        found = i;
      }
    if (found == std::numeric_limits<std::uint32_t>::max()) {
      without.push_back(k);
      free_sites.push_back(sites[k] + shift);
      slower.push_back(images.velocity_shift(shift));
      continue;
    }
    ids[k] = beads.id[found];
    bound[ids[k]] = true;
    Record& p = beads.position[found];
    p = {site.x(), site.y(), site.z(), p.w};
  }
  const std::vector<std::uint32_t> added = place_beads(beads, free_sites, 0, parameters, step, next_id);
  for (std::size_t k = 0; k < without.size(); ++k) {
    ids[without[k]] = added[k];
    Record& velocity = beads.velocity[beads.size() - without.size() + k];
    velocity.x = static_cast<float>(velocity.x + slower[k]);
  }
  give_species(beads, ids, species);
  return ids;
}

}  // namespace dmf::engine
