#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace dmf::engine {

struct Parameters;

/// What a closed side, or the plane of a wall, does with a bead that would leave through it. With n the
/// inward normal and u the side's own velocity:
enum class Reflection {
  bounce_back,     ///< back along its path, v -> 2 u - v: no slip on average
  bounce_forward,  ///< v -> 2 u - v, but the way along the side goes on (Visser 2005; Lan 2.2.2)
  specular,        ///< the normal component turns round: no friction
  maxwellian,      ///< leaves where it came with a velocity drawn from what effuses from a gas at k_BT
  thin_layer,      ///< all beads in a layer on it get a velocity of k_BT away from it, every step (Chen 2.3)
  symmetric,       ///< specular, and mirror images of the beads stand behind it (Lan 2.2.3)
  frozen_particles,  ///< specular, and every bead near it feels a particle at its foot on the side (below)
};

/// Instantaneous frozen particles (Ranjith et al. 2013; Lan 2.2.2): every bead within range of a side feels a
/// particle at the side's nearest place, which moves with the side and is there for this bead alone.
struct FrozenParticleParameters {
  /// A or, of plain DPD, a of a bead and its frozen particle; [-200, 200]. Without one that of two beads of
  /// the liquid
  std::optional<double> attraction;
  /// gamma_l of the motion along the side, m / tau; [0, 1000]. 0: full slip. What moves towards the side has
  /// the liquid's friction
  double lateral_friction = 0;
};

/// What sides are besides closed, periodic or walls of frozen beads. Reduced units.
struct BoundaryParameters {
  std::array<Reflection, 3> lower_reflection{}, upper_reflection{};  ///< where the side is not periodic
  double layer_thickness = 0.1;                                      ///< of thin_layer, r_c; (0, 0.5]
  FrozenParticleParameters frozen_particles;
  /// Of the z sides along x and y, r_c / tau; up to 0.1 r_c in a step.
  Eigen::Vector2d lower_velocity = Eigen::Vector2d::Zero(), upper_velocity = Eigen::Vector2d::Zero();
  /// Lees and Edwards's d u_x / d z over periodic z sides, 1 / tau; up to 0.1 r_c in a step from side to
  /// side.
  double shear_rate = 0;

  bool moving() const { return !lower_velocity.isZero(0) || !upper_velocity.isZero(0); }
  bool has(Reflection reflection) const {
    for (const auto& sides : {lower_reflection, upper_reflection})
      for (const Reflection side : sides)
        if (side == reflection) return true;
    return false;
  }
  bool usual() const {
    return lower_reflection == upper_reflection && upper_reflection == decltype(upper_reflection){};
  }
};

/// What is out of range or does not go together, each as "key: value, allowed: range".
std::vector<std::string> boundary_violations(const Parameters& parameters);

}  // namespace dmf::engine
