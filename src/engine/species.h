#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/pair_law.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// What a bead is made of. Beads of one group share a species, so no kernel looks a species up bead by bead.
/// Second liquids and chains add theirs here.
enum class Species : std::uint8_t { liquid, wall, microparticle };
constexpr std::size_t species_count = 3;

/// The law of every pair of species. Symmetric.
class PairTable {
 public:
  const MdpdLaw<double>& operator()(Species a, Species b) const { return laws_[index(a)][index(b)]; }
  void set(Species a, Species b, const MdpdLaw<double>& law) {
    laws_[index(a)][index(b)] = laws_[index(b)][index(a)] = law;
  }

 private:
  static std::size_t index(Species species) { return static_cast<std::size_t>(species); }
  std::array<std::array<MdpdLaw<double>, species_count>, species_count> laws_{};
};

/// Liquid and wall share all but the attraction, which each wall bead has of its own: its wettability. So
/// have the beads of microparticles, with a repulsion B_ls of their own (Lan 3.1.2): a force without a
/// potential, because B differs between pairs that share a density (Warren 2013). Microparticle and wall
/// attract, and that is all: contact.h does the rest.
inline PairTable pair_table(const Parameters& parameters) {
  PairTable table;
  const MdpdLaw<double> liquid = liquid_law(parameters.liquid, parameters.time_step);
  table.set(Species::liquid, Species::liquid, liquid);
  table.set(Species::liquid, Species::wall, liquid);
  MdpdLaw<double> on_microparticle = liquid;
  on_microparticle.repulsion = parameters.microparticles.liquid_repulsion;
  table.set(Species::liquid, Species::microparticle, on_microparticle);
  MdpdLaw<double> adhesion = liquid;
  adhesion.attraction = parameters.microparticles.wall_attraction;
  adhesion.repulsion = adhesion.friction = adhesion.random_amplitude = 0;
  table.set(Species::wall, Species::microparticle, adhesion);
  return table;
}

}  // namespace dmf::engine
