#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "node/marker_parts.h"
#include "node/markers.h"
#include "node/triangulate.h"

// The chip itself: plates, solid, electrodes and the rail.

namespace dmf::node {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

// Lengths in r_c.
constexpr double kPlateThickness = 1.0;
constexpr double kTopPlateThickness = 0.3;
constexpr double kPadHeight = 0.05;  // above the plate, so that neither flickers through the other

const std_msgs::ColorRGBA kDisabledPad = color(0.1, 0.1, 0.11);
const std_msgs::ColorRGBA kAlarm = color(1, 0.3, 0.25);

/// Grey without voltage to orange at the board's limit.
std_msgs::ColorRGBA voltage_color(double voltage, double max_voltage) {
  const double f = std::clamp(std::abs(voltage) / max_voltage, 0.0, 1.0);
  return color(0.5 + 0.5 * f, 0.5 + 0.05 * f, 0.52 - 0.47 * f);
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

/// Glass, thin enough to look under.
Marker top_plate(const Frame& frame, const ConversionContext& context) {
  Marker result = plate(frame, context);
  result.ns = "top_plate";
  result.scale.z = context.display_length() * kTopPlateThickness;
  result.pose.position.z =
      context.display_length() * context.scene.parameters.domain.upper.z() + 0.5 * result.scale.z;
  result.color = color(0.7, 0.85, 1.0, 0.12);
  return result;
}

/// The solid of a label grid: its voxels next to fluid ones, see-through, for liquid may be behind them.
Marker solid(const Frame& frame, const ConversionContext& context) {
  const engine::LabelGrid& grid = *context.scene.parameters.label_grid.grid;
  const double s = context.display_length();
  const auto is_fluid = [&grid](int x, int y, int z) {
    const bool inside =
        x >= 0 && x < grid.voxels[0] && y >= 0 && y < grid.voxels[1] && z >= 0 && z < grid.voxels[2];
    return inside && grid.labels[grid.index(x, y, z)] == engine::LabelGrid::fluid;
  };
  Marker result = marker("solid", 0, Marker::CUBE_LIST, frame);
  result.scale.x = s * grid.voxel_size.x();
  result.scale.y = s * grid.voxel_size.y();
  result.scale.z = s * grid.voxel_size.z();
  result.color = color(0.55, 0.5, 0.45, 0.6);
  for (int z = 0; z < grid.voxels[2]; ++z)
    for (int y = 0; y < grid.voxels[1]; ++y)
      for (int x = 0; x < grid.voxels[0]; ++x) {
        if (grid.labels[grid.index(x, y, z)] == engine::LabelGrid::fluid) continue;
        if (!is_fluid(x - 1, y, z) && !is_fluid(x + 1, y, z) && !is_fluid(x, y - 1, z) &&
            !is_fluid(x, y + 1, z) && !is_fluid(x, y, z - 1) && !is_fluid(x, y, z + 1))
          continue;
        const engine::Vector3d middle =
            s * (grid.origin + grid.voxel_size.cwiseProduct(engine::Vector3d(x + 0.5, y + 0.5, z + 0.5)));
        result.points.push_back(point(middle.x(), middle.y(), middle.z()));
      }
  return result;
}

Marker pad(const chip::Electrode& electrode, const chip::ElectrodeState& state, const Frame& frame,
           const ConversionContext& context) {
  const double s = context.display_length();
  Marker result = marker("electrodes", electrode.channel, Marker::TRIANGLE_LIST, frame);
  result.scale.x = result.scale.y = result.scale.z = 1;
  // A disabled channel that is stuck on still has a voltage, which is what matters to the liquid.
  result.color = state.disabled && state.voltage == 0
                     ? kDisabledPad
                     : voltage_color(state.voltage, context.scene.electrowetting.max_voltage);
  for (const Eigen::Vector2d& corner : triangulate(electrode.outline)) {
    result.points.push_back(point(s * corner.x(), s * corner.y(), s * (context.plate_z() + kPadHeight)));
  }
  return result;
}

Marker pad_label(const chip::Electrode& electrode, const chip::ElectrodeState& state, const Frame& frame,
                 const ConversionContext& context) {
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
  result.color = state.disabled ? kAlarm : color(1, 1, 1);
  result.text = std::to_string(electrode.channel);
  return result;
}

/// What the board's own display would show, in front of the plate.
Marker rail_label(const Frame& frame, const ConversionContext& context) {
  const engine::Domain& domain = context.scene.parameters.domain;
  const chip::RailState& rail = frame.rail;
  const double s = context.display_length();
  const double height = std::clamp(0.04 * domain.size().x(), 1.0, 6.0);  // r_c
  Marker result = marker("rail", 0, Marker::TEXT_VIEW_FACING, frame);
  result.pose.position = point(s * 0.5 * (domain.lower.x() + domain.upper.x()),
                               s * (domain.lower.y() - 1.5 * height), s * context.plate_z());
  result.scale.z = s * height;
  result.color = rail.halted.empty() ? color(1, 1, 1) : kAlarm;
  result.text = !rail.halted.empty() ? "rail halted: " + rail.halted
                : rail.enabled       ? fmt::format("rail {:g} V, {:g} Hz", rail.voltage, rail.frequency)
                                     : std::string("rail off");
  return result;
}

}  // namespace

MarkerArray chip_markers(const Frame& frame, const ConversionContext& context) {
  MarkerArray array;
  array.markers.push_back(plate(frame, context));
  if (context.scene.parameters.domain.has_top_plate()) array.markers.push_back(top_plate(frame, context));
  if (context.scene.parameters.label_grid.grid) array.markers.push_back(solid(frame, context));
  const auto& electrodes = context.scene.layout.electrodes();
  for (std::size_t i = 0; i < electrodes.size(); ++i) {
    array.markers.push_back(pad(electrodes[i], frame.electrodes.at(i), frame, context));
    array.markers.push_back(pad_label(electrodes[i], frame.electrodes.at(i), frame, context));
  }
  if (!electrodes.empty()) array.markers.push_back(rail_label(frame, context));
  return array;
}

}  // namespace dmf::node
