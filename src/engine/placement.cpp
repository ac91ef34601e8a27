#include "engine/placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/cell_grid.h"
#include "engine/memory.h"
#include "engine/noise.h"
#include "engine/observe/droplet_tracker.h"
#include "engine/walls/solid.h"

namespace dmf::engine {
namespace {

/// A lattice on which liquid is placed: fcc, or in a plane the centred square.
struct Lattice {
  double constant;    ///< a; layers are a/2 apart
  std::size_t basis;  ///< sites a cell
  double plane;       ///< y, of the one in a plane
  bool flat() const { return basis == 2; }
  Vector3d cell() const { return Vector3d::Constant(constant); }
};

Lattice lattice_of(const Parameters& parameters, std::uint32_t species) {
  const double density = initial_density(parameters, species);
  return parameters.dimensions == 2 ? Lattice{std::sqrt(2.0 / density), 2, parameters.plane()}
                                    : Lattice{std::cbrt(4.0 / density), 4, 0};
}

/// Calls visit(site) for every site with lower <= site < upper; the lattice has a site a quarter cell inside
/// lower.
template <class Visit>
void for_each_site(const Vector3d& lower, const Vector3d& upper, const Lattice& lattice, const Vector3d& cell,
                   Visit visit) {
  static const double fcc[4][3] = {{.25, .25, .25}, {.75, .75, .25}, {.75, .25, .75}, {.25, .75, .75}};
  static const double square[2][3] = {{.25, 0, .25}, {.75, 0, .75}};
  const double(*basis)[3] = lattice.flat() ? square : fcc;
  const Eigen::Vector3i count = ((upper - lower).array() / cell.array()).ceil().cast<int>();
  for (int k = 0; k < count.z(); ++k)
    for (int j = 0; j < (lattice.flat() ? 1 : count.y()); ++j)
      for (int i = 0; i < count.x(); ++i)
        for (std::size_t b = 0; b < lattice.basis; ++b) {
          Vector3d site = lower + Vector3d((i + basis[b][0]) * cell.x(), (j + basis[b][1]) * cell.y(),
                                           (k + basis[b][2]) * cell.z());
          if (lattice.flat()) site.y() = lattice.plane;
          if ((site.array() < upper.array()).all()) visit(site);
        }
}

void require_species(std::uint32_t species, const Parameters& parameters) {
  if (species > parameters.mixture.liquids.size())
    throw InvalidInput(
        fmt::format("species {}, allowed: 0 to {}", species, parameters.mixture.liquids.size()));
}

/// Ids for new beads, rising: those of beads that were taken out first, so that what is kept by id stays as
/// large as the most beads that were there at once. @param next_id  above all that were ever given; advanced.
std::vector<std::uint32_t> take_ids(const Beads& beads, std::size_t count, std::uint32_t& next_id) {
  std::vector<bool> taken(next_id, false);
  for (const std::uint32_t id : beads.id) taken[id] = true;
  std::vector<std::uint32_t> ids;
  ids.reserve(count);
  for (std::uint32_t id = 0; id < taken.size() && ids.size() < count; ++id)
    if (!taken[id]) ids.push_back(id);
  while (ids.size() < count) ids.push_back(next_id++);
  return ids;
}

/// Beads of the initial density in a sphere, or in a plane in a disc.
double sphere_beads(const DropletPlacement& placement, const Parameters& parameters) {
  const double radius = placement.radius, density = initial_density(parameters, placement.species);
  if (parameters.dimensions == 2) return M_PI * radius * radius * density;
  return 4.0 / 3.0 * M_PI * std::pow(radius, 3) * density;
}

void require_within(const Domain& domain, int axis, double low, double high, double cutoff_radius) {
  static const char* const axes = "xyz";
  if (domain.periodic(axis) ? high - low + cutoff_radius > domain.size()[axis]
                            : low < domain.lower[axis] - 1e-9 || high > domain.upper[axis] + 1e-9)
    throw InvalidInput(fmt::format("droplet: {} to {} along {}, allowed: within {} to {} (r_c)", low, high,
                                   axes[axis], domain.lower[axis], domain.upper[axis]));
}

/// The sphere, cut by the wall.
std::vector<Vector3d> sphere_sites(const DropletPlacement& placement, const Parameters& parameters) {
  const Domain& domain = parameters.domain;
  const Lattice lattice = lattice_of(parameters, placement.species);
  Vector3d center = placement.center;
  if (lattice.flat()) center.y() = lattice.plane;
  const double radius = placement.radius;
  // A sphere whose centre lies below the wall plane is a flat cap, as wide as its base.
  const double sunk = domain.has_wall() ? std::clamp(domain.lower.z() - center.z(), 0.0, radius) : 0.0;
  const double wide = std::sqrt(radius * radius - sunk * sunk);
  const Vector3d reach(wide, lattice.flat() ? 0 : wide, radius);
  for (int axis = 0; axis < 3; ++axis) {
    const bool cut_by_wall = axis == 2 && domain.has_wall();
    require_within(domain, axis, cut_by_wall ? domain.lower.z() : center[axis] - reach[axis],
                   center[axis] + reach[axis], parameters.liquid.cutoff_radius);
  }
  const double a = lattice.constant;
  const double unbounded = std::numeric_limits<double>::infinity();
  const double lowest = domain.has_wall() ? domain.lower.z() + 0.5 * a : -unbounded;
  const double highest = domain.has_top_plate() ? domain.upper.z() - 0.5 * a : unbounded;
  std::vector<Vector3d> sites;
  for_each_site(
      center - Vector3d::Constant(radius), center + Vector3d::Constant(radius), lattice, lattice.cell(),
      [&](const Vector3d& site) {
        if ((site - center).squaredNorm() < radius * radius && site.z() >= lowest && site.z() <= highest)
          sites.push_back(site);
      });
  return sites;
}

/// As many sites as the sphere has, those nearest to the axis, in whole layers half a lattice constant from
/// both plates.
std::vector<Vector3d> pancake_sites(const DropletPlacement& placement, const Parameters& parameters) {
  const Domain& domain = parameters.domain;
  const double footprint = pancake_radius(placement, parameters);
  for (int axis = 0; axis < 2; ++axis)
    require_within(domain, axis, placement.center[axis] - footprint, placement.center[axis] + footprint,
                   parameters.liquid.cutoff_radius);
  const Lattice lattice = lattice_of(parameters, placement.species);
  const double a = lattice.constant;
  const auto count = static_cast<std::size_t>(std::lround(sphere_beads(placement, parameters)));
  const double between = domain.size().z() - a;  // of the lowest and the highest layer
  const double layers = std::floor(between / (0.5 * a)) + 1;
  const double wide = std::sqrt(static_cast<double>(count) * a * a / (2.0 * M_PI * layers)) + 2.0 * a;
  const double from = domain.lower.z() + 0.5 * (domain.size().z() - 0.5 * a * layers);
  const Vector3d lower(placement.center.x() - wide, placement.center.y() - wide, from);
  const Vector3d upper(placement.center.x() + wide, placement.center.y() + wide, from + 0.5 * a * layers);
  std::vector<Vector3d> sites;
  for_each_site(lower, upper, lattice, lattice.cell(), [&](const Vector3d& site) { sites.push_back(site); });
  const auto from_axis = [&](const Vector3d& site) {
    return (site - placement.center).head<2>().squaredNorm();
  };
  std::stable_sort(sites.begin(), sites.end(),
                   [&](const Vector3d& p, const Vector3d& q) { return from_axis(p) < from_axis(q); });
  sites.resize(std::min(count, sites.size()));
  return sites;
}

/// Finds beads near a place.
class BeadsAround {
 public:
  BeadsAround(const Beads& beads, const Domain& domain) : domain_(domain) {
    for (int axis = 0; axis < 3; ++axis)
      if (domain.periodic(axis)) period_[axis] = static_cast<float>(domain.size()[axis]);
    grid_.lay(domain, domain.lower.cast<float>(), domain.upper.cast<float>(), edge);
    std::vector<std::uint32_t> order;
    grid_.sort(beads.position.data(), beads.size(), order);
    sorted_.reserve(order.size());
    for (const std::uint32_t bead : order) sorted_.push_back(beads.position[bead]);
  }

  /// @param distance  up to `edge`.
  bool any_within(double distance, const Vector3d& site) const {
    const Eigen::Vector3f at = site.cast<float>();
    const auto reach = Eigen::Vector3f::Constant(static_cast<float>(distance));
    const PeriodicImages images(period_);
    std::vector<BeadRun> runs;
    append_runs(grid_, domain_, at - reach, at + reach, runs);
    for (const BeadRun& run : runs)
      for (std::uint32_t j = run.begin; j < run.end; ++j) {
        const Eigen::Vector3f bead(sorted_[j].x, sorted_[j].y, sorted_[j].z);
        if ((bead + images.shift(run.image) - at).norm() < distance) return true;
      }
    return false;
  }

 private:
  static constexpr double edge = 1;  ///< of a cell, r_c
  Domain domain_;
  Eigen::Vector3f period_ = Eigen::Vector3f::Zero();
  CellGrid grid_;
  std::vector<Record> sorted_;
};

}  // namespace

double liquid_height(const Parameters& parameters) {
  return parameters.domain.size().z() - 2.0 * parameters.liquid.wall_distance;
}

double pancake_radius(const DropletPlacement& placement, const Parameters& parameters) {
  const double height = liquid_height(parameters);
  if (parameters.dimensions == 2) return 0.0;
  if (!parameters.domain.has_top_plate() || 2.0 * placement.radius <= height) return 0.0;
  return std::sqrt(4.0 / 3.0 * std::pow(placement.radius, 3) / height);
}

std::vector<Vector3d> droplet_sites(const DropletPlacement& placement, const Parameters& parameters) {
  require_species(placement.species, parameters);
  const Vector3d& center = placement.center;
  const double radius = placement.radius;
  if (!center.allFinite() || !std::isfinite(radius) || radius <= 0)
    throw InvalidInput(
        fmt::format("droplet: center ({}, {}, {}), radius {}, allowed: finite, radius above 0 (r_c)",
                    center.x(), center.y(), center.z(), radius));
  // The wall may cut a part of the sphere off.
  require_memory(parameters, 0.5 * sphere_beads(placement, parameters), 0);
  const std::vector<Vector3d> sites = pancake_radius(placement, parameters) > 0
                                          ? pancake_sites(placement, parameters)
                                          : sphere_sites(placement, parameters);
  if (sites.size() < DropletTracker::fewest_beads)
    throw InvalidInput(fmt::format("droplet: {} beads, allowed: {} or more (a radius of about 1 r_c)",
                                   sites.size(), DropletTracker::fewest_beads));
  const Solid solid(parameters);
  for (const Vector3d& site : sites)
    if (solid.contains(site.cast<float>()))
      throw InvalidInput(fmt::format(
          "droplet: ({:.2f}, {:.2f}, {:.2f}) r_c is in the solid of the label grid, allowed: outside of it",
          site.x(), site.y(), site.z()));
  return sites;
}

std::vector<Vector3d> slab_sites(const FillPlacement& placement, const Parameters& parameters) {
  require_species(placement.species, parameters);
  const Vector3d &lower = placement.lower, &upper = placement.upper;
  if (!parameters.domain.contains(lower) || !parameters.domain.contains(upper) ||
      !(lower.array() < upper.array()).all())
    throw InvalidInput("slab: allowed: lower below upper, both in the domain");
  const Lattice lattice = lattice_of(parameters, placement.species);
  const double a = lattice.constant;
  const Vector3d size = upper - lower;
  const double volume = lattice.flat() ? size.x() * size.z() : size.prod();
  require_memory(parameters, volume * initial_density(parameters, placement.species), 0);
  // Whole cells across the slab, so that periodic neighbours stand at lattice distance.
  Vector3d cells = (size / a).array().round().max(1.0);
  // What rounding in x and y has taken off or put on too much, the layers in z make good.
  if (!lattice.flat())
    cells.z() = std::max(1.0, std::round(size.prod() / (a * a * a) / (cells.x() * cells.y())));
  std::vector<Vector3d> sites;
  const Solid solid(parameters);
  for_each_site(lower, upper, lattice, size.cwiseQuotient(cells), [&](const Vector3d& site) {
    if (!solid.contains(site.cast<float>())) sites.push_back(site);
  });
  if (sites.empty())
    throw InvalidInput("slab: no fluid voxel in it, allowed: with some, to hold a bead or more");
  return sites;
}

void require_free(const Beads& beads, const std::vector<Vector3d>& sites, const Parameters& parameters) {
  // Coarse first: only beads near the sites' box are compared with each of them.
  Vector3d lower = sites.front(), upper = sites.front();
  for (const Vector3d& site : sites) lower = lower.cwiseMin(site), upper = upper.cwiseMax(site);
  const Vector3d middle = 0.5 * (lower + upper), half = 0.5 * (upper - lower);
  const double cutoff = parameters.liquid.cutoff_radius;
  for (const Record& record : beads.position) {
    const Vector3d from_middle =
        parameters.domain.nearest_image(Vector3d(record.x, record.y, record.z) - middle);
    if ((from_middle.cwiseAbs().array() > half.array() + cutoff).any()) continue;
    const Vector3d image = middle + from_middle;
    for (const Vector3d& site : sites)
      if ((site - image).squaredNorm() < cutoff * cutoff)
        throw InvalidInput(
            fmt::format("place is occupied: liquid at ({:.2f}, {:.2f}, {:.2f}) r_c, allowed: {} r_c or more "
                        "from all other liquid",
                        image.x(), image.y(), image.z(), cutoff));
  }
}

std::vector<Vector3d> free_sites(const FillPlacement& placement, const Beads& beads,
                                 const Microparticles& bodies, const Parameters& parameters) {
  require_species(placement.species, parameters);
  // Nearer than half a lattice constant, less than the next layer of a slab that begins here.
  const double distance = 0.49 * lattice_of(parameters, placement.species).constant;
  std::vector<Vector3d> sites;
  const BeadsAround there(beads, parameters.domain);
  for (const Vector3d& site : slab_sites(placement, parameters))
    if (!there.any_within(distance, site) && bodies.clear_of(site)) sites.push_back(site);
  if (sites.empty()) throw InvalidInput("fill: no free place, allowed: a box that is not full already");
  return sites;
}

std::vector<std::uint32_t> place_beads(Beads& beads, const std::vector<Vector3d>& sites,
                                       std::uint32_t species, const Parameters& parameters,
                                       std::uint64_t step, std::uint32_t& next_id) {
  const std::vector<std::uint32_t> ids = take_ids(beads, sites.size(), next_id);
  const StepKey key = step_key(parameters.seed, step, Stream::velocity);
  const double spread = std::sqrt(parameters.liquid.temperature);
  std::vector<Vector3d> velocities;
  Vector3d mean = Vector3d::Zero();
  velocities.reserve(sites.size());
  for (const std::uint32_t id : ids) {
    velocities.emplace_back(gaussian_noise(key, id, 0), gaussian_noise(key, id, 1),
                            gaussian_noise(key, id, 2));
    if (parameters.dimensions == 2) velocities.back().y() = 0;
    mean += velocities.back() / static_cast<double>(sites.size());
  }
  beads.reserve_more(sites.size());
  for (std::size_t k = 0; k < sites.size(); ++k) {
    const Eigen::Vector3f at = sites[k].cast<float>(),
                          moving = (spread * (velocities[k] - mean)).cast<float>();
    beads.add({at.x(), at.y(), at.z(), 0}, {moving.x(), moving.y(), moving.z(), 0}, ids[k],
              static_cast<std::uint8_t>(species));
  }
  return ids;
}

}  // namespace dmf::engine
