#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/archive.h"
#include "engine/beads.h"
#include "engine/chain.h"
#include "engine/membrane.h"
#include "engine/parameters.h"
#include "engine/walls/sheared_domain.h"

namespace dmf::engine {

/// A chain in a run. Its beads stand in the order in which they are bound.
struct Chain {
  std::uint32_t id = 0;
  Spring spring;
  Vector3d stretching_force = Vector3d::Zero();
  SpringLaw law;
  std::vector<std::uint32_t> beads;    ///< ids
  std::vector<std::uint32_t> indices;  ///< where they stand in Beads now
};

/// A membrane in a run. Its beads stand in the order of the vertices.
struct Membrane {
  std::uint32_t id = 0;
  MembranePlacement placement;
  MembraneNetwork network;
  std::vector<std::uint32_t> beads;    ///< ids
  std::vector<std::uint32_t> indices;  ///< where they stand in Beads now
};

/// All moving beads that are bound to each other: chains and membranes. A bead belongs to one of them at
/// most, and each is worked on by one thread in an order of its own: sums depend neither on threads nor on
/// where beads are stored. That is also a debt: one large membrane keeps one thread busy.
class Bonds {
 public:
  explicit Bonds(const Parameters& parameters);

  bool empty() const { return chains_.empty() && membranes_.empty(); }
  const std::vector<Chain>& chains() const { return chains_; }
  const std::vector<Membrane>& membranes() const { return membranes_; }
  std::size_t bead_count() const;
  std::uint32_t next_chain() const { return next_chain_; }  ///< id of the next one

  /// Where images beyond sheared sides stand from now on.
  void set_images(const ShearedDomain& images) { images_ = images; }

  /// Binds beads that are there. @returns the id. find() must come next.
  std::uint32_t bind_chain(const Spring& spring, const Vector3d& stretching_force,
                           std::vector<std::uint32_t> bead_ids);
  std::uint32_t bind_membrane(const MembranePlacement& placement, std::vector<std::uint32_t> bead_ids);
  /// Beads are taken out: what is bound to one of them goes too.
  /// @param gone  by bead id; completed.
  void remove_with(std::vector<bool>& gone);

  /// Beads were sorted, added or taken out: finds where those that are bound stand now.
  /// @pre all of them are there.
  void find(const Beads& beads);

  /// Adds the forces of all bonds to `beads.force`. @returns what is wrong when a bond is as long as it can
  /// be, with bond, beads and length; else nothing.
  std::string add_forces(Beads& beads) const;

  /// Calls visit(bead, r_i - r_j, its share of the stress r (x) F) for what the bonds do, by storage index:
  /// half of a chain's bond for each of its beads. A membrane's forces are not those of pairs: each of its
  /// beads has its place from the centroid times the force on it, and no r_j (0). What stretches chains is
  /// left out.
  void for_each_stress(
      const Beads& beads,
      const std::function<void(std::uint32_t, const Vector3d&, const Eigen::Matrix3d&)>& visit) const;

  std::vector<ChainObservation> observe_chains(const Beads& beads) const;
  std::vector<MembraneObservation> observe_membranes(const Beads& beads) const;

  /// Of who is bound to whom and how.
  std::uint64_t hash() const;

  void archive(Archive& archive);
  /// Of what was read. @throws InvalidInput when a bead is not there or bound twice.
  void require_sound(const Beads& beads) const;

 private:
  std::vector<Vector3d> positions_of(const Chain& chain, const Beads& beads) const;
  std::vector<Vector3d> positions_of(const Membrane& membrane, const Beads& beads) const;
  bool add_forces(const Chain& chain, Beads& beads) const;
  bool add_forces(const Membrane& membrane, Beads& beads) const;
  std::string overstretched(const Chain& chain, const Beads& beads) const;
  std::string overstretched(const Membrane& membrane, const Beads& beads) const;

  Parameters parameters_;
  ShearedDomain images_;
  double longest_;  ///< bond that periodic sides allow, r_c
  std::uint32_t next_chain_ = 1, next_membrane_ = 1;
  std::vector<Chain> chains_;
  std::vector<Membrane> membranes_;
  std::vector<std::uint32_t> index_of_id_;  ///< scratch of find()
};

/// The longest bond whose nearest image is beyond doubt: a third of the shortest periodic side, infinite
/// without one, r_c.
double longest_bond(const Domain& domain);

}  // namespace dmf::engine
