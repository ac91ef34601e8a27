#pragma once
#include <visualization_msgs/Marker.h>

#include <cstdint>

#include "node/convert.h"
#include "node/frame.h"

/// What markers of all kinds are made from.
namespace dmf::node {

/// Each of 0 to 1; a: opacity.
inline std_msgs::ColorRGBA color(double r, double g, double b, double a = 1) {
  std_msgs::ColorRGBA result;
  result.r = static_cast<float>(r);
  result.g = static_cast<float>(g);
  result.b = static_cast<float>(b);
  result.a = static_cast<float>(a);
  return result;
}

inline geometry_msgs::Point point(double x, double y, double z) {
  geometry_msgs::Point result;
  result.x = x;
  result.y = y;
  result.z = z;
  return result;
}

/// One to fill in: in the chip's frame, at its origin, of the frame's time.
inline visualization_msgs::Marker marker(const char* name_space, std::uint32_t id, int type,
                                         const Frame& frame) {
  visualization_msgs::Marker result;
  result.header.frame_id = kChipFrame;
  result.header.stamp = to_ros_time(frame.stamp);
  result.ns = name_space;
  result.id = static_cast<std::int32_t>(id);
  result.type = type;
  result.action = visualization_msgs::Marker::ADD;
  result.pose.orientation.w = 1;
  return result;
}

}  // namespace dmf::node
