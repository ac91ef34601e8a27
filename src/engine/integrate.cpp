#include "engine/integrate.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/noise.h"
#include "engine/species.h"
#include "engine/walls/reflection.h"

namespace dmf::engine {
namespace {

/// How far a bead goes with its velocity and force in a drift.
struct Drift {
  float kick;        ///< v' = v + kick f
  float travel;      ///< r += travel v'
  float prediction;  ///< predicted = v' + prediction f
};

/// Turns a bead back that would enter a solid voxel before it crosses a side. @returns whether it did.
bool bounce_off(const Solid& solid, const Planes& planes, const float* from, const float* way, float* at) {
  const Eigen::Map<const Eigen::Vector3f> start(from), path(way);
  const float free = solid.free_fraction(start, path);
  if (free >= 1.f || free > planes.fraction_to(from, way)) return false;
  Eigen::Map<Eigen::Vector3f>(at, 3) = start + (2.f * free - 1.f) * path;
  return true;
}

/// Is the straight way there open? A bead that bounced can come to the back of where it was.
bool reached(const Solid& solid, const Planes& planes, const float* from, const float* at) {
  const Eigen::Map<const Eigen::Vector3f> start(from), end(at);
  return !solid.contains(end) && solid.free_fraction(start, end - start) >= 1.f && !planes.outside(at);
}

template <bool with_solid, class Sides>
DriftReport move_between(const Sides& sides, Beads& beads, const Parameters& parameters, std::uint64_t step,
                         const Drift& drift, const Solid& solid) {
  const StepKey key = step_key(parameters.seed, step, Stream::pair);
  const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(beads.size());
  float largest = 0;
  std::int64_t wild = -1;
#pragma omp parallel for schedule(static) reduction(max : largest, wild)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    Record& p = beads.position[i];
    Record& v = beads.velocity[i];
    const Record& f = beads.force[i];
    float kicked[3] = {v.x + drift.kick * f.x, v.y + drift.kick * f.y, v.z + drift.kick * f.z};
    float seen[3] = {kicked[0] + drift.prediction * f.x, kicked[1] + drift.prediction * f.y,
                     kicked[2] + drift.prediction * f.z};
    const float way[3] = {drift.travel * kicked[0], drift.travel * kicked[1], drift.travel * kicked[2]};
    float at[3] = {p.x + way[0], p.y + way[1], p.z + way[2]};
    const float from[3] = {p.x, p.y, p.z};
    if (with_solid && bounce_off(solid, sides.planes(), from, way, at)) {
      for (int axis = 0; axis < 3; ++axis) {
        kicked[axis] = -kicked[axis];
        seen[axis] = -seen[axis];
      }
    } else if (sides.concerns(at)) {
      sides.send_back({beads.id[i], {p.x, p.y, p.z}, way, drift.travel}, at, kicked, seen);
    }
    if (with_solid && !reached(solid, sides.planes(), from, at)) std::copy_n(from, 3, at);
    const float moved = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
    if (!(moved < largest_step * largest_step)) wild = std::max<std::int64_t>(wild, i);
    const Record& listed = beads.listed[i];
    const float dx = at[0] - listed.x, dy = at[1] - listed.y, dz = at[2] - listed.z;
    largest = std::max(largest, dx * dx + dy * dy + dz * dz);
    const std::uint32_t bits = bead_key(key, beads.id[i]);
    p = {at[0], at[1], at[2], 0.f};
    std::memcpy(&p.w, &bits, sizeof bits);
    v = {kicked[0], kicked[1], kicked[2], 0.f};
    beads.predicted[i] = {seen[0], seen[1], seen[2], 0.f};
  }
  return {largest, wild};
}

template <class Sides>
DriftReport move_around(const Sides& sides, Beads& beads, const Parameters& parameters, std::uint64_t step,
                        const Drift& drift, const Solid& solid) {
  return solid.empty() ? move_between<false>(sides, beads, parameters, step, drift, solid)
                       : move_between<true>(sides, beads, parameters, step, drift, solid);
}

/// Where the force pass of a mixture looks for a bead's species (species.h).
void note_species(Beads& beads, const Parameters& parameters) {
  if (pair_model(parameters) == PairModel::one_liquid) return;
  const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(beads.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    float& word = beads.position[i].w;
    std::uint32_t key;
    std::memcpy(&key, &word, sizeof key);
    key = (key & ~species_bits) | beads.species_of(static_cast<std::size_t>(i));
    std::memcpy(&word, &key, sizeof key);
  }
}

/// @param half  0 for the first or only drift of a step, 1 for the second.
DriftReport move(Beads& beads, const Parameters& parameters, std::uint64_t step, int half, const Drift& drift,
                 const Solid& solid) {
  const BoundaryParameters& boundaries = parameters.boundaries;
  const DriftReport report =
      boundaries.usual() && !boundaries.moving()
          ? move_around(BounceBack(parameters.domain), beads, parameters, step, drift, solid)
          : move_around(Reflections(parameters, 2 * step + half), beads, parameters, step, drift, solid);
  note_species(beads, parameters);
  return report;
}

}  // namespace

DriftReport drift(Beads& beads, const Parameters& parameters, std::uint64_t step, const Solid& solid) {
  const float dt = static_cast<float>(parameters.time_step);
  const float prediction = static_cast<float>(parameters.integrator_lambda - 0.5) * dt;
  return move(beads, parameters, step, 0, {0.5f * dt, dt, prediction}, solid);
}

void add_gravity(Beads& beads, const Vector3d& gravity) {
  const Eigen::Vector3f pull = gravity.cast<float>();
  const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(beads.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    Record& f = beads.force[i];
    f = {f.x + pull.x(), f.y + pull.y(), f.z + pull.z(), 0.f};
  }
}

void finish(Beads& beads, const Parameters& parameters) {
  const float half_dt = 0.5f * static_cast<float>(parameters.time_step);
  const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(beads.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    Record& v = beads.velocity[i];
    const Record& f = beads.force[i];
    v = {v.x + half_dt * f.x, v.y + half_dt * f.y, v.z + half_dt * f.z, 0.f};
  }
}

DriftReport kick_and_half_drift(Beads& beads, const Parameters& parameters, std::uint64_t step,
                                const Solid& solid) {
  const float dt = static_cast<float>(parameters.time_step);
  return move(beads, parameters, step, 0, {dt, 0.5f * dt, 0.f}, solid);
}

DriftReport half_drift(Beads& beads, const Parameters& parameters, std::uint64_t step, const Solid& solid) {
  const float dt = static_cast<float>(parameters.time_step);
  return move(beads, parameters, step, 1, {0.f, 0.5f * dt, 0.f}, solid);
}

}  // namespace dmf::engine
