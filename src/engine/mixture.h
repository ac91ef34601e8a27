#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace dmf::engine {

/// Liquids that a run may hold: what numbers them fits the lowest bits of a bead's noise key (species.h).
constexpr std::size_t most_liquids = 8;

/// What the law of one pair of species has of its own. Ranges, exponent and temperature are those of
/// LiquidParameters for all.
struct PairCoefficients {
  double attraction = 0;        ///< A_ij < 0 attracts; with repulsion 0 plain DPD's a_ij; [-200, 200]
  double repulsion = 0;         ///< B_ij; [0, 500]
  double random_amplitude = 0;  ///< phi_ij; gamma_ij = phi_ij^2 / (2 k_BT); [0, 50]
};

/// A liquid beside the first one, which LiquidParameters describe.
struct FurtherLiquid {
  std::string name;
  PairCoefficients own;        ///< of two of its beads
  double initial_density = 6;  ///< beads per r_c^3 where it is placed; [1, 12]
  double bulk_density = 6.06;  ///< of the liquid at rest, for volumes and surfaces; [1, 20]
};

/// The law of two different species, in either order.
struct PairOfSpecies {
  std::string first, second;  ///< names of further liquids, "liquid", "wall" or "microparticle"
  PairCoefficients coefficients;
};

/// Several liquids in one run. Every pair that can meet needs a law: liquids with each other, and, over a
/// wall, further liquids with the wall. That of the first liquid with the wall may be given too; then all of
/// the wall shows it, and takes no contact angles.
///
/// A further liquid that is given a law with microparticles has it with all of them, whatever their A_ls: so
/// a surfactant's tails can cover what its heads and the liquid keep off. Without one it has with them what
/// the first liquid has.
///
/// In the many-body density all liquids count alike. So the force has a potential only when B is the same for
/// all pairs (Warren 2013): notices() says when it is not.
struct MixtureParameters {
  std::vector<FurtherLiquid> liquids;  ///< numbered from 1; 0 is LiquidParameters'
  std::vector<PairOfSpecies> pairs;
};

/// Names that a pair may have besides those of further liquids.
constexpr const char* first_liquid_name = "liquid";
constexpr const char* wall_name = "wall";
constexpr const char* microparticle_name = "microparticle";

struct Parameters;

/// Violated ranges, pairs without a law or with two, unknown and repeated names; each "key: value, allowed:
/// range".
std::vector<std::string> mixture_violations(const Parameters& parameters);

/// What is allowed but should be known about a run's laws, one sentence each.
std::vector<std::string> notices(const Parameters& parameters);

// Of a liquid by its number, 0 up to mixture.liquids.size().
std::string liquid_name(const Parameters& parameters, std::uint32_t liquid);
double initial_density(const Parameters& parameters, std::uint32_t liquid);
double bulk_density(const Parameters& parameters, std::uint32_t liquid);

/// The law of two different species, named in either order, when the mixture gives one; null otherwise.
const PairCoefficients* coefficients_of(const Parameters& parameters, const std::string& one,
                                        const std::string& other);
/// That of the first liquid with the wall.
const PairCoefficients* wall_coefficients(const Parameters& parameters);

/// What all of the wall attracts the first liquid with, where that is given in place of contact angles: by
/// the mixture, or as WallParameters::attraction.
std::optional<double> fixed_wall_attraction(const Parameters& parameters);

/// The number of the liquid of that name. @throws InvalidInput naming those there are.
std::uint32_t liquid_named(const Parameters& parameters, const std::string& name);

}  // namespace dmf::engine
