#include "engine/observe/droplet_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/multi_point.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <cmath>
#include <utility>

#include "engine/observe/connected_beads.h"

namespace dmf::engine {
namespace {

/// Beads below this height over the wall wet it, r_c.
constexpr double wetting_height = 1.0;
/// A bead with fewer neighbours in range is on its way out of the liquid and does not mark the footprint. The
/// bulk has about 25, the rim about 10.
constexpr std::uint32_t fewest_rim_neighbours = 8;
/// The slab turns when the way of the droplet has turned by more than this cosine (45 degrees).
constexpr double same_way_cosine = 0.70710678;

std::vector<Eigen::Vector2f> convex_outline(const std::vector<Eigen::Vector2d>& points, double& area) {
  namespace bg = boost::geometry;
  using Point = bg::model::d2::point_xy<double>;
  bg::model::multi_point<Point> cloud;
  for (const Eigen::Vector2d& p : points) cloud.emplace_back(p.x(), p.y());
  bg::model::polygon<Point, /*clockwise=*/false, /*closed=*/false> hull;
  bg::convex_hull(cloud, hull);
  area = bg::area(hull);
  std::vector<Eigen::Vector2f> outline;
  for (const Point& p : hull.outer())
    outline.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  return outline;
}

/// A film or a medium from side to side has no edge that could show an angle.
bool fills_box(const DropletObservation& droplet, const Domain& domain) {
  const Vector3d size = droplet.upper - droplet.lower;
  return size.x() > domain.size().x() - 1 && size.y() > domain.size().y() - 1;
}

}  // namespace

DropletTracker::DropletTracker(const Parameters& parameters)
    : parameters_(parameters), wall_plane_(parameters.domain.lower.z()) {}

void DropletTracker::update(std::uint64_t step, const Beads& beads, const Pairs& pairs,
                            const std::vector<std::uint8_t>& solvents) {
  const double elapsed = static_cast<double>(step - last_step_) * parameters_.time_step;
  last_step_ = step;
  std::vector<Component> components = connected_components(beads, pairs, solvents);
  const std::map<std::uint32_t, std::uint32_t> merged_into = give_identities(step, components);

  vapour_beads_ = beads.size();
  const std::vector<std::uint32_t> before = droplet_of_bead_;
  std::fill(droplet_of_bead_.begin(), droplet_of_bead_.end(), 0u);
  droplets_.clear();
  for (const Component& component : components) {
    for (const std::uint32_t bead : component.beads) {
      const std::uint32_t id = beads.id[bead];
      if (id >= droplet_of_bead_.size()) droplet_of_bead_.resize(id + 1, 0u);
      droplet_of_bead_[id] = component.id;
    }
    vapour_beads_ -= component.beads.size();
    droplets_.push_back(measure(component, pairs, elapsed));
  }
  std::sort(droplets_.begin(), droplets_.end(), [](const auto& a, const auto& b) { return a.id < b.id; });

  std::map<std::uint32_t, std::uint32_t> evaporated_from;
  for (const std::uint32_t id : beads.id) {
    if (droplet_of(id) != 0) continue;
    std::uint32_t droplet = id < before.size() ? before[id] : 0;
    if (droplet == 0)
      if (const auto earlier = evaporated_from_.find(id); earlier != evaporated_from_.end())
        droplet = earlier->second;
    if (const auto merged = merged_into.find(droplet); merged != merged_into.end()) droplet = merged->second;
    if (droplet != 0) evaporated_from[id] = droplet;
  }
  evaporated_from_ = std::move(evaporated_from);
}

void DropletTracker::forget(std::uint32_t droplet) {
  for (auto bead = evaporated_from_.begin(); bead != evaporated_from_.end();)
    bead = bead->second == droplet ? evaporated_from_.erase(bead) : std::next(bead);
}

std::vector<DropletTracker::Component> DropletTracker::connected_components(
    const Beads& beads, const Pairs& pairs, const std::vector<std::uint8_t>& solvents) const {
  const auto liquid_of = [&](std::uint32_t i) {
    return solvents.empty() ? beads.species_of(i) : solvents[i];
  };
  const Eigen::Vector3f size = parameters_.domain.size().cast<float>();
  const ShearedDomain images = pairs.ghosts().images();
  const float offset = static_cast<float>(images.offset);
  // In which image a neighbour stands: whole periods between the two positions.
  const auto image = [&](const Record& i, const Record& j) {
    float apart[3] = {i.x - j.x, i.y - j.y, i.z - j.z};
    ConnectedBeads::Image result{};
    for (const int axis : {2, 1, 0})
      if (parameters_.domain.periodic(axis)) {
        result[axis] = static_cast<std::int16_t>(std::lround(apart[axis] / size[axis]));
        if (axis == 2) apart[0] -= static_cast<float>(result[2]) * offset;
      }
    return result;
  };
  ConnectedBeads connected(beads.size());
  for (const NeighbourBlock& block : pairs.blocks())
    for_each_pair_in_range(block, [&](std::uint32_t i, std::uint32_t near) {
      const std::uint32_t j = pairs.ghosts().source(near);
      if (j < i && liquid_of(i) == liquid_of(j) && !connected.joined(i, j))
        connected.join(i, j, image(beads.position[i], beads.position[j]));
    });

  std::vector<std::uint32_t> beads_of_root(beads.size(), 0);
  for (std::uint32_t bead = 0; bead < beads.size(); ++bead) ++beads_of_root[connected.root(bead)];
  std::vector<Component> components;
  std::map<std::uint32_t, std::size_t> component_of_root;
  for (std::uint32_t root = 0; root < beads.size(); ++root) {
    if (beads_of_root[root] < fewest_beads) continue;
    component_of_root[root] = components.size();
    components.emplace_back();
    components.back().beads.reserve(beads_of_root[root]);
    components.back().positions.reserve(beads_of_root[root]);
  }
  for (std::uint32_t bead = 0; bead < beads.size(); ++bead) {
    const std::uint32_t root = connected.root(bead);
    if (beads_of_root[root] < fewest_beads) continue;
    Component& component = components[component_of_root.at(root)];
    component.species = liquid_of(bead);
    component.beads.push_back(bead);
    const Record& p = beads.position[bead];
    const ConnectedBeads::Image& seen = connected.image_of(bead);
    component.positions.emplace_back(p.x + seen[0] * size.x() + seen[2] * offset, p.y + seen[1] * size.y(),
                                     p.z + seen[2] * size.z());
    component.velocity += Vector3d(beads.velocity[bead].x + seen[2] * images.speed, beads.velocity[bead].y,
                                   beads.velocity[bead].z) /
                          beads_of_root[root];
    if (const std::uint32_t before = droplet_of(beads.id[bead])) ++component.beads_from[before];
  }
  return components;
}

std::map<std::uint32_t, std::uint32_t> DropletTracker::give_identities(std::uint64_t step,
                                                                       std::vector<Component>& components) {
  std::map<std::uint32_t, std::uint32_t> merged_into;
  // Who inherits each droplet: the component with most of its beads.
  std::map<std::uint32_t, std::pair<std::size_t, std::size_t>> heirs;  // droplet -> (beads, component)
  for (std::size_t c = 0; c < components.size(); ++c)
    for (const auto& [droplet, beads] : components[c].beads_from)
      if (const auto [heir, first] = heirs.try_emplace(droplet, beads, c);
          !first && beads > heir->second.first)
        heir->second = {beads, c};

  std::map<std::uint32_t, Memory> remembered;
  for (std::size_t c = 0; c < components.size(); ++c) {
    Component& component = components[c];
    std::vector<std::uint32_t> inherited, sources;
    for (const auto& [droplet, beads] : component.beads_from) {
      if (heirs.at(droplet).second == c) inherited.push_back(droplet);
      if (beads >= fewest_beads) sources.push_back(droplet);
    }
    if (!inherited.empty()) {
      component.id =
          *std::max_element(inherited.begin(), inherited.end(), [&](std::uint32_t a, std::uint32_t b) {
            const std::size_t beads_a = component.beads_from[a], beads_b = component.beads_from[b];
            return beads_a != beads_b ? beads_a < beads_b : a > b;
          });
      Memory memory = std::move(memory_.at(component.id));
      if (inherited.size() > 1) {
        for (const std::uint32_t droplet : inherited) {
          if (droplet == component.id) continue;
          memory.parents.push_back(droplet);
          merged_into[droplet] = component.id;
        }
        events_.push_back({DropletEvent::Kind::merged, step, inherited, {component.id}});
      }
      remembered.emplace(component.id, std::move(memory));
      continue;
    }
    component.id = next_id_++;
    Memory memory;
    memory.parents = sources;
    remembered.emplace(component.id, std::move(memory));
    if (sources.empty())
      events_.push_back({DropletEvent::Kind::appeared, step, {}, {component.id}});
    else {
      std::vector<std::uint32_t> to = sources;
      to.push_back(component.id);
      events_.push_back({DropletEvent::Kind::split, step, sources, to});
    }
  }
  for (const DropletObservation& droplet : droplets_)
    if (heirs.count(droplet.id) == 0)
      events_.push_back({DropletEvent::Kind::vanished, step, {droplet.id}, {}});
  memory_ = std::move(remembered);
  return merged_into;
}

DropletObservation DropletTracker::measure(const Component& component, const Pairs& pairs, double elapsed) {
  DropletObservation droplet;
  Memory& memory = memory_.at(component.id);
  const double count = static_cast<double>(component.beads.size());
  droplet.id = component.id;
  droplet.parents = memory.parents;
  droplet.beads = component.beads.size();
  droplet.species = component.species;
  droplet.volume = count / bulk_density(parameters_, droplet.species);

  droplet.lower = droplet.upper = component.positions.front().cast<double>();
  std::vector<Eigen::Vector2d> wetting;
  for (std::size_t k = 0; k < component.beads.size(); ++k) {
    const Vector3d position = component.positions[k].cast<double>();
    droplet.centroid += position / count;
    droplet.lower = droplet.lower.cwiseMin(position);
    droplet.upper = droplet.upper.cwiseMax(position);
    if (parameters_.domain.has_wall() && position.z() - wall_plane_ < wetting_height &&
        block_of(pairs.blocks(), component.beads[k]).in_range_count(component.beads[k]) >=
            fewest_rim_neighbours)
      wetting.push_back(position.head<2>());
  }
  const Domain& domain = parameters_.domain;
  // Mean over the window. A droplet starts at rest.
  const double weight =
      parameters_.angle_window > 0 ? 1.0 - std::exp(-elapsed / parameters_.angle_window) : 1.0;
  const auto flow = [&] {
    const double height = droplet.centroid.z() - 0.5 * (domain.lower.z() + domain.upper.z());
    return Vector3d(parameters_.boundaries.shear_rate * height, 0, 0);
  };
  memory.velocity += weight * (component.velocity - flow() - memory.velocity);
  droplet.velocity = memory.velocity + flow();
  droplet.height = droplet.upper.z() - wall_plane_;
  if (wetting.size() >= 3) droplet.footprint = convex_outline(wetting, droplet.footprint_area);
  // The circle is fitted to a cap. Between two plates there is none: no angle is better than a wrong one.
  const bool reaches_top = domain.has_top_plate() && droplet.upper.z() > domain.upper.z() - wetting_height;
  if (droplet.footprint_area > 0 && !reaches_top && !fills_box(droplet, domain))
    measure_angles(droplet, component, elapsed);

  // Reported inside the box, although measured on the unwrapped droplet.
  const Vector3d shift = pairs.ghosts().images().shift_into(droplet.centroid);
  for (Vector3d* place : {&droplet.centroid, &droplet.lower, &droplet.upper}) *place += shift;
  for (Eigen::Vector2f& corner : droplet.footprint) corner += shift.head<2>().cast<float>();
  droplet.velocity = memory.velocity + flow();  // of the image that is reported
  return droplet;
}

void DropletTracker::measure_angles(DropletObservation& droplet, const Component& component, double elapsed) {
  RunningAngles& angles = memory_.at(component.id).angles;
  // A droplet of N beads jitters with sqrt(k_BT / N); what is hardly faster than that is rest, and keeps its
  // way.
  const double jitter =
      std::sqrt(parameters_.liquid.temperature / static_cast<double>(component.beads.size()));
  const Eigen::Vector2d horizontal = droplet.velocity.head<2>();
  if (horizontal.norm() > 1.5 * jitter && angles.way().dot(horizontal.normalized()) < same_way_cosine)
    angles.turn(horizontal.normalized());
  angles.begin_sample(elapsed, parameters_.angle_window);
  const Vector3d foot(droplet.centroid.x(), droplet.centroid.y(), wall_plane_);
  for (const Eigen::Vector3f& position : component.positions) angles.add(position.cast<double>() - foot);
  if (const auto found = angles.angles(bulk_density(parameters_, droplet.species))) {
    droplet.advancing_angle = found->advancing;
    droplet.receding_angle = found->receding;
    droplet.contact_angle = 0.5 * (found->advancing + found->receding);
  }
}

namespace {

void archive_droplet(Archive& archive, DropletObservation& droplet) {
  archive(droplet.id);
  archive(droplet.species);
  archive(droplet.parents);
  archive(droplet.beads);
  for (Vector3d* vector : {&droplet.centroid, &droplet.velocity, &droplet.lower, &droplet.upper})
    archive(*vector);
  archive(droplet.volume);
  archive(droplet.footprint_area);
  archive(droplet.height);
  std::vector<float> corners;
  for (const Eigen::Vector2f& corner : droplet.footprint)
    corners.insert(corners.end(), {corner.x(), corner.y()});
  archive(corners);
  droplet.footprint.clear();
  for (std::size_t k = 0; k + 1 < corners.size(); k += 2)
    droplet.footprint.emplace_back(corners[k], corners[k + 1]);
  for (std::optional<double>* angle :
       {&droplet.contact_angle, &droplet.advancing_angle, &droplet.receding_angle})
    archive(*angle);
}

}  // namespace

void DropletTracker::archive(Archive& archive) {
  archive(last_step_);
  archive(next_id_);
  archive(vapour_beads_);
  archive(droplet_of_bead_);
  std::vector<std::uint32_t> vapour, sources;
  for (const auto& [bead, droplet] : evaporated_from_) {
    vapour.push_back(bead);
    sources.push_back(droplet);
  }
  archive(vapour);
  archive(sources);
  if (vapour.size() != sources.size()) throw InvalidInput("saved state: vapour without a source");
  for (std::size_t k = 0; k < vapour.size(); ++k) evaporated_from_[vapour[k]] = sources[k];
  std::vector<std::uint32_t> ids;
  for (const auto& entry : memory_) ids.push_back(entry.first);
  archive(ids);
  for (const std::uint32_t id : ids) {
    Memory& memory = memory_[id];
    archive(memory.parents);
    archive(memory.velocity);
    memory.angles.archive(archive);
  }
  std::uint64_t count = droplets_.size();
  archive(count);
  if (count > ids.size()) throw InvalidInput("saved state: more droplets than remembered");
  droplets_.resize(count);
  for (DropletObservation& droplet : droplets_) archive_droplet(archive, droplet);
  if (archive.reading()) require_sound();
}

void DropletTracker::require_sound() const {
  const auto remembered = [this](std::uint32_t id) { return memory_.count(id) > 0; };
  for (const auto& [id, memory] : memory_)
    if (id == 0 || id >= next_id_ || !memory.velocity.allFinite())
      throw InvalidInput(fmt::format("saved state: droplet {}, allowed: below {}", id, next_id_));
  for (const std::uint32_t droplet : droplet_of_bead_)
    if (droplet != 0 && !remembered(droplet))
      throw InvalidInput(fmt::format("saved state: a bead of droplet {}, which is not there", droplet));
  std::uint32_t before = 0;
  for (const DropletObservation& droplet : droplets_) {
    if (!remembered(droplet.id) || droplet.id <= before)
      throw InvalidInput(
          fmt::format("saved state: droplet {}, allowed: rising ids that are there", droplet.id));
    before = droplet.id;
    if (droplet.species > parameters_.mixture.liquids.size())
      throw InvalidInput(fmt::format("saved state: species {}, allowed: 0 to {}", droplet.species,
                                     parameters_.mixture.liquids.size()));
    bool finite = droplet.centroid.allFinite() && droplet.velocity.allFinite() && droplet.lower.allFinite() &&
                  droplet.upper.allFinite();
    for (const Eigen::Vector2f& corner : droplet.footprint) finite = finite && corner.allFinite();
    if (!finite) throw InvalidInput(fmt::format("saved state: droplet {} is at no number", droplet.id));
  }
}

}  // namespace dmf::engine
