#include "engine/bodies/rigid_body.h"

namespace dmf::engine {

void RigidBody::turn(double time) {
  const auto about = [this](int axis, double part_of_time) {
    const double rate = (orientation.conjugate() * angular_momentum)[axis] / inertia[axis];
    const double half_angle = 0.5 * rate * part_of_time;
    // tan of half the angle, by its series: a step turns by a thousandth. A truncated tangent is still a
    // rotation, by an angle that is off by its seventh power.
    const double squared = half_angle * half_angle;
    const double tangent = half_angle * (1.0 + squared * (1.0 / 3.0 + squared * (2.0 / 15.0)));
    Eigen::Quaterniond turned(1, 0, 0, 0);
    turned.vec()[axis] = tangent;
    orientation = (orientation * turned).normalized();
  };
  about(2, 0.5 * time);
  about(1, 0.5 * time);
  about(0, time);
  about(1, 0.5 * time);
  about(2, 0.5 * time);
}

}  // namespace dmf::engine
