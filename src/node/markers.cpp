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

constexpr float kMembraneOpacity = 0.6f;
constexpr float kSeeThrough = 0.25f;  // opacity of a droplet with something inside

// Lengths in r_c.
constexpr double kPlateThickness = 1.0;
constexpr double kTopPlateThickness = 0.3;
constexpr double kPadHeight = 0.05;    // above the plate, so that neither flickers through the other
constexpr double kBeadDiameter = 0.8;  // beads of a dense liquid just touch: it shows as a closed surface
constexpr double kBondWidth = 0.2;
constexpr double kLabelGap = 2.0;  // from the top of a droplet to its label

std_msgs::ColorRGBA color(double r, double g, double b, double a = 1) {
  std_msgs::ColorRGBA result;
  result.r = static_cast<float>(r);
  result.g = static_cast<float>(g);
  result.b = static_cast<float>(b);
  result.a = static_cast<float>(a);
  return result;
}

const std_msgs::ColorRGBA kDisabledPad = color(0.1, 0.1, 0.11);
const std_msgs::ColorRGBA kAlarm = color(1, 0.3, 0.25);

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

/// Of a liquid beside the first one: its own, whichever droplet, and so that what is in it shows.
std_msgs::ColorRGBA medium_color(std::uint32_t species) {
  std_msgs::ColorRGBA result = droplet_color(species + 2);
  result.a = kSeeThrough;
  return result;
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
  const std::string liquid =
      droplet.species == 0 ? "" : " of " + liquid_name(context.scene.parameters, droplet.species);
  result.text =
      fmt::format("droplet {}{}\n{}, {}", droplet.id, liquid, angle_text("adv", droplet.advancing_angle),
                  angle_text("rec", droplet.receding_angle));
  return result;
}

/// Amber where it repels the liquid, teal where it attracts it as the liquid itself does. By Young's law with
/// works of adhesion in proportion to the attractions, cos theta is near 2 A_ls / A_ll - 1.
std_msgs::ColorRGBA wetting_color(double attraction, double liquid_attraction) {
  const double f = std::clamp(attraction / liquid_attraction, 0.0, 1.0);
  return color(0.95 - 0.9 * f, 0.62 - 0.07 * f, 0.1 + 0.5 * f);
}

/// A marker that moves and turns with a microparticle.
Marker riding_on(const engine::MicroparticleObservation& body, int type, const Frame& frame,
                 const ConversionContext& context) {
  const double s = context.display_length();
  Marker result = marker("microparticles", body.id, type, frame);
  result.pose.position = point(s * body.position.x(), s * body.position.y(), s * body.position.z());
  result.pose.orientation.x = body.orientation.x();
  result.pose.orientation.y = body.orientation.y();
  result.pose.orientation.z = body.orientation.z();
  result.pose.orientation.w = body.orientation.w();
  return result;
}

/// A body of points as their spheres, every other one in the second colour.
Marker cluster(const engine::MicroparticleObservation& body, const Frame& frame,
               const ConversionContext& context) {
  const double s = context.display_length();
  Marker result = riding_on(body, Marker::SPHERE_LIST, frame, context);
  result.scale.x = result.scale.y = result.scale.z = 2 * s * body.point_radius;
  result.color = wetting_color(body.attraction, context.scene.parameters.liquid.attraction);
  for (const Eigen::Vector3d& at : *body.points) {
    result.points.push_back(point(s * at.x(), s * at.y(), s * at.z()));
    const bool second = body.magnetic && result.points.size() % 2 == 0;
    result.colors.push_back(second ? color(0.8, 0.1, 0.1) : result.color);
  }
  return result;
}

/// A beach ball around the origin: stripes from pole (+z) to pole, two colours by turns.
Marker ball(const engine::MicroparticleObservation& body, const Frame& frame,
            const ConversionContext& context) {
  constexpr int kMeridians = 24, kParallels = 12, kPerStripe = 4;
  constexpr double kPi = 3.14159265358979323846;
  const double s = context.display_length();
  Marker result = riding_on(body, Marker::TRIANGLE_LIST, frame, context);
  result.scale.x = result.scale.y = result.scale.z = 1;
  const std_msgs::ColorRGBA wetting =
      wetting_color(body.attraction, context.scene.parameters.liquid.attraction);
  const std_msgs::ColorRGBA magnet = body.magnetic ? color(0.8, 0.1, 0.1) : color(0.95, 0.95, 0.95);
  result.color = wetting;

  const double r = s * body.radius;
  const auto corner = [r](int parallel, int meridian) {  // from the north pole, eastwards
    const double polar = kPi * parallel / kParallels, east = 2 * kPi * meridian / kMeridians;
    return point(r * std::sin(polar) * std::cos(east), r * std::sin(polar) * std::sin(east),
                 r * std::cos(polar));
  };
  const auto add = [&result](const std_msgs::ColorRGBA& fill, const auto&... corners) {
    (result.points.push_back(corners), ...);
    for (std::size_t i = 0; i < sizeof...(corners); ++i) result.colors.push_back(fill);
  };
  for (int m = 0; m < kMeridians; ++m) {
    const std_msgs::ColorRGBA& fill = m / kPerStripe % 2 == 0 ? wetting : magnet;
    for (int p = 0; p < kParallels; ++p) {
      // Counter-clockwise seen from outside; at the poles one of both triangles has no area.
      const auto north_west = corner(p, m), south_west = corner(p + 1, m);
      const auto north_east = corner(p, m + 1), south_east = corner(p + 1, m + 1);
      if (p + 1 < kParallels) add(fill, north_west, south_west, south_east);
      if (p > 0) add(fill, north_west, south_east, north_east);
    }
  }
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

MarkerArray droplet_markers(const Frame& frame, const ConversionContext& context) {
  const engine::Snapshot& snapshot = *frame.snapshot;
  const double s = context.display_length();
  // The vapour's marker (droplet 0) is always there, empty or not, so that condensed beads leave the screen.
  // RViz complains about an empty list, therefore it is taken off instead.
  std::map<std::uint32_t, Marker> lists;
  lists.emplace(0, beads("vapour", 0, color(1, 1, 1, 0.6), frame, context));
  std::set<std::uint32_t> carrying;
  for (const auto& body : snapshot.microparticles) carrying.insert(body.droplet);
  for (const auto& droplet : snapshot.droplets) {
    std_msgs::ColorRGBA fill =
        droplet.species == 0 ? droplet_color(droplet.id) : medium_color(droplet.species);
    if (carrying.count(droplet.id)) fill.a = kSeeThrough;
    lists.emplace(droplet.id, beads("droplets", droplet.id, fill, frame, context));
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

MarkerArray microparticle_markers(const Frame& frame, const ConversionContext& context) {
  MarkerArray array;
  for (const auto& body : frame.snapshot->microparticles) {
    array.markers.push_back(body.points ? cluster(body, frame, context) : ball(body, frame, context));
  }
  return array;
}

MarkerArray bond_markers(const Frame& frame, const ConversionContext& context) {
  const double s = context.display_length();
  const auto scaled = [s](const engine::Vector3d& p) { return point(s * p.x(), s * p.y(), s * p.z()); };
  MarkerArray array;
  if (!frame.snapshot->chains.empty()) {
    Marker lines = marker("chains", 0, Marker::LINE_LIST, frame);
    lines.scale.x = s * kBondWidth;
    for (const auto& chain : frame.snapshot->chains) {
      const std_msgs::ColorRGBA fill = droplet_color(chain.id);
      for (std::size_t k = 0; k + 1 < chain.positions.size(); ++k) {
        lines.points.push_back(scaled(chain.positions[k]));
        lines.points.push_back(scaled(chain.positions[k + 1]));
        lines.colors.insert(lines.colors.end(), 2, fill);
      }
    }
    lines.color = color(1, 1, 1);
    array.markers.push_back(std::move(lines));
  }
  for (const auto& membrane : frame.snapshot->membranes) {
    Marker surface = marker("membranes", membrane.id, Marker::TRIANGLE_LIST, frame);
    surface.scale.x = surface.scale.y = surface.scale.z = 1;
    surface.color = droplet_color(membrane.id);
    surface.color.a = kMembraneOpacity;
    for (const auto& triangle : membrane.mesh->triangles)
      for (const std::uint32_t vertex : triangle)
        surface.points.push_back(scaled(membrane.positions[vertex]));
    array.markers.push_back(std::move(surface));
  }
  return array;
}

namespace {

Marker gone(const char* name_space, std::uint32_t id, ros::Time stamp) {
  Marker result;
  result.header.frame_id = kChipFrame;
  result.header.stamp = stamp;
  result.ns = name_space;
  result.id = static_cast<std::int32_t>(id);
  result.action = Marker::DELETE;
  result.pose.orientation.w = 1;
  return result;
}

}  // namespace

MarkerArray deletions(const std::set<std::uint32_t>& droplets, const std::set<std::uint32_t>& microparticles,
                      ros::Time stamp) {
  MarkerArray array;
  for (const std::uint32_t id : droplets) {
    array.markers.push_back(gone("droplets", id, stamp));
    array.markers.push_back(gone("droplet_labels", id, stamp));
  }
  for (const std::uint32_t id : microparticles) array.markers.push_back(gone("microparticles", id, stamp));
  return array;
}

MarkerArray bond_deletions(bool chains, const std::set<std::uint32_t>& membranes, ros::Time stamp) {
  MarkerArray array;
  if (chains) array.markers.push_back(gone("chains", 0, stamp));
  for (const std::uint32_t id : membranes) array.markers.push_back(gone("membranes", id, stamp));
  return array;
}

}  // namespace dmf::node
