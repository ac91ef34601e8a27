#include "engine/observe/state_hash.h"

#include <cstring>

#include "engine/noise.h"

namespace dmf::engine {
namespace {

std::uint64_t fold(std::uint64_t hash, float a, float b) {
  std::uint32_t low, high;
  std::memcpy(&low, &a, sizeof low);
  std::memcpy(&high, &b, sizeof high);
  return mix64(hash ^ (static_cast<std::uint64_t>(high) << 32 | low));
}

std::uint64_t fold(std::uint64_t hash, double a) {
  std::uint64_t bits;
  std::memcpy(&bits, &a, sizeof bits);
  return mix64(hash ^ bits);
}

std::uint64_t fold(std::uint64_t hash, const Microparticle& particle) {
  const RigidBody& body = particle.body;
  hash = mix64(hash ^ particle.id);
  for (const Vector3d* vector :
       {&body.position, &body.velocity, &body.angular_momentum, &particle.force, &particle.torque})
    for (const double component : *vector) hash = fold(hash, component);
  for (const double component : body.orientation.coeffs()) hash = fold(hash, component);
  return hash;
}

}  // namespace

std::uint64_t state_hash(std::uint64_t step, const Beads& beads, const Walls& wall,
                         const Microparticles& bodies, const Bonds& bonds) {
  // A sum over beads does not know their order.
  std::uint64_t sum = mix64(step + 0x9e3779b97f4a7c15ull);
  const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(beads.size());
#pragma omp parallel for schedule(static) reduction(+ : sum)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Record &p = beads.position[i], &v = beads.velocity[i], &f = beads.force[i];
    std::uint64_t hash = mix64(beads.id[i] + 1ull);
    hash = fold(hash, p.x, p.y);
    hash = fold(hash, p.z, v.x);
    hash = fold(hash, v.y, v.z);
    hash = fold(hash, f.x, f.y);
    sum += fold(hash, f.z, beads.species_of(static_cast<std::size_t>(i)));
  }
  std::uint64_t hash = mix64(sum);
  for (const Record& bead : wall.beads()) hash = fold(hash, bead.w, 0.f);
  for (const Microparticle& particle : bodies.all()) hash = fold(hash, particle);
  if (!bonds.empty()) hash = mix64(hash ^ bonds.hash());
  return hash;
}

}  // namespace dmf::engine
