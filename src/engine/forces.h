#pragma once
#include <string>

#include "engine/beads.h"
#include "engine/bodies/microparticles.h"
#include "engine/kernels/kernels.h"
#include "engine/pairs.h"
#include "engine/parameters.h"
#include "engine/walls/frozen_particles.h"
#include "engine/walls/walls.h"

namespace dmf::engine {

/// Everything that pushes a bead. Two passes over the neighbours, because the many-body force needs all
/// densities.
class Forces {
 public:
  /// @param kernel  "auto", one of available_kernels(). @throws InvalidInput otherwise.
  Forces(const Parameters& parameters, const std::string& kernel);

  /// rho of every bead, and who is in range now.
  void density(Beads& beads, const Walls& wall, Microparticles& bodies, Pairs& pairs) const;
  /// Forces of every bead; needs density().
  void force(Beads& beads, const Walls& wall, Microparticles& bodies, Pairs& pairs) const;
  /// One part of the liquid's: `to` gets the sums. Random forces need who is in range (density()) and keys,
  /// friction besides the velocities in `beads.predicted`.
  void force(PairForce part, AlignedVector<Record>& to, Beads& beads, const Walls& wall,
             Microparticles& bodies, Pairs& pairs) const;

  const Kernels& kernels() const { return kernels_; }
  const std::string& kernel_name() const { return kernel_name_; }

 private:
  PairPass pass_over(Beads& beads, const Walls& wall, Microparticles& bodies) const;
  /// Of the liquid. @pre images are in place.
  void sum(PairForce part, AlignedVector<Record>& to, Beads& beads, const Walls& wall, Microparticles& bodies,
           const Pairs& pairs) const;

  Kernels kernels_;
  std::string kernel_name_;
  PairPass constants_;
  AlignedVector<LawRow> rows_;  ///< of a mixture
  MicroparticleRow microparticle_row_;
  FrozenParticles frozen_particles_;
};

}  // namespace dmf::engine
