#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/parameters.h"

namespace dmf::engine {

/// A microparticle to be placed at rest: a rigid body of beads. Reduced units.
struct MicroparticlePlacement {
  /// r_c. A sphere's centre; for `points` the place of their origin. No z: the sphere rests on the wall.
  Eigen::Vector2d center{0, 0};
  std::optional<double> z;
  double radius = 1.0;  ///< R_s of the sphere, or of each contact sphere of `points`, r_c; [0.5, 20]
  /// Of a spherical shell: 10 (h^2 + h k + k^2) + 2, such as 312, 612, 1242. 0: what comes nearest to the 612
  /// that a sphere of radius 1 has, area for area.
  std::uint32_t beads = 0;
  /// One bead instead of a shell, whose law depends on the distance between surfaces (Lan 5.2.6): cheaper and
  /// without the shell's grain, but it slips: liquid does not turn it. `beads` must be 0 then.
  bool smooth = false;
  /// Any other shape instead of a sphere: beads at these places relative to the origin, r_c. Every point is
  /// the centre of a contact sphere of `radius`.
  std::vector<Vector3d> points;
  std::optional<double> mass;  ///< of the whole body, m; above 0. By default 1 a bead, as Lan has it
  double attraction =
      -15.0;  ///< A_ls; (-200, 0). A calibration (ContactAngleCurve) turns a contact angle into it
  double static_friction = 0.2;            ///< f_s, of F_normal; [0, 10]
  std::optional<double> kinetic_friction;  ///< [0, static_friction]; Lan: equal to static_friction
  double rolling_friction = 0.1;           ///< f_r, of F_normal; [0, 10]
  bool magnetic = false;                   ///< feels BodyForces::magnetic
};

/// Every number of a placement that is out of its range, a shell that could not keep the liquid out, a
/// contact too stiff for the time step: each as "microparticle.key: value, allowed: what would work". What
/// else stands in its way is known only when it is placed.
std::vector<std::string> violations(const MicroparticlePlacement& placement, const Parameters& parameters);

/// Forces that act from afar; all zero until set.
struct BodyForces {
  Vector3d gravity = Vector3d::Zero();   ///< acceleration of all liquid and all microparticles, r_c / tau^2
  Vector3d magnetic = Vector3d::Zero();  ///< force on each magnetic microparticle, k_BT / r_c
};

/// Where a microparticle stands in the droplet that wets it, seen along the droplet's way.
enum class MicroparticlePlace { dry, front, rear, inside };

/// Sums over all steps since the microparticle was placed: what lies between two looks is their difference,
/// divided by the difference of `steps`.
struct MicroparticleTotals {
  std::uint64_t steps = 0;
  std::uint64_t steps_in_contact = 0;          ///< with what is below it: lower plate or a label grid's solid
  double height = 0;                           ///< of the centre over the wall plane, r_c
  double normal_force = 0;                     ///< of what is below it, its part upwards, k_BT / r_c
  Vector3d drive_force = Vector3d::Zero();     ///< of the liquid
  Vector3d friction_force = Vector3d::Zero();  ///< of plates and solid, in their planes
};

/// One microparticle between two steps. Reduced units. Forces are means over the last `observe_interval`
/// steps: from step to step they rattle.
struct MicroparticleObservation {
  std::uint32_t id = 0;  ///< from 1, persistent, never used twice in a run
  double radius = 0;     ///< of the sphere; of a body of points, of the sphere around it
  bool magnetic = false;
  /// Of a body of points: where they are, in its own frame, r_c, and how large. None for a sphere.
  std::shared_ptr<const std::vector<Vector3d>> points;
  double point_radius = 0;
  std::uint32_t beads = 0;
  double mass = 0;
  double attraction = 0;                 ///< A_ls
  Vector3d position = Vector3d::Zero();  ///< of the centre of mass
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Vector3d velocity = Vector3d::Zero();
  Vector3d angular_velocity = Vector3d::Zero();
  double contact_fraction = 0;  ///< of the last steps: how many in contact with what is below it
  double normal_force = 0;
  Vector3d drive_force = Vector3d::Zero();
  Vector3d friction_force = Vector3d::Zero();
  /// How much of the liquid that fits around it is there, 0 (dry) to about 1 (engulfed).
  double immersion = 0;
  std::uint32_t droplet = 0;  ///< that carries it, 0: none
  MicroparticlePlace place = MicroparticlePlace::dry;
  MicroparticleTotals totals;
};

/// A droplet has taken up a microparticle, or has lost it (to the wall, or to a satellite that stays with
/// it).
struct MicroparticleEvent {
  enum class Kind { picked_up, dropped_off } kind;
  std::uint64_t step;
  std::uint32_t microparticle;
  std::uint32_t droplet;
};

}  // namespace dmf::engine
