#include "chip/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "chip/polygon.h"
#include "engine/parameters.h"

namespace dmf::chip {

namespace {

/// Relative size of what counts as a rounding error in a distance or an area.
constexpr double kRounding = 1e-9;

[[noreturn]] void refuse(const std::vector<std::string>& violations) {
  throw engine::InvalidInput(fmt::format("{}", fmt::join(violations, "\n")));
}

std::vector<std::string> outline_violations(const std::vector<Electrode>& electrodes) {
  std::vector<std::string> violations;
  std::set<std::uint32_t> channels;
  for (const Electrode& electrode : electrodes) {
    if (!channels.insert(electrode.channel).second) {
      violations.push_back(
          fmt::format("channel {}: given twice, allowed: one electrode a channel", electrode.channel));
    }
    const std::string fault = polygon_fault(electrode.outline);
    if (!fault.empty())
      violations.push_back(fmt::format("channel {}: outline: {}", electrode.channel, fault));
  }
  return violations;
}

}  // namespace

std::vector<Electrode> electrodes_of(const ElectrodeGrid& grid, double gap) {
  std::vector<std::string> violations;
  if (!(gap < grid.pitch)) {
    violations.push_back(fmt::format("pitch: {} r_c, allowed: more than the gap, {} r_c", grid.pitch, gap));
  }
  std::set<std::array<std::uint32_t, 2>> holes;
  for (const auto& hole : grid.holes) {
    if (hole[0] >= grid.columns || hole[1] >= grid.rows) {
      violations.push_back(fmt::format("holes: [{}, {}], allowed: columns 0 to {}, rows 0 to {}", hole[0],
                                       hole[1], grid.columns - 1, grid.rows - 1));
    }
    if (!holes.insert(hole).second) {
      violations.push_back(fmt::format("holes: [{}, {}] given twice", hole[0], hole[1]));
    }
  }
  if (!violations.empty()) refuse(violations);

  std::vector<Electrode> electrodes;
  const double half = 0.5 * (grid.pitch - gap);
  for (std::uint32_t row = 0; row < grid.rows; ++row) {
    for (std::uint32_t column = 0; column < grid.columns; ++column) {
      if (holes.count({column, row})) continue;
      const Vector2d centre = grid.origin + grid.pitch * Vector2d(column, row);
      Electrode electrode;
      electrode.channel = grid.first_channel + row * grid.columns + column;
      electrode.outline = {centre + Vector2d(-half, -half), centre + Vector2d(half, -half),
                           centre + Vector2d(half, half), centre + Vector2d(-half, half)};
      electrodes.push_back(electrode);
    }
  }
  return electrodes;
}

Layout::Layout(std::vector<Electrode> electrodes, double gap)
    : electrodes_(std::move(electrodes)), gap_(gap) {
  std::vector<std::string> violations = outline_violations(electrodes_);
  if (!(gap > 0 && std::isfinite(gap)))
    violations.push_back(fmt::format("gap: {} r_c, allowed: more than 0", gap));
  if (!violations.empty()) refuse(violations);

  std::vector<Eigen::AlignedBox2d> reach;
  for (Electrode& electrode : electrodes_) {
    electrode.outline = counter_clockwise(electrode.outline);
    electrode.centroid = centroid(electrode.outline);
    electrode.neighbours.clear();
    Eigen::AlignedBox2d box = bounding_box(electrode.outline);
    box.min().array() -= gap * (1 + kRounding);
    box.max().array() += gap * (1 + kRounding);
    reach.push_back(box);
  }
  for (std::size_t i = 0; i < electrodes_.size(); ++i) {
    for (std::size_t j = i + 1; j < electrodes_.size(); ++j) {
      if (!reach[i].intersects(reach[j])) continue;
      Electrode& a = electrodes_[i];
      Electrode& b = electrodes_[j];
      if (shared_area(a.outline, b.outline) > kRounding * gap * gap) {
        violations.push_back(fmt::format("channels {} and {}: outlines overlap", a.channel, b.channel));
      }
      if (distance(a.outline, b.outline) > gap * (1 + kRounding)) continue;
      a.neighbours.push_back(b.channel);
      b.neighbours.push_back(a.channel);
    }
  }
  if (!violations.empty()) refuse(violations);
  for (Electrode& electrode : electrodes_)
    std::sort(electrode.neighbours.begin(), electrode.neighbours.end());
  near_ = ElectrodeIndex(reach);
}

std::size_t Layout::index_of(std::uint32_t channel) const {
  for (std::size_t index = 0; index < electrodes_.size(); ++index) {
    if (electrodes_[index].channel == channel) return index;
  }
  if (electrodes_.empty()) {
    throw engine::InvalidInput(
        fmt::format("channel {} does not exist; this chip has no electrodes", channel));
  }
  throw engine::InvalidInput(
      fmt::format("channel {} does not exist; channels are {}", channel, channels_text()));
}

std::string Layout::channels_text() const {
  std::set<std::uint32_t> channels;
  for (const Electrode& electrode : electrodes_) channels.insert(electrode.channel);
  std::vector<std::string> runs;
  for (auto channel = channels.begin(); channel != channels.end();) {
    const std::uint32_t first = *channel;
    std::uint32_t last = first;
    while (++channel != channels.end() && *channel == last + 1) last = *channel;
    runs.push_back(first == last ? fmt::format("{}", first) : fmt::format("{}-{}", first, last));
  }
  return fmt::format("{}", fmt::join(runs, ", "));
}

double Layout::weights(const Vector2d& point, const std::function<void(std::size_t, double)>& visit) const {
  // Collected first, because the sum that all are divided by comes last. A point is near to few electrodes.
  constexpr std::size_t kMost = 16;
  std::array<std::pair<std::uint32_t, double>, kMost> near;
  std::vector<std::pair<std::uint32_t, double>> more;
  std::size_t count = 0;
  double sum = 0;
  for (const std::uint32_t index : near_.candidates(point)) {
    const double weight = gap_ - distance(point, electrodes_[index].outline);
    if (weight <= 0) continue;
    sum += weight;
    if (count < kMost) {
      near[count++] = {index, weight};
    } else {
      more.emplace_back(index, weight);
    }
  }
  const double bare = std::max(0.0, gap_ - sum);
  const double all = sum + bare;
  for (std::size_t i = 0; i < count; ++i) visit(near[i].first, near[i].second / all);
  for (const auto& [index, weight] : more) visit(index, weight / all);
  return bare / all;
}

std::vector<std::size_t> Layout::overlapping(const std::vector<Vector2d>& polygon) const {
  std::vector<std::size_t> indices;
  if (!polygon_fault(polygon).empty()) return indices;
  const Polygon sound = counter_clockwise(polygon);
  for (std::size_t index = 0; index < electrodes_.size(); ++index) {
    if (shared_area(electrodes_[index].outline, sound) > kRounding * gap_ * gap_) indices.push_back(index);
  }
  return indices;
}

}  // namespace dmf::chip
