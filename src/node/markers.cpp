#include "node/markers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "node/triangulate.h"

namespace dmf::node {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

// Lengths in r_c.
constexpr double kPlateThickness = 1.0;
constexpr double kPadHeight = 0.05;    // above the plate, so that neither flickers through the other
constexpr double kBeadDiameter = 0.8;  // beads of a dense liquid just touch: it shows as a closed surface
constexpr double kLabelGap = 2.0;      // from the top of a droplet to its label

std_msgs::ColorRGBA color(double r, double g, double b, double a = 1) {
  std_msgs::ColorRGBA result;
  result.r = static_cast<float>(r);
  result.g = static_cast<float>(g);
  result.b = static_cast<float>(b);
  result.a = static_cast<float>(a);
  return result;
}

/// Grey without voltage to orange at the board's limit.
std_msgs::ColorRGBA voltage_color(double voltage, double max_voltage) {
  const double f = std::clamp(std::abs(voltage) / max_voltage, 0.0, 1.0);
  return color(0.5 + 0.5 * f, 0.5 + 0.05 * f, 0.52 - 0.47 * f);
}

/// Neighbouring ids differ most: hues a golden section apart.
std_msgs::ColorRGBA droplet_color(std::uint32_t id) {
  const double hue = 6 * std::fmod(0.58 + 0.381966 * (id - 1.0), 1.0);
  const auto channel = [hue](double shift) {
    const double k = std::fmod(hue + shift, 6.0);
    return 0.95 - 0.7 * std::clamp(std::min(k, 4 - k), 0.0, 1.0);
  };
  return color(channel(5), channel(3), channel(1), 0.9);
}

geometry_msgs::Point point(double x, double y, double z) {
  geometry_msgs::Point result;
  result.x = x;
  result.y = y;
  result.z = z;
  return result;
}

Marker marker(const char* name_space, std::uint32_t id, int type, const Frame& frame) {
  Marker result;
  result.header.frame_id = kChipFrame;
  result.header.stamp = to_ros_time(frame.stamp);
  result.ns = name_space;
  result.id = static_cast<std::int32_t>(id);
  result.type = type;
  result.action = Marker::ADD;
  result.pose.orientation.w = 1;
  return result;
}

Marker plate(const Frame& frame, const ConversionContext& context) {
  const engine::Domain& domain = context.scene.parameters.domain;
  const double s = context.display_length();
  const engine::Vector3d middle = 0.5 * (domain.lower + domain.upper), size = domain.size();
  Marker result = marker("plate", 0, Marker::CUBE, frame);
  result.pose.position =
      point(s * middle.x(), s * middle.y(), s * (context.plate_z() - 0.5 * kPlateThickness));
  result.scale.x = s * size.x();
  result.scale.y = s * size.y();
  result.scale.z = s * kPlateThickness;
  result.color = color(0.16, 0.2, 0.24);
  return result;
}

Marker pad(const chip::Electrode& electrode, double voltage, const Frame& frame,
           const ConversionContext& context) {
  const double s = context.display_length();
  Marker result = marker("electrodes", electrode.channel, Marker::TRIANGLE_LIST, frame);
  result.scale.x = result.scale.y = result.scale.z = 1;
  result.color = voltage_color(voltage, context.scene.electrowetting.max_voltage);
  for (const Eigen::Vector2d& corner : triangulate(electrode.outline)) {
    result.points.push_back(point(s * corner.x(), s * corner.y(), s * (context.plate_z() + kPadHeight)));
  }
  return result;
}

Marker pad_label(const chip::Electrode& electrode, const Frame& frame, const ConversionContext& context) {
  const double s = context.display_length();
  // A third of the pad's height in y, so that digits stay inside; at its lower edge, so that droplets don't
  // hide it.
  double lower = electrode.outline.front().y(), upper = lower;
  for (const Eigen::Vector2d& corner : electrode.outline) {
    lower = std::min(lower, corner.y());
    upper = std::max(upper, corner.y());
  }
  const double height = 0.3 * (upper - lower);
  Marker result = marker("electrode_labels", electrode.channel, Marker::TEXT_VIEW_FACING, frame);
  result.pose.position = point(s * electrode.centroid.x(), s * (lower + 0.5 * height),
                               s * (context.plate_z() + kPadHeight + 0.5 * height));
  result.scale.z = s * height;
  result.color = color(1, 1, 1);
  result.text = std::to_string(electrode.channel);
  return result;
}

std::string angle_text(const char* name, const std::optional<double>& angle) {
  return angle ? fmt::format("{} {:.0f}°", name, *angle) : fmt::format("{} -", name);
}

Marker droplet_label(const engine::DropletObservation& droplet, const Frame& frame,
                     const ConversionContext& context) {
  const double s = context.display_length();
  Marker result = marker("droplet_labels", droplet.id, Marker::TEXT_VIEW_FACING, frame);
  result.pose.position =
      point(s * droplet.centroid.x(), s * droplet.centroid.y(), s * (droplet.upper.z() + kLabelGap));
  result.scale.z = s * 2.0;
  result.color = color(1, 1, 1);
  result.text = fmt::format("droplet {}\n{}, {}", droplet.id, angle_text("adv", droplet.advancing_angle),
                            angle_text("rec", droplet.receding_angle));
  return result;
}

Marker beads(const char* name_space, std::uint32_t id, const std_msgs::ColorRGBA& fill, const Frame& frame,
             const ConversionContext& context) {
  Marker result = marker(name_space, id, Marker::SPHERE_LIST, frame);
  result.scale.x = result.scale.y = result.scale.z = kBeadDiameter * context.display_length();
  result.color = fill;
  return result;
}

}  // namespace

MarkerArray chip_markers(const Frame& frame, const ConversionContext& context) {
  MarkerArray array;
  array.markers.push_back(plate(frame, context));
  const auto& electrodes = context.scene.layout.electrodes();
  for (std::size_t i = 0; i < electrodes.size(); ++i) {
    array.markers.push_back(pad(electrodes[i], frame.electrodes.at(i).voltage, frame, context));
    array.markers.push_back(pad_label(electrodes[i], frame, context));
  }
  return array;
}

MarkerArray droplet_markers(const Frame& frame, const ConversionContext& context) {
  const engine::Snapshot& snapshot = *frame.snapshot;
  const double s = context.display_length();
  // The vapour's marker (droplet 0) is always there, empty or not, so that condensed beads leave the screen.
  // RViz complains about an empty list, therefore it is taken off instead.
  std::map<std::uint32_t, Marker> lists;
  lists.emplace(0, beads("vapour", 0, color(1, 1, 1, 0.6), frame, context));
  for (const auto& droplet : snapshot.droplets) {
    lists.emplace(droplet.id, beads("droplets", droplet.id, droplet_color(droplet.id), frame, context));
  }
  for (std::size_t i = 0; i < snapshot.positions.size(); ++i) {
    // The tracker may be a few steps older than the beads: one that it counts to a droplet of the past is
    // vapour.
    auto list = lists.find(snapshot.bead_droplets[i]);
    if (list == lists.end()) list = lists.find(0);
    const Eigen::Vector3f& p = snapshot.positions[i];
    list->second.points.push_back(point(s * p.x(), s * p.y(), s * p.z()));
  }
  MarkerArray array;
  for (auto& [id, list] : lists) {
    if (list.points.empty()) list.action = Marker::DELETE;
    array.markers.push_back(std::move(list));
  }
  for (const auto& droplet : snapshot.droplets) {
    array.markers.push_back(droplet_label(droplet, frame, context));
  }
  return array;
}

MarkerArray deletions(const std::set<std::uint32_t>& droplets, ros::Time stamp) {
  MarkerArray array;
  for (const std::uint32_t id : droplets) {
    for (const char* name_space : {"droplets", "droplet_labels"}) {
      Marker gone;
      gone.header.frame_id = kChipFrame;
      gone.header.stamp = stamp;
      gone.ns = name_space;
      gone.id = static_cast<std::int32_t>(id);
      gone.action = Marker::DELETE;
      gone.pose.orientation.w = 1;
      array.markers.push_back(gone);
    }
  }
  return array;
}

}  // namespace dmf::node
