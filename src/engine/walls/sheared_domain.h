#pragma once
#include <cmath>

#include "engine/parameters.h"

namespace dmf::engine {

/// The box among its periodic images. Those beyond sheared sides have moved on along x (Lees and Edwards
/// 1972).
struct ShearedDomain {
  Domain domain;
  double offset = 0;  ///< of the image above along x, r_c; any number of periods too much
  double speed = 0;   ///< at which it moves, r_c / tau; 0: no side is sheared

  /// The shortest of a distance and its images.
  Vector3d nearest_image(Vector3d d) const {
    if (speed != 0) d.x() -= offset * std::nearbyint(d.z() / domain.size().z());
    return domain.nearest_image(d);
  }
  /// What to add to a place to find its image in the box.
  Vector3d shift_into(const Vector3d& place) const {
    Vector3d shift = Vector3d::Zero();
    const auto periods = [&](int axis) {
      return std::floor((place[axis] + shift[axis] - domain.lower[axis]) / domain.size()[axis]);
    };
    if (speed != 0) shift.x() = -offset * periods(2);
    for (int axis = 0; axis < 3; ++axis)
      if (domain.periodic(axis)) shift[axis] -= domain.size()[axis] * periods(axis);
    return shift;
  }
  /// The velocity along x that what is shifted so loses with it.
  double velocity_shift(const Vector3d& shift) const {
    return speed == 0 ? 0 : speed * std::nearbyint(shift.z() / domain.size().z());
  }
};

}  // namespace dmf::engine
