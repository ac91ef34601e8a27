#pragma once
#include <geometry_msgs/Point.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Vector3.h>

#include <Eigen/Geometry>
#include <limits>
#include <optional>

#include "node/frame.h"

/// What the conversions share.
namespace dmf::node {

using engine::Vector3d;

inline geometry_msgs::Point to_point(const Vector3d& v) {
  geometry_msgs::Point point;
  point.x = v.x();
  point.y = v.y();
  point.z = v.z();
  return point;
}

inline geometry_msgs::Quaternion to_quaternion(const Eigen::Quaterniond& q) {
  geometry_msgs::Quaternion quaternion;
  quaternion.x = q.x();
  quaternion.y = q.y();
  quaternion.z = q.z();
  quaternion.w = q.w();
  return quaternion;
}

inline geometry_msgs::Vector3 to_vector(const Vector3d& v) {
  geometry_msgs::Vector3 vector;
  vector.x = v.x();
  vector.y = v.y();
  vector.z = v.z();
  return vector;
}

inline double or_nan(const std::optional<double>& value) {
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

inline const char* limit_name(Limit limit) {
  switch (limit) {
    case Limit::engine:
      return "engine";
    case Limit::max_steps_per_second:
      return "max_steps_per_second";
    case Limit::paused:
      return "paused";
    case Limit::fault:
      return "fault";
  }
  return "";
}

}  // namespace dmf::node
