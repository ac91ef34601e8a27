#include "engine/forces.h"

#include "engine/bodies/smooth_sphere.h"
#include "engine/kernels/reference.h"
#include "engine/simulation.h"

namespace dmf::engine {

std::vector<std::string> available_kernels() {
  std::vector<std::string> names = vector_kernels();
  names.push_back("reference");
  return names;
}

namespace {
Kernels kernels_named(const std::string& name, const Parameters& parameters) {
  const DissipativeWeight weight = liquid_law(parameters.liquid, parameters.time_step).weight();
  const PairModel model = pair_model(parameters);
  return name == "reference" ? reference_kernels(weight, model) : select_kernels(name, weight, model);
}
}  // namespace

Forces::Forces(const Parameters& parameters, const std::string& kernel)
    : kernels_(kernels_named(kernel, parameters)),
      kernel_name_(kernel == "auto" ? vector_kernels().front() : kernel),
      constants_{},
      frozen_particles_(parameters) {
  constants_.laws = pair_table(parameters);
  constants_.spline = spline_shape(parameters.spline);
  rows_ = law_rows(constants_.laws, parameters);
  microparticle_row_ = microparticle_row(constants_.laws, parameters);
  constants_.bodies.count_liquid = parameters.microparticles.counts_liquid;
  constants_.bodies.counted_by_liquid = parameters.microparticles.counted_by_liquid;
  constants_.density_normalization =
      density_normalization(parameters.liquid.repulsion_radius, parameters.dimensions);
  const BoundaryParameters& boundaries = parameters.boundaries;
  constants_.wall_motion.lower.head<2>() = boundaries.lower_velocity.cast<float>();
  constants_.wall_motion.upper.head<2>() = boundaries.upper_velocity.cast<float>();
  constants_.wall_motion.middle =
      static_cast<float>(0.5 * (parameters.domain.lower.z() + parameters.domain.upper.z()));
  const Domain domain = Ghosts(parameters).search_domain();
  for (int axis = 0; axis < 3; ++axis) {
    if (!domain.periodic(axis)) continue;
    constants_.period[axis] = static_cast<float>(parameters.domain.size()[axis]);
    constants_.inverse_period[axis] = 1.f / constants_.period[axis];
  }
  constants_.images = PeriodicImages(constants_.period);
}

PairPass Forces::pass_over(Beads& beads, const Walls& wall, Microparticles& bodies) const {
  PairPass pass = constants_;
  pass.rows = rows_.data();
  pass.bodies.row = rows_.empty() ? nullptr : &microparticle_row_;
  pass.position = beads.position.data();
  pass.predicted = beads.predicted.data();
  pass.force = beads.force.data();
  pass.wall = wall.beads().data();
  pass.bodies.position = bodies.beads().position.data();
  pass.bodies.moving = bodies.beads().moving.data();
  pass.bodies.own_density = bodies.beads().own_density.data();
  pass.bodies.key = bodies.beads().key.data();
  pass.bodies.liquid_force = bodies.beads().liquid_force.data();
  pass.bodies.wall_force = bodies.beads().wall_force.data();
  return pass;
}

void Forces::density(Beads& beads, const Walls& wall, Microparticles& bodies, Pairs& pairs) const {
  const GhostsInPlace ghosts(pairs.ghosts(), beads, bodies.beads());
  const PairPass pass = pass_over(beads, wall, bodies);
  std::vector<NeighbourBlock>& blocks = pairs.blocks();
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t b = 0; b < blocks.size(); ++b) kernels_.density(pass, blocks[b]);
  std::vector<NeighbourBlock>& of_bodies = pairs.body_blocks();
#pragma omp parallel for schedule(dynamic, 1) if (!of_bodies.empty())
  for (std::size_t b = 0; b < of_bodies.size(); ++b) kernels_.body_density(pass, of_bodies[b]);
  add_smooth_densities(pass, bodies, pairs);
}

void Forces::force(Beads& beads, const Walls& wall, Microparticles& bodies, Pairs& pairs) const {
  const GhostsInPlace ghosts(pairs.ghosts(), beads, bodies.beads());
  sum(PairForce::all, beads.force, beads, wall, bodies, pairs);
  const PairPass pass = pass_over(beads, wall, bodies);
  const std::vector<NeighbourBlock>& of_bodies = pairs.body_blocks();
#pragma omp parallel for schedule(dynamic, 1) if (!of_bodies.empty())
  for (std::size_t b = 0; b < of_bodies.size(); ++b) kernels_.body_force(pass, of_bodies[b]);
  add_smooth_forces(pass, bodies, pairs);
}

void Forces::force(PairForce part, AlignedVector<Record>& to, Beads& beads, const Walls& wall,
                   Microparticles& bodies, Pairs& pairs) const {
  const GhostsInPlace ghosts(pairs.ghosts(), beads, bodies.beads());
  sum(part, to, beads, wall, bodies, pairs);
}

void Forces::sum(PairForce part, AlignedVector<Record>& to, Beads& beads, const Walls& wall,
                 Microparticles& bodies, const Pairs& pairs) const {
  to.resize(beads.size());
  PairPass pass = pass_over(beads, wall, bodies);
  pass.force = to.data();
  const std::vector<NeighbourBlock>& blocks = pairs.blocks();
  const auto kernel = kernels_.force[static_cast<std::size_t>(part)];
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t b = 0; b < blocks.size(); ++b) kernel(pass, blocks[b]);
  if (pairs.ghosts().needed() && (part == PairForce::all || part == PairForce::random))
    pairs.ghosts().correct_own_noise(beads, to);
  if (frozen_particles_.needed()) frozen_particles_.add_forces(part, beads, to);
}

}  // namespace dmf::engine
