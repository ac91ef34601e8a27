#pragma once
#include <Eigen/Geometry>

namespace dmf::engine {

/// Mass, place and motion of a rigid body in double precision. The body frame has its origin at the centre of
/// mass and its axes along the principal axes of inertia.
struct RigidBody {
  double mass = 1;                                     ///< m
  Eigen::Vector3d inertia = Eigen::Vector3d::Ones();   ///< principal moments, m r_c^2, all above 0
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the centre of mass, r_c
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< body frame to chip frame
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< in the chip frame

  Eigen::Vector3d angular_velocity() const { return inverse_inertia_times(angular_momentum); }
  /// I^-1 a, both in the chip frame.
  Eigen::Vector3d inverse_inertia_times(const Eigen::Vector3d& a) const {
    return orientation * (orientation.conjugate() * a).cwiseQuotient(inertia);
  }

  /// Turns freely for `time`. Five turns about principal axes, forth and back (Touma and Wisdom 1994; Miller
  /// et al. 2002): angular momentum is kept exactly, the energy without drift, and time can be reversed. No
  /// sine or cosine, whose last bit depends on the processor.
  void turn(double time);
};

}  // namespace dmf::engine
