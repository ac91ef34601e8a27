#pragma once
#include <cstdint>

namespace dmf::engine {

/// All randomness of a run on one page. Every number is a function of (seed, step, stream, ids), never of
/// storage order, threads or what was drawn before.
///
/// | stream     | drawn for                                   | ids                                 |
/// | ---------- | ------------------------------------------- | ----------------------------------- |
/// | pair       | zeta_ij of the random force, liquid-liquid  | both bead ids, symmetric            |
/// | wall       | zeta_ij of the random force, liquid-wall    | bead id, wall bead index            |
/// | body       | zeta_ij of the random force, liquid-body     | bead id, index of the body's bead   |
/// | frozen     | the force of a frozen particle on a bead    | bead id, side, component            |
/// | velocity   | thermal velocities of a newly placed bead   | bead id, component                  |
/// | sensing    | noise of a reading of the capacitance       | channel                             |
/// | chain      | place and walk of a chain's beads           | chain id, number of the draw        |
/// | reflection | velocity of a bead that a side sends back   | bead id, number of the side it met  |
/// | mirror     | zeta_ij with the mirror image of a bead     | both bead ids, symmetric; mirrors   |
///
/// A wall, body or frozen pair mixes the liquid bead's key of the pair stream with a fixed key of the other.
/// The steps of the reflection stream are drifts: BAOAB has two a step.
/// The pair stream costs one hash a bead and step (`bead_key`) plus one hash a pair (`mix` in noise-inl.h).
enum class Stream : std::uint32_t {
  pair = 1,
  velocity = 2,
  sensing = 3,
  chain = 10,
  reflection = 11,
  mirror = 12
};

/// The two words that make a step's keys: from (seed, step, stream).
struct StepKey {
  std::uint32_t first, second;
};

/// 64-bit finaliser of SplitMix64 (Steele, Lea, Flood 2014): a bijection in which every output bit depends on
/// every input bit.
inline std::uint64_t mix64(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

inline StepKey step_key(std::uint64_t seed, std::uint64_t step, Stream stream) {
  const std::uint64_t key =
      mix64(mix64(mix64(seed) + step * 0x9e3779b97f4a7c15ull) + static_cast<std::uint32_t>(stream));
  return {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)};
}

/// 32-bit mixer found by exhaustive search for low avalanche bias (Wellons 2018, "prospecting for hash
/// functions"), the same that noise-inl.h applies to lanes.
inline std::uint32_t mix32(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x21f0aaadu;
  x ^= x >> 15;
  x *= 0xd35a2d97u;
  x ^= x >> 15;
  return x;
}

/// Key of one bead in one step; the pair noise mixes two of them.
inline std::uint32_t bead_key(StepKey key, std::uint32_t id) {
  return mix32(mix32(id ^ key.first) + key.second);
}

/// A number of zero mean and unit variance: twelve uniform ones added up (Irwin and Hall), which is Gaussian
/// enough up to six deviations. Needs no logarithm, whose last bit depends on the processor.
/// @param component  up to 3 independent numbers an id: 0, 1, 2.
inline double gaussian_noise(StepKey key, std::uint32_t id, std::uint32_t component) {
  double sum = -6.0;
  for (std::uint32_t word = 0; word < 6; ++word) {
    const std::uint32_t bits = bead_key(key, id * 18 + 6 * component + word);
    sum += ((bits & 0xffffu) + 0.5) / 65536.0 + ((bits >> 16) + 0.5) / 65536.0;
  }
  return sum;
}

}  // namespace dmf::engine
