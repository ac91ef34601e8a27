#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/pair_law.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// What a bead is made of. Beads of one group share a species, so no kernel looks a species up bead by bead.
/// Bodies, second liquids and chains add theirs here.
enum class Species : std::uint8_t { liquid, wall };
constexpr std::size_t species_count = 2;

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

/// Liquid and wall share all but the attraction, which each wall bead has of its own: its wettability.
inline PairTable pair_table(const Parameters& parameters) {
  PairTable table;
  const MdpdLaw<double> liquid = liquid_law(parameters.liquid, parameters.time_step);
  table.set(Species::liquid, Species::liquid, liquid);
  table.set(Species::liquid, Species::wall, liquid);
  return table;
}

}  // namespace dmf::engine
