#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "engine/bodies/rigid_body.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// A sphere that a body touches others with: a spherical microparticle has one, a body of points one a point.
struct ContactSphere {
  Vector3d offset;  ///< from the centre of mass, body frame, r_c
  double radius;    ///< r_c
};

/// Where a body touches a plate or the solid of a label grid.
struct WallContact {
  Vector3d arm;         ///< from the centre of mass to the point of contact, chip frame, r_c
  Vector3d normal;      ///< out of the wall, of length 1
  double radius;        ///< of the sphere that touches, r_c
  double normal_force;  ///< k_BT / r_c, > 0
  Vector3d velocity;    ///< of the wall, in its plane, r_c / tau
};

/// Coefficients of friction between a body and the wall.
struct Friction {
  double static_limit;  ///< f_s
  double kinetic;       ///< f_k <= f_s
  double rolling;       ///< f_r
};

/// What friction did to a body in one step.
struct FrictionReport {
  Vector3d force = Vector3d::Zero();    ///< of all walls, mean over the step, in their planes
  Vector3d rolling = Vector3d::Zero();  ///< velocity of the centre that comes from turning (lan2016 only)
};

/// Force of Hertz's law on a rigid sphere that indents an elastic half-space (Lan 3.1):
///   F = 4/3 E sqrt(R) d^(3/2),  d > 0 the indentation.
/// Against a second sphere R is 1 / (1/R_1 + 1/R_2).
double hertz_force(double elastic_modulus, double radius, double indentation);

/// Hertz's force with a damping in parallel that is `damping` times the critical one of the contact's present
/// stiffness k = 2 E sqrt(R d): -2 damping sqrt(m k) times the speed at which the indentation shrinks. It
/// never pulls. @param parting  speed at which the surfaces part, r_c / tau.
double damped_hertz_force(double elastic_modulus, double radius, double indentation, double mass,
                          double damping, double parting);

/// The largest E for which a contact that carries `load` is followed by `time_step`: its angular frequency
/// sqrt(k / m), with the stiffness k = dF/dd of Hertz's law under that load, times time_step stays below 0.5
/// (velocity-Verlet is stable up to 2; Lan's contact, E = 1e6, has 0.13). k_BT / r_c^3.
double largest_elastic_modulus(double mass, double radius, double load, double time_step);

/// What a wall of fcc layers attracts a sphere of evenly spread beads with that touches it, all sums taken as
/// integrals: the load of its contact. k_BT / r_c.
double wall_adhesion(double attraction, double radius, double beads_per_area, const WallParameters& wall);

/// The same for a disc with beads around it and a wall of two dimensions, a row of beads each layer.
double wall_adhesion_of_disc(double attraction, double radius, double beads_per_length,
                             const WallParameters& wall);

/// Takes friction's impulse of one step from a body that moves as if it were free (velocity and angular
/// momentum after the kick). Friction can stop what moves on a wall; it never turns it round. Velocities are
/// relative to the wall's.
///
/// lan2016 (Lan 3.1.3, 3.1.4): sliding friction f F_normal slows the centre and makes no torque; rolling
/// friction, f_r F_normal on the arm R, slows the turning about axes in the wall; what turns also rolls: the
/// centre moves on by R times the angle, besides its own velocity. Where it touches more than one wall, it
/// rolls on the first.
///
/// coulomb: friction acts at the point of contact, against the velocity there, up to the impulse that stops
/// it; so it makes a torque, and a sphere that rolls without sliding feels none. Rolling friction as above.
FrictionReport apply_friction(ContactModel model, const Friction& friction,
                              const std::vector<WallContact>& contacts, double time_step, RigidBody& body);

}  // namespace dmf::engine
