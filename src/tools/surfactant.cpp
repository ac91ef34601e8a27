#include "tools/surfactant.h"

#include <algorithm>
#include <cmath>

#include "engine/simulation.h"

namespace dmf::tools {
namespace {

using engine::Vector3d;

constexpr double slab = 0.25;        // of the profiles, r_c
constexpr double at_surface = 1.25;  // r_c

engine::Parameters parameters_of(const SurfactantFilmRun& how) {
  using engine::Side;
  engine::Parameters parameters;
  parameters.seed = how.seed;
  parameters.time_step = how.time_step;
  parameters.integrator = how.integrator;
  parameters.domain.lower = Vector3d::Zero();
  parameters.domain.upper = {how.width, how.width, how.thickness + 12};
  parameters.domain.lower_side =
      parameters.domain.upper_side = {Side::periodic, Side::periodic, Side::periodic};
  add_surfactant(parameters);
  return parameters;
}

}  // namespace

void add_surfactant(engine::Parameters& parameters, std::optional<double> on_microparticles) {
  const engine::LiquidParameters& liquid = parameters.liquid;
  const auto law = [&](double attraction) {
    return engine::PairCoefficients{attraction, liquid.repulsion, liquid.random_amplitude};
  };
  parameters.mixture.liquids = {{"head", law(-40), liquid.initial_density, liquid.bulk_density},
                                {"tail", law(-20), liquid.initial_density, liquid.bulk_density}};
  parameters.mixture.pairs = {{"liquid", "head", law(-45)},
                              {"liquid", "tail", law(-20)},
                              {"head", "tail", law(-20)},
                              {"head", "wall", law(-17)},
                              {"tail", "wall", law(-17)}};
  if (on_microparticles)
    parameters.mixture.pairs.push_back(
        {"tail",
         engine::microparticle_name,
         {*on_microparticles, parameters.microparticles.liquid_repulsion, liquid.random_amplitude}});
}

engine::ChainPlacement surfactant_dimers(std::uint32_t count, const Vector3d& lower, const Vector3d& upper) {
  engine::ChainPlacement dimers;
  dimers.spring.stiffness = 60;
  dimers.spring.length = dimers.bond_length = 0.5;
  dimers.species = {1, 2};
  dimers.count = count;
  dimers.beads = 2;
  dimers.lower = lower;
  dimers.upper = upper;
  return dimers;
}

SurfactantFilmResult run_surfactant_film(const SurfactantFilmRun& how) {
  const engine::Parameters parameters = parameters_of(how);
  engine::Simulation simulation(parameters, engine::ContactAngleCurve::lan2016(), {1, "auto"});
  const double area = how.width * how.width, height = parameters.domain.size().z();
  const double lower = 0.5 * (height - how.thickness), upper = lower + how.thickness;
  simulation.fill_slab({0, 0, lower}, {how.width, how.width, upper});
  const auto place = [&](double share, double from, double to) {
    const auto count = static_cast<std::uint32_t>(std::lround(share * how.coverage * area));
    if (count > 0) simulation.add_chains(surfactant_dimers(count, {0, 0, from}, {how.width, how.width, to}));
  };
  if (how.throughout) {
    place(2, lower, upper);
  } else {
    place(1, lower, lower + 1.5);
    place(1, upper - 1.5, upper);
  }
  const double surface =
      0.5 * static_cast<double>(simulation.observe()->moving_beads) / (area * parameters.liquid.bulk_density);

  const auto steps_of = [&](double time) {
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(time / how.time_step)));
  };
  for (std::uint64_t k = 0; k < steps_of(how.settle); ++k) simulation.step();
  SurfactantFilmResult result;
  const auto slabs = static_cast<std::size_t>(std::ceil((surface + 2) / slab));
  std::vector<std::vector<double>> beads(3, std::vector<double>(slabs, 0));
  std::vector<double> cosines(slabs, 0), dimers(slabs, 0);
  double looks = 0, all = 0, near = 0;
  for (std::uint64_t k = 1; k <= steps_of(how.measure); ++k) {
    simulation.step();
    if (k % steps_of(0.2) != 0) continue;
    const auto snapshot = simulation.observe({true, false, true});
    const Eigen::Matrix3d& virial = *snapshot->virial;
    result.tension += (virial(2, 2) - 0.5 * (virial(0, 0) + virial(1, 1))) / (2 * area);
    result.temperature += snapshot->temperature;
    ++looks;
    double middle = 0;  // the film never comes near the box's sides
    for (const Eigen::Vector3f& p : snapshot->positions)
      middle += p.z() / static_cast<double>(snapshot->positions.size());
    const auto slab_at = [&](double out) {
      return std::min(slabs - 1, static_cast<std::size_t>(std::abs(out) / slab));
    };
    for (std::size_t bead = 0; bead < snapshot->positions.size(); ++bead) {
      const std::size_t species = snapshot->bead_species.empty() ? 0 : snapshot->bead_species[bead];
      ++beads[species][slab_at(snapshot->positions[bead].z() - middle)];
    }
    for (const engine::ChainObservation& dimer : snapshot->chains) {
      const double out = dimer.centroid.z() - middle;
      const double cosine = dimer.end_to_end.normalized().z() * (out > 0 ? 1 : -1);
      ++all;
      ++dimers[slab_at(out)];
      cosines[slab_at(out)] += cosine;
      if (std::abs(out) < surface - at_surface) continue;
      ++near;
      result.orientation += cosine;
    }
  }
  result.tension /= looks;
  result.temperature /= looks;
  result.at_surface = all > 0 ? near / all : 0;
  result.orientation = near > 0 ? result.orientation / near : 0;
  const double volume = 2 * area * slab * looks;
  for (std::size_t k = 0; k < slabs; ++k)
    result.profile.push_back({(static_cast<double>(k) + 0.5) * slab, beads[0][k] / volume,
                              beads[1][k] / volume, beads[2][k] / volume,
                              dimers[k] > 0 ? cosines[k] / dimers[k] : 0});
  return result;
}

}  // namespace dmf::tools
