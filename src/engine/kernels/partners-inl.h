// What a bead meets at the other ends of its pairs, a pair a lane, and the law that they share. Compiled per
// instruction set.
#if defined(DMF_ENGINE_PARTNERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DMF_ENGINE_PARTNERS_INL_H
#undef DMF_ENGINE_PARTNERS_INL_H
#else
#define DMF_ENGINE_PARTNERS_INL_H
#endif

#include <cstring>

#include "engine/kernels/kernels.h"
#include "engine/kernels/lanes-inl.h"
#include "engine/noise-inl.h"
#include "engine/pair_law-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dmf::engine::HWY_NAMESPACE {

HWY_INLINE MdpdLaw<Lanes> in_lanes(const MdpdLaw<double>& law) {
  const auto lanes = [](double value) HWY_ATTR { return Lanes(static_cast<float>(value)); };
  return {lanes(law.attraction),
          lanes(law.repulsion),
          lanes(law.inverse_cutoff_radius),
          lanes(law.inverse_repulsion_radius),
          lanes(law.friction),
          lanes(law.random_amplitude),
          lanes(law.inverse_dissipation_radius),
          law.twice_dissipation_exponent};
}

HWY_INLINE SplineLaw<Lanes> in_lanes(const SplineLaw<double>& law) {
  const auto lanes = [](double value) HWY_ATTR { return Lanes(static_cast<float>(value)); };
  const SplineShape<double>& shape = law.shape;
  return {in_lanes(static_cast<const MdpdLaw<double>&>(law)),
          {lanes(shape.repulsion), lanes(shape.repulsion_rate), lanes(shape.attraction),
           lanes(shape.attraction_rate)}};
}

/// What a liquid's bead has with another species.
template <PairModel model>
HWY_INLINE auto law_between(const PairPass& pass, Species liquid, Species other) {
  const MdpdLaw<double>& law = pass.laws(liquid, other);
  if constexpr (model == PairModel::spline)
    return in_lanes(SplineLaw<double>{law, pass.spline});
  else
    return in_lanes(law);
}

/// Separation r_i - r_j, by the nearest image where `across_periodic`.
struct Separation {
  Lanes x, y, z;
};

HWY_INLINE Lanes nearest_image(Lanes d, float period, float inverse_period) {
  return d - Lanes(period) * nearest_integer(d * Lanes(inverse_period));
}

template <bool across_periodic>
HWY_INLINE Separation separation(const PairPass& pass, const Record& i, Lanes x, Lanes y, Lanes z) {
  Separation d{Lanes(i.x) - x, Lanes(i.y) - y, Lanes(i.z) - z};
  if constexpr (across_periodic) {
    d.x = nearest_image(d.x, pass.period.x(), pass.inverse_period.x());
    d.y = nearest_image(d.y, pass.period.y(), pass.inverse_period.y());
    d.z = nearest_image(d.z, pass.period.z(), pass.inverse_period.z());
  }
  return d;
}

/// Of a bead of a mixture.
HWY_INLINE std::uint32_t species_number(const Record& position) {
  std::uint32_t key;
  std::memcpy(&key, &position.w, sizeof key);
  return key & species_bits;
}

/// The bead that the forces are summed for.
struct Receiver {
  const Record& position;
  const Record& moving;  ///< velocity; w: density
  UnsignedLanes key;
};

/// What it meets at the other ends of some pairs, a pair a lane.
struct Partners {
  Lanes x, y, z, vx, vy, vz, density, attraction;
  UnsignedLanes key;
};

/// Liquid, named by slot for liquid, by index for a microparticle's bead, which says how much it attracts.
template <class Indices>
struct Liquid {
  const PairPass& pass;
  Indices indices;
  Lanes attraction;
  HWY_INLINE Partners load(std::size_t k) const {
    Partners j;
    Lanes key;
    load_records(pass.position, indices.from(k), j.x, j.y, j.z, key);
    load_records(pass.predicted, indices.from(k), j.vx, j.vy, j.vz, j.density);
    j.attraction = attraction;
    j.key = bits_of(key);
    return j;
  }
};

/// Beads of microparticles met by liquid.
struct BodyBeads {
  const PairPass& pass;
  const std::uint32_t* indices;
  HWY_INLINE Partners load(std::size_t k) const {
    Partners j;
    load_records(pass.bodies.position, BeadIndices{indices + k}, j.x, j.y, j.z, j.attraction);
    load_records(pass.bodies.moving, BeadIndices{indices + k}, j.vx, j.vy, j.vz, j.density);
    j.key = gather(pass.bodies.key, indices + k);
    return j;
  }
};

/// Wall beads: they rest beside the receiver, and count in no density.
struct WallBeads {
  const PairPass& pass;
  const std::uint32_t* indices;
  HWY_INLINE Partners load(std::size_t k) const {
    Partners j;
    load_records(pass.wall, BeadIndices{indices + k}, j.x, j.y, j.z, j.attraction);
    j.vx = j.vy = j.vz = j.density = Lanes(0);
    j.key = wall_key(load_lanes(indices + k));
    return j;
  }
};

/// Wall beads met by a microparticle: they all attract it alike.
struct WallUnderBody {
  WallBeads beads;
  Lanes attraction;
  HWY_INLINE Partners load(std::size_t k) const {
    Partners j = beads.load(k);
    j.attraction = attraction;
    return j;
  }
};

/// Beads of walls or microparticles met by a liquid for which all of them are alike, or by one that sees the
/// attraction of each.
template <class Others>
struct SeenInMixture {
  Others beads;
  Lanes share_of_own;  ///< 1: of each bead, 0: the same of all
  Lanes of_all;
  HWY_INLINE Partners load(std::size_t k) const {
    Partners j = beads.load(k);
    j.attraction = share_of_own * j.attraction + of_all;
    return j;
  }
};

/// What one liquid has with all the others, looked up by the species in their keys.
template <class Law>
struct LawsOfLiquid {
  Law law;  ///< what all pairs share
  LaneTable attraction, repulsion, friction, random_amplitude;

  HWY_INLINE LawsOfLiquid(const Law& shared, const LawRow& row)
      : law(shared),
        attraction(row.attraction),
        repulsion(row.repulsion),
        friction(row.friction),
        random_amplitude(row.random_amplitude) {}
};

/// What a bead of a microparticle has with the liquids of a mixture.
template <class Law>
struct LawsOfMicroparticle {
  LawsOfLiquid<Law> laws;
  LaneTable share_of_own;

  HWY_INLINE LawsOfMicroparticle(const Law& shared, const MicroparticleRow& row)
      : laws(shared, row), share_of_own(row.share_of_own) {}
};

/// The law of the pairs with `j`, whose attraction stands in it: one for all ...
HWY_INLINE const MdpdLaw<Lanes>& law_with(const MdpdLaw<Lanes>& law, Partners&) { return law; }
HWY_INLINE const SplineLaw<Lanes>& law_with(const SplineLaw<Lanes>& law, Partners&) { return law; }
/// ... or one for each.
template <class Law>
HWY_INLINE Law law_with(const LawsOfLiquid<Law>& laws, Partners& j) {
  const UnsignedLanes species = j.key & UnsignedLanes(species_bits);
  Law law = laws.law;
  j.attraction = laws.attraction[species];
  law.repulsion = laws.repulsion[species];
  law.friction = laws.friction[species];
  law.random_amplitude = laws.random_amplitude[species];
  return law;
}
/// Its own attraction stands in `j`.
template <class Law>
HWY_INLINE Law law_with(const LawsOfMicroparticle<Law>& laws, Partners& j) {
  const Lanes own = laws.share_of_own[j.key & UnsignedLanes(species_bits)] * j.attraction;
  const Law law = law_with(laws.laws, j);
  j.attraction = j.attraction + own;
  return law;
}

}  // namespace dmf::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
