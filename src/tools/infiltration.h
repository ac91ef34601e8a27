#pragma once
#include <cstdint>
#include <functional>

#include "engine/parameters.h"
#include "engine/wettability.h"

namespace dmf::tools {

/// What the liquid goes into.
enum class PoreSpace {
  slit,   ///< straight, between flat walls
  grains  ///< staggered rows of round grains of unequal size: throats and pores (Liu 4.2)
};

/// A slug of liquid in front of an empty pore space, in a slab periodic along y. It imbibes by itself when it
/// wets, or is pushed by an acceleration along x.
struct InfiltrationRun {
  PoreSpace space = PoreSpace::grains;
  double contact_angle = 60;  ///< of the solid, degrees, within `curve`
  double acceleration = 0;    ///< r_c / tau^2
  double depth = 28;          ///< of the pore space along x, r_c
  double width = 24;          ///< along z, periodic; of the slit with its walls, r_c
  double gap = 4;             ///< of the slit, r_c
  double slug = 14;           ///< length of the slug at the start, r_c
  double time = 300;          ///< tau
  std::uint64_t seed = 1;
  engine::Parameters parameters{};  ///< liquid and time step; the domain is laid around
};

struct InfiltrationSample {
  double time;   ///< tau
  double share;  ///< of the pore space that is filled
};

/// Pressure that keeps a liquid which does not wet out of a slit: -2 sigma cos(theta) / gap (Young and
/// Laplace), k_BT / r_c^3. Negative: it is sucked in.
double entry_pressure(double surface_tension, double contact_angle, double gap);

/// How far a liquid has come in a slit by its own suction, against its friction with the walls (Lucas 1918,
/// Washburn 1921, for a slit): sqrt(sigma gap cos(theta) t / (3 mu)), r_c. Without inertia and a slug of its
/// own.
double washburn_depth(double surface_tension, double viscosity, double contact_angle, double gap,
                      double time);

/// The share that is filled at the end, of all samples ten tau apart.
/// @throws engine::Instability, engine::InvalidInput.
double run_infiltration(const InfiltrationRun& run, const engine::ContactAngleCurve& curve,
                        const std::function<void(const InfiltrationSample&)>& sample = {});

}  // namespace dmf::tools
