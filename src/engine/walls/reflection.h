#pragma once
#include <array>
#include <cstdint>

#include "engine/noise.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// The closed sides as a bead that moves sees them: infinitely far away along periodic axes.
struct Planes {
  float lower[3], upper[3];

  explicit Planes(const Domain& domain);
  /// Fraction of the way from a place inside to the first plane that it crosses; 1 when it crosses none.
  float fraction_to(const float* from, const float* way) const;
  bool outside(const float* at) const {
    bool result = false;
    for (int axis = 0; axis < 3; ++axis) result |= at[axis] < lower[axis] || at[axis] > upper[axis];
    return result;
  }
};

/// A bead on its way through one drift, as if there were no sides.
struct Flight {
  std::uint32_t id;
  float from[3];
  const float* way;
  float travel;  ///< how long it flies, tau: way = travel * velocity
};

/// What becomes of it: where it comes to, its velocity, and the velocity that the forces shall see.
using Triple = float[3];

/// Bounce-back from all sides, and all at rest: what nearly every run has.
class BounceBack {
 public:
  explicit BounceBack(const Domain& domain) : planes_(domain) {}
  const Planes& planes() const { return planes_; }
  bool concerns(const float* at) const { return planes_.outside(at); }
  void send_back(const Flight& flight, Triple& at, Triple& moving, Triple& seen) const;

 private:
  Planes planes_;
};

/// Sides each with a reflection and a velocity of its own (boundary_parameters.h). A bead that meets several
/// in one drift is sent back by one after the other.
class Reflections {
 public:
  /// @param drift  number of the drift: those of a step with BAOAB are two, with other noise each.
  Reflections(const Parameters& parameters, std::uint64_t drift);
  const Planes& planes() const { return planes_; }
  bool concerns(const float* at) const { return layers_.outside(at); }
  void send_back(const Flight& flight, Triple& at, Triple& moving, Triple& seen) const;

 private:
  struct Side {
    Reflection reflection;
    float velocity[3];
  };
  /// Draws the velocity of a bead that leaves a side.
  /// @param draw  another one for every velocity that a bead gets in a drift.
  void emit(std::uint32_t id, std::uint32_t draw, int axis, bool upper, Triple& velocity) const;
  const Side& side(int axis, bool upper) const { return sides_[2 * axis + upper]; }

  Planes planes_, layers_;  ///< the sides; the same without the layers of thin_layer
  std::array<Side, 6> sides_;
  double temperature_;
  bool flat_;
  StepKey key_;
};

}  // namespace dmf::engine
