#include "controller/layout.h"

#include <fmt/format.h>

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/ring.hpp>
#include <cmath>

#include "yaml/invalid_input.h"

namespace dmf::controller {

namespace {

namespace geometry = boost::geometry;
using RingPoint = geometry::model::d2::point_xy<double>;
using Ring = geometry::model::ring<RingPoint, false, false>;  // counter-clockwise, not closed

/// The corners of two pads of a grid are a gap times the root of two apart: near, though no droplet is pulled
/// from one to the other.
constexpr double kCornerDistanceInGaps = 1.5;

Ring ring_of(const Electrode& electrode) {
  Ring ring;
  for (const auto& [x, y] : electrode.outline) ring.emplace_back(x, y);
  geometry::correct(ring);
  return ring;
}

}  // namespace

Layout::Layout(BoardDescription board) : board_(std::move(board)) {
  std::vector<std::string> violations;
  std::map<Channel, Ring> rings;
  for (const Electrode& electrode : board_.electrodes) {
    if (!channels_.insert(electrode.channel).second) {
      violations.push_back(
          fmt::format("channel {}: given twice, allowed: one electrode a channel", electrode.channel));
      continue;
    }
    const Ring ring = ring_of(electrode);
    Pad& pad = pads_[electrode.channel];
    pad.neighbours = {electrode.neighbours.begin(), electrode.neighbours.end()};
    pad.area = ring.size() < 3 ? 0 : geometry::area(ring);
    if (!(pad.area > 0)) {
      violations.push_back(fmt::format("channel {}: an outline without area", electrode.channel));
      continue;
    }
    RingPoint centre(0, 0);
    geometry::centroid(ring, centre);
    pad.centroid = {centre.x(), centre.y()};
    rings[electrode.channel] = ring;
  }
  for (auto& [channel, pad] : pads_) {
    pad.near = pad.neighbours;
    pad.near.insert(channel);
    for (const Channel neighbour : pad.neighbours) {
      if (!has(neighbour))
        violations.push_back(fmt::format("channel {}: neighbour {} does not exist", channel, neighbour));
    }
    for (const auto& [other, ring] : rings) {
      if (rings.count(channel) &&
          geometry::distance(rings.at(channel), ring) <= kCornerDistanceInGaps * board_.gap)
        pad.near.insert(other);
    }
  }
  const Sensing& sensing = board_.sensing;
  if (!(sensing.liquid_capacitance > sensing.filler_capacitance)) {
    violations.push_back(
        fmt::format("liquid capacitance: {} F/m^2, allowed: more than that of the filler, {}",
                    sensing.liquid_capacitance, sensing.filler_capacitance));
  }
  if (!violations.empty()) throw InvalidInput(fmt::format("{}", fmt::join(violations, "\n")));
}

void Layout::require(Channel channel) const {
  if (!has(channel))
    throw InvalidInput(
        fmt::format("channel {} does not exist; channels are {}", channel, channels_text(channels_)));
}

Channels Layout::within(Channel channel, int rings) const {
  Channels reached{channel};
  for (int ring = 0; ring < rings; ++ring) {
    Channels next;
    for (const Channel inner : reached) next.insert(near(inner).begin(), near(inner).end());
    reached = std::move(next);
  }
  return reached;
}

bool Layout::are_opposite(Channel middle, Channel a, Channel b) const {
  const auto way = [&](Channel to) {
    return std::array<double, 2>{centroid(to)[0] - centroid(middle)[0],
                                 centroid(to)[1] - centroid(middle)[1]};
  };
  const auto to_a = way(a), to_b = way(b);
  const double cosine =
      (to_a[0] * to_b[0] + to_a[1] * to_b[1]) / (std::hypot(to_a[0], to_a[1]) * std::hypot(to_b[0], to_b[1]));
  return cosine < -std::sqrt(0.5);
}

std::string channels_text(const Channels& channels) {
  std::vector<std::string> runs;
  for (auto channel = channels.begin(); channel != channels.end();) {
    const Channel first = *channel;
    Channel last = first;
    while (++channel != channels.end() && *channel == last + 1) last = *channel;
    runs.push_back(first == last ? fmt::format("{}", first) : fmt::format("{}-{}", first, last));
  }
  return fmt::format("{}", fmt::join(runs, ", "));
}

}  // namespace dmf::controller
