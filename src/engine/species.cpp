#include "engine/species.h"

#include <cmath>

namespace dmf::engine {

namespace {

MdpdLaw<double> law_of(const PairCoefficients& coefficients, const Parameters& parameters) {
  LiquidParameters liquid = parameters.liquid;
  liquid.attraction = coefficients.attraction;
  liquid.repulsion = coefficients.repulsion;
  liquid.random_amplitude = coefficients.random_amplitude;
  return liquid_law(liquid, parameters.time_step);
}

Species species_named(const Parameters& parameters, const std::string& name) {
  if (name == wall_name) return Species::wall;
  if (name == microparticle_name) return Species::microparticle;
  return liquid_species(liquid_named(parameters, name));
}

void set_coefficients(LawRow& row, std::uint32_t number, const MdpdLaw<double>& law) {
  row.attraction[number] = static_cast<float>(law.attraction);
  row.repulsion[number] = static_cast<float>(law.repulsion);
  row.friction[number] = static_cast<float>(law.friction);
  row.random_amplitude[number] = static_cast<float>(law.random_amplitude);
}

}  // namespace

PairModel pair_model(const Parameters& parameters) {
  if (parameters.spline.used) return PairModel::spline;
  return parameters.mixture.liquids.empty() ? PairModel::one_liquid : PairModel::mixture;
}

PairTable pair_table(const Parameters& parameters) {
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

  const MixtureParameters& mixture = parameters.mixture;
  for (std::uint32_t k = 1; k <= mixture.liquids.size(); ++k) {
    const Species further = liquid_species(k);
    table.set(further, further, law_of(mixture.liquids[k - 1].own, parameters));
    table.set(further, Species::wall, table(further, further));  // where there is no wall, of any
    table.set(further, Species::microparticle, on_microparticle);
  }
  for (const PairOfSpecies& pair : mixture.pairs)
    table.set(species_named(parameters, pair.first), species_named(parameters, pair.second),
              law_of(pair.coefficients, parameters));
  return table;
}

AlignedVector<LawRow> law_rows(const PairTable& table, const Parameters& parameters) {
  if (pair_model(parameters) == PairModel::one_liquid) return {};
  const auto count = static_cast<std::uint32_t>(parameters.mixture.liquids.size() + 1);
  AlignedVector<LawRow> rows(most_liquids);  // whatever the bits of a key say, there is a row
  for (std::uint32_t i = 0; i < count; ++i)
    for (std::uint32_t j = 0; j < count; ++j)
      set_coefficients(rows[i], j, table(liquid_species(i), liquid_species(j)));
  return rows;
}

MicroparticleRow microparticle_row(const PairTable& table, const Parameters& parameters) {
  MicroparticleRow row;
  const MixtureParameters& mixture = parameters.mixture;
  for (std::uint32_t number = 0; number <= mixture.liquids.size(); ++number) {
    set_coefficients(row, number, table(liquid_species(number), Species::microparticle));
    const bool alike = coefficients_of(parameters, liquid_name(parameters, number), microparticle_name);
    row.share_of_own[number] = alike ? 0.f : 1.f;
    if (!alike) row.attraction[number] = 0.f;
  }
  return row;
}

}  // namespace dmf::engine
