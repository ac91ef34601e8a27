#pragma once
#include <limits>
#include <string>
#include <vector>

#include "engine/parameters.h"

namespace dmf::engine {

/// How the force between two bonded beads grows with their distance.
enum class SpringKind {
  harmonic,  ///< U = k/2 (r - r_0)^2
  wlc,       ///< worm-like chain, Marko and Siggia 1995 (Liu eq. 26)
  fene       ///< finitely extendable nonlinear elastic (Liu eq. 27)
};

/// A spring between two beads as it is asked for. Reduced units. Each kind has its own numbers; the others do
/// not count.
struct Spring {
  SpringKind kind = SpringKind::harmonic;
  double stiffness = 100;         ///< harmonic: k, fene: H; k_BT / r_c^2; (0, 1e6]
  double length = 0.5;            ///< harmonic: r_0, at rest, r_c; [0, 100]
  double max_length = 1;          ///< wlc: l, fene: r_m, r_c; (0, 100]
  double persistence_length = 1;  ///< wlc: lambda_p, r_c; (0, 1e6]
};

/// Every number that is out of its range, as "spring.key: value, allowed: range".
std::vector<std::string> violations(const Spring& spring);

/// The law of a spring as the forces use it. tension() = dU/dr; above 0 it pulls the beads together.
///
///   harmonic  U = k/2 (r - r_0)^2                           T = k (r - r_0)
///   wlc       U = a l [1/(1-x) - 1 - x + 2 x^2] + c / r     T = a [(1-x)^-2 - 1 + 4 x] - c / r^2
///   fene      U = -H r_m^2 / 2 ln(1 - x^2)                  T = H r / (1 - x^2)
///
/// with x = r / l or r / r_m and a = k_BT / (4 lambda_p). Liu's eq. 26 and 27 have the signs of forces. The
/// repulsion c / r of the worm-like chain is that of membranes, Fedosov et al. 2010, Biophys. J. 98, 2215,
/// eq. 4 with m = 2: it gives a net of such springs a length at rest. Chains have none.
struct SpringLaw {
  SpringKind kind = SpringKind::harmonic;
  double stiffness = 0;  ///< k; H; a
  double length = 0;     ///< r_0; r_m; l
  double repulsion = 0;  ///< c, of wlc

  /// @param temperature  k_BT, of a worm-like chain.
  static SpringLaw of(const Spring& spring, double temperature);
  /// A worm-like chain with repulsion that is at rest at `rest`, has the stiffness T' there, and reaches up
  /// to `max_over_rest` times that.
  static SpringLaw worm_like_with_repulsion(double rest, double stiffness, double max_over_rest);

  double tension(double r) const;
  double energy(double r) const;
  double slope(double r) const;  ///< T' = U'', k_BT / r_c^2
  /// That a bond can never reach; infinite for a harmonic spring, r_c.
  double max_length() const {
    return kind == SpringKind::harmonic ? std::numeric_limits<double>::infinity() : length;
  }
  double rest_length() const;  ///< of least energy
  /// The longest bond whose energy is up to `energy` over that at rest, r_c.
  double reach(double energy) const;
};

/// A spring may be as stiff as this many k_BT of stretch make it when a step is held against it: a bond gets
/// there once in e^8 = 3000 chances.
constexpr double spring_reach_energy = 8.0;
/// Fastest oscillation in a time step, omega dt: the mean square length of a bond is off by about a quarter
/// of its square, 6 %.
constexpr double largest_phase_step = 0.5;

}  // namespace dmf::engine
