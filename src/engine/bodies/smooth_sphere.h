#pragma once
#include "engine/bodies/microparticles.h"
#include "engine/kernels/kernels.h"
#include "engine/pairs.h"

namespace dmf::engine {

/// What an evenly filled shell of beads does to a bead at a distance from its centre: the sums over the
/// shell's beads as integrals. So a sphere can be one bead whose law depends on the distance between surfaces
/// (Lan 5.2.6), with the same A_ls and B_ls, and without the grain of a shell.
///
/// With sigma beads an area on radius R, a bead at distance s from the centre and c = s^2 - R^2,
///   radial force   pi R sigma / s^2  int f(r) (r^2 + c) dr      of a central pair force f
///   density        2 pi R sigma / s  int omega(r) r dr
/// both from r = |s - R| to s + R or the range, whichever is less.
class SmoothShell {
 public:
  SmoothShell(double radius, double beads_per_area, double repulsion_radius);

  /// Sum of (1 - r/range) e over the shell's beads, along the way out. As if that many beads were there.
  double weight(double distance, double range) const;
  /// What the shell counts in the density of a bead there (Lan 2.37, 2.38).
  double density(double distance) const;
  /// What the beads of the shell count of each other.
  double own_density() const;

 private:
  double radius_, beads_per_area_, repulsion_radius_;
};

/// Adds what smooth spheres count in the densities of the liquid around them. After the liquid's density
/// pass.
void add_smooth_densities(const PairPass& pass, const Microparticles& bodies, const Pairs& pairs);

/// Adds what smooth spheres do to the liquid, and writes what liquid and wall do to them. After the liquid's
/// force pass. Friction and noise act along the line of centres, with the number of beads that weight()
/// tells: a smooth sphere slips, nothing turns it.
void add_smooth_forces(const PairPass& pass, const Microparticles& bodies, const Pairs& pairs);

}  // namespace dmf::engine
