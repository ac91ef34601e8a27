#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/beads.h"
#include "engine/pair_law.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// What a bead is made of: one of the liquids, numbered from 0, wall or microparticle.
enum class Species : std::uint8_t { liquid = 0, wall = most_liquids, microparticle };
constexpr std::size_t species_count = most_liquids + 2;
constexpr Species liquid_species(std::uint32_t number) { return static_cast<Species>(number); }

/// In a mixture the lowest bits of a liquid bead's noise key are its species' number, so that the force pass
/// knows it without another load. The 29 bits that are left make as good a noise.
constexpr std::uint32_t species_bits = most_liquids - 1;

/// Where the laws between liquids come from. It is chosen once a run, so that one liquid by itself pays
/// nothing for mixtures.
enum class PairModel {
  one_liquid,  ///< one law for all pairs
  mixture,     ///< coefficients by species
  spline       ///< and Liu's potential in place of the many-body one
};
PairModel pair_model(const Parameters& parameters);

/// The law of every pair of species. Symmetric.
class PairTable {
 public:
  const MdpdLaw<double>& operator()(Species a, Species b) const { return laws_[index(a, b)]; }
  void set(Species a, Species b, const MdpdLaw<double>& law) { laws_[index(a, b)] = law; }

 private:
  static std::size_t index(Species a, Species b) {
    const auto less = static_cast<std::size_t>(std::min(a, b)),
               more = static_cast<std::size_t>(std::max(a, b));
    return more * (more + 1) / 2 + less;
  }
  std::array<MdpdLaw<double>, species_count*(species_count + 1) / 2> laws_{};
};

/// What each liquid has with all the others, as kernels look it up: by the other one's number. Whole
/// registers are loaded.
struct LawRow {
  alignas(64) float attraction[16] = {};
  alignas(64) float repulsion[16] = {};
  alignas(64) float friction[16] = {};
  alignas(64) float random_amplitude[16] = {};
};

/// What microparticles have with each liquid.
struct MicroparticleRow : LawRow {
  /// 1 for liquids that see the attraction of each microparticle, beside an `attraction` of 0; 0 for those
  /// that are attracted by all alike.
  alignas(64) float share_of_own[16] = {};
};

/// Liquid and wall share all but the attraction, which each wall bead has of its own: its wettability. So
/// have the beads of microparticles, with a repulsion B_ls of their own (Lan 3.1.2): a force without a
/// potential, because B differs between pairs that share a density (Warren 2013). Microparticle and wall
/// attract, and that is all: contact.h does the rest. Further liquids have with the others, with the wall and
/// with microparticles what MixtureParameters say; where these don't speak of microparticles, what the first
/// liquid has.
PairTable pair_table(const Parameters& parameters);

/// By number of the liquid; empty for one liquid.
AlignedVector<LawRow> law_rows(const PairTable& table, const Parameters& parameters);
MicroparticleRow microparticle_row(const PairTable& table, const Parameters& parameters);

}  // namespace dmf::engine
