#include "engine/thermostat.h"

namespace dmf::engine {
namespace {

constexpr float b = 0.8f;
constexpr float noise_first = (1.f + b) / 2.f;                   ///< of A in Q
constexpr float noise_second = b - (1.f + b) * (1.f + b) / 8.f;  ///< of A^2 in Q

/// to = wv v + wr r + wf f, vector by vector.
template <class To>
void combine(Beads& beads, float of_velocity, float of_random, float of_force, To to) {
  const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(beads.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Record &v = beads.velocity[i], &r = beads.random[i], &f = beads.force[i];
    to(i) = {of_velocity * v.x + of_random * r.x + of_force * f.x,
             of_velocity * v.y + of_random * r.y + of_force * f.y,
             of_velocity * v.z + of_random * r.z + of_force * f.z, 0.f};
  }
}

}  // namespace

void thermostat(Beads& beads, const Walls& wall, Microparticles& bodies, Pairs& pairs, const Forces& forces,
                const Parameters& parameters) {
  const float dt = static_cast<float>(parameters.time_step);
  const auto seen = [&](std::ptrdiff_t i) -> Record& { return beads.predicted[i]; };
  const auto velocity = [&](std::ptrdiff_t i) -> Record& { return beads.velocity[i]; };

  forces.density(beads, wall, bodies, pairs);                                 // for who is in range
  forces.force(PairForce::random, beads.random, beads, wall, bodies, pairs);  // N / dt
  combine(beads, b, 0.5f * noise_second * dt, 0.f, seen);
  forces.force(PairForce::friction, beads.force, beads, wall, bodies, pairs);  // -D (b v + c N)
  combine(beads, 1.f, 0.5f * noise_first * dt, 0.5f * dt, seen);
  forces.force(PairForce::friction, beads.force, beads, wall, bodies, pairs);
  combine(beads, 1.f, dt, dt, velocity);
}

}  // namespace dmf::engine
