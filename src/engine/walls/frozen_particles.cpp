#include "engine/walls/frozen_particles.h"

#include <cmath>
#include <cstring>

#include "engine/kernels/lanes-inl.h"
#include "engine/noise-inl.h"
#include "engine/pair_law-inl.h"

namespace dmf::engine {
namespace {

MdpdLaw<double> law_of(const Parameters& parameters) {
  MdpdLaw<double> law = liquid_law(parameters.liquid, parameters.time_step);
  law.attraction = parameters.boundaries.frozen_particles.attraction.value_or(law.attraction);
  return law;
}

}  // namespace

FrozenParticles::FrozenParticles(const Parameters& parameters)
    : law_(law_of(parameters)),
      shape_(spline_shape(parameters.spline)),
      spline_(parameters.spline.used),
      flat_(parameters.dimensions == 2),
      lateral_friction_(parameters.boundaries.frozen_particles.lateral_friction),
      lateral_random_(
          std::sqrt(2 * lateral_friction_ * parameters.liquid.temperature / parameters.time_step)) {
  const BoundaryParameters& boundaries = parameters.boundaries;
  const Domain& domain = parameters.domain;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      if ((upper ? boundaries.upper_reflection : boundaries.lower_reflection)[axis] !=
          Reflection::frozen_particles)
        continue;
      // A side that the beads of a plane never reach.
      if (flat_ && axis == 1) continue;
      Facing side{axis, upper, static_cast<float>((upper ? domain.upper : domain.lower)[axis]), {0, 0, 0}};
      if (axis == 2) {
        const Eigen::Vector2d& velocity = upper ? boundaries.upper_velocity : boundaries.lower_velocity;
        side.velocity[0] = static_cast<float>(velocity.x());
        side.velocity[1] = static_cast<float>(velocity.y());
      }
      sides_.push_back(side);
    }
}

template <class Law>
void FrozenParticles::add_with(const Law& law, PairForce part, const Beads& beads,
                               AlignedVector<Record>& to) const {
  const bool conservative = part == PairForce::all || part == PairForce::conservative,
             friction = part == PairForce::all || part == PairForce::friction,
             random = part == PairForce::all || part == PairForce::random;
  const double range = law.range();
  const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(beads.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Record& p = beads.position[i];
    const float at[3] = {p.x, p.y, p.z};
    for (const Facing& side : sides_) {
      const double inward = side.upper ? -1 : 1;
      const double height = std::max(0.0, inward * (static_cast<double>(at[side.axis]) - side.plane));
      if (height >= range) continue;
      const Record& seen = beads.predicted[i];
      const float velocity[3] = {seen.x, seen.y, seen.z};
      std::uint32_t key;
      std::memcpy(&key, &p.w, sizeof key);
      const double w_r = HWY_NAMESPACE::random_weight(law, height), w_d = w_r * w_r;
      double force[3];
      for (int k = 0; k < 3; ++k) {
        const bool normal = k == side.axis;
        force[k] = 0;
        if (flat_ && k == 1) continue;
        if (normal && conservative)
          force[k] += inward *
                      HWY_NAMESPACE::conservative_force_anywhere(law, law.attraction, height, double{seen.w});
        if (friction)
          force[k] -= (normal ? law.friction : lateral_friction_) * w_d *
                      (static_cast<double>(velocity[k]) - side.velocity[k]);
        if (random) {
          const auto number = static_cast<std::uint32_t>(3 * (2 * side.axis + side.upper) + k);
          force[k] += (normal ? law.random_amplitude : lateral_random_) * w_r *
                      HWY_NAMESPACE::pair_noise<double>(key, HWY_NAMESPACE::frozen_key(number));
        }
      }
      Record& sum = to[i];
      sum = {sum.x + static_cast<float>(force[0]), sum.y + static_cast<float>(force[1]),
             sum.z + static_cast<float>(force[2]), sum.w};
    }
  }
}

void FrozenParticles::add_forces(PairForce part, const Beads& beads, AlignedVector<Record>& to) const {
  if (spline_)
    add_with(SplineLaw<double>{law_, shape_}, part, beads, to);
  else
    add_with(law_, part, beads, to);
}

}  // namespace dmf::engine
