#include "engine/walls/walls.h"

#include <fmt/format.h>

#include "engine/walls/plates.h"
#include "engine/walls/solid_beads.h"

namespace dmf::engine {

Walls::Walls(const Parameters& parameters) : domain_(parameters.domain), solid_(parameters) {
  const double range = parameters.liquid.range() + parameters.list_skin;
  if (domain_.has_wall()) add_plate(parameters, domain_.lower.z(), -1, range);
  if (domain_.has_top_plate()) add_plate(parameters, domain_.upper.z(), +1, range);
  if (!solid_.empty()) {
    const LabelGrid& grid = *parameters.label_grid.grid;
    groups_.push_back(add(solid_beads(parameters), grid.origin, grid.upper(), range, false));
  }
}

void Walls::add_plate(const Parameters& parameters, double plane, int outward, double range) {
  const Plate plate = plate_at(domain_, parameters.wall, plane, outward, parameters.dimensions);
  // One cell across the layers: a run along x then holds a whole strip of wall behind a bead.
  groups_.push_back(add(plate.beads, plate.lower, plate.upper, range, true));
  groups_.back().lower.z() = groups_.back().upper.z() = static_cast<float>(plane);
}

Walls::Group Walls::add(const AlignedVector<Record>& unsorted, const Vector3d& lower, const Vector3d& upper,
                        double range, bool flat) {
  Group group{static_cast<std::uint32_t>(beads_.size()), 0, lower.cast<float>(), upper.cast<float>(), {}};
  group.grid.lay(domain_, group.lower, group.upper, range);
  if (flat) group.grid.cells[2] = 1;
  std::vector<std::uint32_t> order;
  group.grid.sort(unsorted.data(), unsorted.size(), order);
  beads_.reserve(beads_.size() + order.size());
  for (const std::uint32_t k : order) beads_.push_back(unsorted[k]);
  group.end = static_cast<std::uint32_t>(beads_.size());
  return group;
}

bool Walls::reaches(const Group& group, const Eigen::Vector3f& lower, const Eigen::Vector3f& upper) const {
  for (int axis = 0; axis < 3; ++axis)
    if (!domain_.periodic(axis) && (lower[axis] > group.upper[axis] || upper[axis] < group.lower[axis]))
      return false;
  return true;
}

void Walls::append_runs(const Eigen::Vector3f& lower, const Eigen::Vector3f& upper,
                        std::vector<BeadRun>& runs) const {
  for (const Group& group : groups_) {
    if (!reaches(group, lower, upper)) continue;
    const std::size_t before = runs.size();
    engine::append_runs(group.grid, domain_, lower, upper, runs);
    for (std::size_t run = before; run < runs.size(); ++run) {
      runs[run].begin += group.first;
      runs[run].end += group.first;
    }
  }
}

std::vector<float> Walls::attraction() const {
  std::vector<float> values;
  values.reserve(beads_.size());
  for (const Record& bead : beads_) values.push_back(bead.w);
  return values;
}

void Walls::set_attraction(const std::vector<float>& attraction) {
  if (attraction.size() != beads_.size())
    throw InvalidInput(fmt::format("wall: {} values, allowed: {}", attraction.size(), beads_.size()));
  for (std::size_t i = 0; i < beads_.size(); ++i) beads_[i].w = attraction[i];
}

void Walls::set_wettability(const ContactAngleField& field, const ContactAngleCurve& curve) {
  if (!domain_.has_wall()) return;
  std::vector<float> values = attraction();
  for (std::size_t i = 0; i < groups_.front().end; ++i)
    values[i] = static_cast<float>(curve.attraction(field(beads_[i].x, beads_[i].y)));
  set_attraction(values);
}

void Walls::set_fixed_wettability(const Parameters& parameters, const ContactAngleCurve& curve) {
  const std::optional<double> given = fixed_wall_attraction(parameters);
  if (given)
    set_attraction(std::vector<float>(size(), static_cast<float>(*given)));
  else if (domain_.has_top_plate())
    set_attraction_of(groups_[1], curve.attraction(parameters.wall.top_contact_angle));
  const LabelGridParameters& solid = parameters.label_grid;
  if (!solid_.empty() && (!given || solid.attraction))
    set_attraction_of(groups_.back(),
                      solid.attraction ? *solid.attraction : curve.attraction(solid.contact_angle));
}

void Walls::set_attraction_of(const Group& group, double attraction) {
  for (std::uint32_t i = group.first; i < group.end; ++i) beads_[i].w = static_cast<float>(attraction);
}

}  // namespace dmf::engine
