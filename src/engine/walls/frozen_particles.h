#pragma once
#include <vector>

#include "engine/beads.h"
#include "engine/pair_law.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// Sides of instantaneous frozen particles (boundary_parameters.h; Ranjith, Patnaik and Vedantam 2013, told
/// in Lan 2.2.2). With h a bead's distance from the side, n the side's inward normal, v its velocity relative
/// to the side and v_t the part of it along the side, the force on the bead is
///
///   [A w(h/r_c) + B rho w(h/r_d)  -  gamma w_D(h) (n . v)  +  phi w_R(h) zeta_n / sqrt(dt)] n
///   - gamma_l w_D(h) v_t  +  phi_l w_R(h) zeta_t / sqrt(dt),    phi_l^2 = 2 gamma_l k_BT
///
/// with zeta_t two numbers of their own: every component has fluctuation and dissipation in balance. The
/// first line is the law of two beads of the liquid, with a rho of the other that is 0, as of a wall's bead.
/// A liquid of density rho at rest has the friction rho gamma_l r_D / (s + 1) an area with the side, which
/// over its viscosity is Navier's slip length when that is long against r_c.
///
/// Nothing is kept and nothing looked up: a run without such sides has none of it.
class FrozenParticles {
 public:
  explicit FrozenParticles(const Parameters& parameters);
  bool needed() const { return !sides_.empty(); }

  /// Adds one part of the forces, or all; as Forces::force().
  void add_forces(PairForce part, const Beads& beads, AlignedVector<Record>& to) const;

 private:
  struct Facing {
    int axis;
    bool upper;
    float plane;
    float velocity[3];
  };
  template <class Law>
  void add_with(const Law& law, PairForce part, const Beads& beads, AlignedVector<Record>& to) const;

  std::vector<Facing> sides_;
  MdpdLaw<double> law_;
  SplineShape<double> shape_;
  bool spline_, flat_;
  double lateral_friction_;  ///< gamma_l
  double lateral_random_;    ///< phi_l / sqrt(dt)
};

}  // namespace dmf::engine
