#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/chain.h"
#include "engine/parameters.h"

namespace dmf::tools {

/// A surfactant for the many-body liquid (proposed by Lan, 5.2.4): dimers of a head, which the liquid
/// attracts more than itself, and a tail, which it attracts half as much. Adds the species "head" and "tail"
/// with all their pairs. What they have with a wall is what liquid has that shows 90 degrees there. B is that
/// of the liquid for all, so that there is a potential (Warren 2013).
/// @param on_microparticles  attraction of tails with microparticles; without one, each microparticle's A_ls.
/// @pre `parameters` has one liquid, the default one.
void add_surfactant(engine::Parameters& parameters, std::optional<double> on_microparticles = {});
/// Dimers of it, the head first, lying anywhere in a box. @param upper  of the box, r_c.
engine::ChainPlacement surfactant_dimers(std::uint32_t count, const engine::Vector3d& lower,
                                         const engine::Vector3d& upper);

/// A film across a periodic box with dimers at both of its surfaces. Single-threaded; reduced units.
struct SurfactantFilmRun {
  std::uint64_t seed = 1;
  double time_step = 0.01;  ///< tau
  engine::Integrator integrator = engine::Integrator::groot_warren;
  double width = 8, thickness = 8;    ///< of the film, r_c
  double coverage = 1;                ///< dimers per surface, 1 / r_c^2
  bool throughout = false;            ///< placed anywhere in the film; else within 1.5 r_c of a surface
  double settle = 50, measure = 150;  ///< tau
};

struct SurfactantFilmResult {
  double tension = 0;      ///< of one surface, k_BT / r_c^2
  double temperature = 0;  ///< mean, k_BT
  double at_surface = 0;   ///< share of the dimers whose middle is within 1.25 r_c of a surface
  /// Of the dimers at a surface: mean cosine of the way from head to tail with the way out of the liquid.
  double orientation = 0;
  /// Of slabs 0.25 r_c thick from the film's middle outwards, both halves together, beads per r_c^3.
  struct Slab {
    double out;  ///< of its middle, from that of the film, r_c
    double liquid, heads, tails;
    double orientation;  ///< as above, of the dimers whose middle is here; 0 without any
  };
  std::vector<Slab> profile;
};
/// Surfaces are taken where the film's beads at the liquid's bulk density would end.
SurfactantFilmResult run_surfactant_film(const SurfactantFilmRun& how);

}  // namespace dmf::tools
