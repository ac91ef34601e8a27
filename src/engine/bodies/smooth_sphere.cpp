#include "engine/bodies/smooth_sphere.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/bodies/shape.h"
#include "engine/kernels/lanes-inl.h"
#include "engine/noise-inl.h"

namespace dmf::engine {
namespace {

Vector3d vector_of(const Record& record) { return {record.x, record.y, record.z}; }

std::uint32_t key_bits(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

SmoothShell shell_of(const Microparticle& particle, const PairPass& pass) {
  const double radius = particle.placement.radius;
  return SmoothShell(radius, usual_beads_per_area,
                     1.0 / pass.laws(Species::liquid, Species::microparticle).inverse_repulsion_radius);
}

/// Calls visit(index, way out from the sphere's centre, distance) for the beads of `runs` within `reach` of
/// it.
template <class Visit>
void for_each_around(const PairPass& pass, const Record* beads, const std::vector<BeadRun>& runs,
                     const Vector3d& centre, double reach, Visit visit) {
  for (const BeadRun& run : runs)
    for (std::uint32_t j = run.begin; j < run.end; ++j) {
      const Vector3d d = vector_of(beads[j]) + pass.images.shift(run.image).cast<double>() - centre;
      const double distance = d.norm();
      if (distance < reach && distance > 0) visit(j, d / distance, distance);
    }
}

}  // namespace

SmoothShell::SmoothShell(double radius, double beads_per_area, double repulsion_radius)
    : radius_(radius), beads_per_area_(beads_per_area), repulsion_radius_(repulsion_radius) {}

double SmoothShell::weight(double distance, double range) const {
  const double from = std::abs(distance - radius_), to = std::min(range, distance + radius_);
  if (from >= to) return 0;
  const double c = distance * distance - radius_ * radius_;
  const auto integral = [c, range](double r) {
    return r * (r * r / 3 + c - r / range * (r * r / 4 + c / 2));
  };
  return M_PI * radius_ * beads_per_area_ / (distance * distance) * (integral(to) - integral(from));
}

double SmoothShell::density(double distance) const {
  const double a = repulsion_radius_;
  const double from = std::abs(distance - radius_), to = std::min(a, distance + radius_);
  if (from >= to) return 0;
  const auto integral = [a](double r) { return r * r * (0.5 - r / a * (2.0 / 3.0 - 0.25 * r / a)); };
  return density_normalization(a) * 2 * M_PI * radius_ * beads_per_area_ / distance *
         (integral(to) - integral(from));
}

double SmoothShell::own_density() const {
  return density(radius_) - density_normalization(repulsion_radius_);  // without itself
}

void add_smooth_densities(const PairPass& pass, const Microparticles& bodies, const Pairs& pairs) {
  if (!pass.bodies.counted_by_liquid) return;
  for (const SmoothNeighbours& near : pairs.smooth_neighbours()) {
    const Microparticle& particle = bodies.all()[near.microparticle];
    const SmoothShell shell = shell_of(particle, pass);
    for_each_around(pass, pass.position, near.liquid, particle.body.position, particle.placement.radius + 1.0,
                    [&](std::uint32_t j, const Vector3d&, double distance) {
                      pass.predicted[pairs.ghosts().source(j)].w +=
                          static_cast<float>(shell.density(distance));
                    });
  }
}

void add_smooth_forces(const PairPass& pass, const Microparticles& bodies, const Pairs& pairs) {
  const MdpdLaw<double>& of_first = pass.laws(Species::liquid, Species::microparticle);
  const MdpdLaw<double>& adhesion = pass.laws(Species::wall, Species::microparticle);
  const Ghosts& ghosts = pairs.ghosts();
  const double range = 1.0 / of_first.inverse_cutoff_radius,
               short_range = 1.0 / of_first.inverse_repulsion_radius;
  for (const SmoothNeighbours& near : pairs.smooth_neighbours()) {
    const Microparticle& particle = bodies.all()[near.microparticle];
    const SmoothShell shell = shell_of(particle, pass);
    const double own_density = pass.bodies.own_density[particle.first_bead];
    const Vector3d velocity = vector_of(pass.bodies.moving[particle.first_bead]);
    const double reach = particle.placement.radius + range;
    Vector3d of_liquid = Vector3d::Zero(), of_wall = Vector3d::Zero();
    for_each_around(pass, pass.position, near.liquid, particle.body.position, reach,
                    [&](std::uint32_t j, const Vector3d& out, double distance) {
                      const double beads = shell.weight(distance, range);
                      const std::uint32_t key = key_bits(pass.position[j].w);
                      const std::uint32_t number = pass.bodies.row ? key & species_bits : 0;
                      const MdpdLaw<double>& law = pass.laws(liquid_species(number), Species::microparticle);
                      const bool own = !pass.bodies.row || pass.bodies.row->share_of_own[number] == 1;
                      const Record& moving = pass.predicted[j];
                      const double parting = out.dot(vector_of(moving) - velocity);
                      const double zeta = HWY_NAMESPACE::pair_noise<double>(
                          key, HWY_NAMESPACE::body_key(particle.first_bead));
                      const double magnitude =
                          (own ? particle.placement.attraction : law.attraction) * beads +
                          law.repulsion * (moving.w + own_density) * shell.weight(distance, short_range) -
                          law.friction * beads * parting +
                          law.random_amplitude * std::sqrt(std::max(beads, 0.0)) * zeta;
                      const Vector3d force = magnitude * out;
                      const Vector3d felt = ghosts.force_on_source(j, force);
                      Record& sum = pass.force[ghosts.source(j)];
                      sum.x += static_cast<float>(felt.x());
                      sum.y += static_cast<float>(felt.y());
                      sum.z += static_cast<float>(felt.z());
                      of_liquid -= force;
                    });
    for_each_around(pass, pass.wall, near.wall, particle.body.position, reach,
                    [&](std::uint32_t, const Vector3d& out, double distance) {
                      of_wall -= adhesion.attraction * shell.weight(distance, range) * out;
                    });
    const auto store = [&](Record* to, const Vector3d& force) {
      to[particle.first_bead] = {static_cast<float>(force.x()), static_cast<float>(force.y()),
                                 static_cast<float>(force.z()), 0};
    };
    store(pass.bodies.liquid_force, of_liquid);
    store(pass.bodies.wall_force, of_wall);
  }
}

}  // namespace dmf::engine
