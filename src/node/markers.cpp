#include "node/markers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "node/marker_parts.h"

// What is on the chip: droplets, microparticles, bonds; and how what is gone leaves the screen.

namespace dmf::node {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr float kMembraneOpacity = 0.6f;
constexpr float kSeeThrough = 0.25f;  // opacity of a droplet with something inside

// Lengths in r_c.
constexpr double kBeadDiameter = 0.8;  // beads of a dense liquid just touch: it shows as a closed surface
constexpr double kBondWidth = 0.2;
constexpr double kLabelGap = 2.0;  // from the top of a droplet to its label

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
  const double s = context.display_length();
  Marker result = riding_on(body, Marker::TRIANGLE_LIST, frame, context);
  result.scale.x = result.scale.y = result.scale.z = 1;
  const std_msgs::ColorRGBA wetting =
      wetting_color(body.attraction, context.scene.parameters.liquid.attraction);
  const std_msgs::ColorRGBA magnet = body.magnetic ? color(0.8, 0.1, 0.1) : color(0.95, 0.95, 0.95);
  result.color = wetting;

  const double r = s * body.radius;
  const auto corner = [r](int parallel, int meridian) {  // from the north pole, eastwards
    const double polar = M_PI * parallel / kParallels, east = 2 * M_PI * meridian / kMeridians;
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
