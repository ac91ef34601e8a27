#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/boundary_parameters.h"
#include "engine/mixture.h"
#include "engine/spline.h"
#include "engine/walls/label_grid.h"
#include "yaml/invalid_input.h"

namespace dmf::engine {

using Eigen::Vector3d;

using dmf::InvalidInput;

/// All in reduced units: lengths in r_c, masses in m, energies in k_BT, times in tau. Defaults are Lan's
/// table 2.2.

struct LiquidParameters {
  double attraction = -40.0;        ///< A_ll; (-200, 0). With B_ll = 0 plain DPD's repulsion a; [0, 200]
  double repulsion = 25.0;          ///< B_ll, also used with the wall (B_lw); (0, 500), or 0: plain DPD
  double cutoff_radius = 1.0;       ///< r_c, range of attraction; fixed at 1, it is the unit
  double repulsion_radius = 0.75;   ///< r_d, range of the many-body repulsion and of its density; (0.3, 1]
  double random_amplitude = 6.0;    ///< phi; phi^2 = 2 gamma k_BT, so gamma = 18; [0, 50]
  double dissipation_exponent = 2;  ///< s in w_D = (1 - r/r_D)^s (Liu eq. 8); multiples of 1/2 from 1/2 to 4
  double dissipation_radius = 1;    ///< r_D, range of friction and noise; [0.5, 2.5]
  double temperature = 1.0;         ///< k_BT; (0, 10]
  double initial_density = 6.0;     ///< beads per r_c^3 when a droplet is placed; [1, 12]

  // What the numbers above lead to, measured (`dmf_study liquid`). They enter no force: volumes and
  // half-density surfaces are reported with the density, SI units derived with density and tension, and
  // dmf_run --explain uses all three.
  double bulk_density = 6.06;     ///< of the liquid at rest, beads per r_c^3; [1, 20]
  double surface_tension = 7.54;  ///< k_BT / r_c^2; (0, 1000]
  double viscosity = 8.2;         ///< dynamic, m / (r_c tau); (0, 1000]
  /// That liquid of bulk density seems to keep from a plate, r_c; [0, 1]. It is 0.0 at 70 degrees, 0.17 at
  /// 110 and 0.28 at 130 (`dmf_study plates`).
  double wall_distance = 0.2;

  /// How far one bead feels another, r_c.
  double range() const { return std::max(cutoff_radius, dissipation_radius); }
};

struct WallParameters {
  double lattice_constant = 0.874;  ///< of the fcc(100) layers: 4 / a^3 = 6 beads per r_c^3; [0.5, 1.5]
  int layers = 3;  ///< half a lattice constant apart, the first one on the wall plane; [1, 8]
  double top_contact_angle = 110.0;  ///< that all of a top plate shows, degrees; within the calibration
  /// A_lw of all wall beads in place of contact angles, such as plain DPD's repulsion a_lw; [-200, 200]
  std::optional<double> attraction;
};

/// What closes one side of the box.
enum class Side {
  periodic,    ///< joined to the opposite side; both must be periodic
  reflecting,  ///< plane without beads that sends beads back: keeps stray ones in the domain
  wall,        ///< such a plane on the first layer of frozen beads that wet. Only z sides: the lower one, and
               ///< over it the upper one, a top plate
};

struct Domain {
  Vector3d lower{-75, -35, -10};  ///< r_c; each side 3 to 4000 long
  Vector3d upper{75, 35, 10};
  std::array<Side, 3> lower_side{Side::reflecting, Side::reflecting, Side::wall};
  std::array<Side, 3> upper_side{Side::reflecting, Side::reflecting, Side::reflecting};

  Vector3d size() const { return upper - lower; }
  bool periodic(int axis) const { return lower_side[axis] == Side::periodic; }
  bool has_wall() const { return lower_side[2] == Side::wall; }
  bool has_top_plate() const { return upper_side[2] == Side::wall; }
  /// The shortest of a distance and its periodic images.
  Vector3d nearest_image(Vector3d d) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double period = size()[axis];
      // Most distances are their own nearest image, and asking costs less than dividing.
      if (std::abs(d[axis]) > 0.5 * period && periodic(axis))
        d[axis] -= period * std::nearbyint(d[axis] / period);
    }
    return d;
  }
  bool contains(const Vector3d& p) const {
    return (p.array() >= lower.array()).all() && (p.array() <= upper.array()).all();
  }
};

/// How a step goes from forces to positions (docs/physics.md compares them).
enum class Integrator {
  groot_warren,  ///< Groot and Warren's modified velocity-Verlet (1997)
  baoab,         ///< splitting, Leimkuhler and Matthews (2013): good up to a time step of 0.03
};

/// How friction acts on a microparticle that touches the wall (docs/physics.md).
enum class ContactModel {
  lan2016,  ///< Lan 3.1.3-3.1.4: friction slows the centre without turning it, and what turns also rolls on
  coulomb,  ///< friction acts at the point of contact: it slows the centre and turns the body
};

/// What all microparticles share. Defaults are Lan's table 3.2.
struct MicroparticleParameters {
  ContactModel contact = ContactModel::lan2016;
  double elastic_modulus = 1e6;    ///< E of Hertz's law, k_BT / r_c^3; above 0, limited by time_step
  double contact_damping = 0.0;    ///< of Hertz's contact with the wall, of the critical one; [0, 2]
  double wall_attraction = -1.0;   ///< A_sw of each of its beads and wall bead; [-200, 0]
  double liquid_repulsion = 3.0;   ///< B_ls; (0, 500]
  double particle_adhesion = 0.0;  ///< force that holds two touching microparticles of radius 1; [0, 1e6]
  // What counts in the densities of the many-body law is not stated in the paper; docs/physics.md compares.
  bool counts_own_beads = true;   ///< a body's beads count each other
  bool counts_liquid = true;      ///< a body's beads count the liquid
  bool counted_by_liquid = true;  ///< the liquid counts a body's beads
};

/// What a run must not do; it is stopped when it does (observe/watchdog.h).
struct WatchdogParameters {
  double lowest_temperature = 0.5;   ///< kinetic, of liquid.temperature; [0, 1)
  double highest_temperature = 2.0;  ///< (1, 100]
  double evaporation = 0.2;          ///< of a droplet's beads that may be vapour; (0, 1], 1: all
  std::uint32_t leak = 0;            ///< liquid beads that may be deep in a microparticle; [0, 1e6]
};

struct Parameters {
  LiquidParameters liquid;
  WallParameters wall;
  LabelGridParameters label_grid;
  MicroparticleParameters microparticles;
  Domain domain;
  BoundaryParameters boundaries;
  /// Of space; 2: all beads stay in the plane half-way between the y sides, and densities are per r_c^2.
  int dimensions = 3;
  double time_step = 0.01;  ///< Delta t, tau; (0, 0.1]
  Integrator integrator = Integrator::groot_warren;
  double integrator_lambda = 0.55;  ///< of groot_warren; [0.5, 1]. Their 0.65 leaves this liquid 2 % cold
  double list_skin = 0.25;          ///< cells are wider than r_c by this: a matter of speed, r_c; [0.05, 1]
  std::uint64_t seed = 1;           ///< of all randomness
  std::uint32_t observe_interval = 50;  ///< steps between two looks of the droplet tracker; [1, 100000]
  double angle_window = 20.0;           ///< memory of the running contact angle measurement, tau; [0, 1e4]
  std::uint64_t max_beads = 4'000'000;  ///< moving beads a run may hold; [1, 100e6]
  double max_memory = 4000;             ///< that the run may take (memory.h), MB; [10, 1e6]
  WatchdogParameters watchdog;
  MixtureParameters mixture;  ///< liquids beside `liquid`
  SplineParameters spline;    ///< Liu's conservative force

  /// Whether nothing moves along an axis.
  bool flat(int axis) const { return dimensions == 2 && axis == 1; }
  /// y of the plane that all is in, with two dimensions.
  double plane() const { return 0.5 * (domain.lower.y() + domain.upper.y()); }
};

/// All violated ranges, each as "key: value, allowed: range". Empty when the parameters are sound.
std::vector<std::string> violations(const Parameters& parameters);

}  // namespace dmf::engine
