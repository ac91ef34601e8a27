#pragma once
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "engine/archive.h"
#include "engine/beads.h"
#include "engine/observe/contact_angle.h"
#include "engine/observe/snapshot.h"
#include "engine/pairs.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// Finds droplets and keeps their identity. A droplet is a set of at least `fewest_beads` beads of one liquid
/// connected by distances below r_c, with what is dissolved in it (solvents.h); in a mixture a medium that
/// fills the box is one, too. Looks at the beads at fixed steps, so that ids, events and running averages are
/// functions of the run and not of who watches it.
///
/// Identity: a droplet's heir is the component that holds most of its beads. A component goes on under the id
/// of the largest droplet whose heir it is; others whose heir it is too have merged into it. A component that
/// is nobody's heir but holds at least `fewest_beads` beads of a droplet has split from it.
class DropletTracker {
 public:
  static constexpr std::size_t fewest_beads = 20;

  explicit DropletTracker(const Parameters& parameters);

  /// Needs who is in range now: the density pass must have run on these positions.
  /// @param solvents  the liquid that each bead counts to; empty: its own species.
  void update(std::uint64_t step, const Beads& beads, const Pairs& pairs,
              const std::vector<std::uint8_t>& solvents);

  const std::vector<DropletObservation>& droplets() const { return droplets_; }  ///< by id
  std::size_t vapour_beads() const { return vapour_beads_; }
  /// 0 for vapour and for beads placed since the last update.
  std::uint32_t droplet_of(std::uint32_t bead_id) const {
    return bead_id < droplet_of_bead_.size() ? droplet_of_bead_[bead_id] : 0;
  }
  /// Beads with ids below this were in a droplet at some look, but for vapour among them.
  std::size_t known_beads() const { return droplet_of_bead_.size(); }
  /// The droplet that each bead of the vapour was last part of, or what that one has merged into; by bead id.
  /// Beads that were placed as vapour, or whose droplet was taken off the chip, are left out.
  const std::map<std::uint32_t, std::uint32_t>& evaporated_from() const { return evaporated_from_; }
  /// A droplet is about to be taken off the chip: what evaporated from it before is nobody's loss.
  void forget(std::uint32_t droplet);
  std::vector<DropletEvent> take_events() { return std::exchange(events_, {}); }

  /// @throws InvalidInput when what is read can't be a tracker's.
  void archive(Archive& archive);

 private:
  void require_sound() const;

  struct Component {
    std::vector<std::uint32_t> beads;                 ///< indices
    std::vector<Eigen::Vector3f> positions;           ///< unwrapped: continuous across periodic sides
    Vector3d velocity = Vector3d::Zero();             ///< of its centroid
    std::map<std::uint32_t, std::size_t> beads_from;  ///< by previous droplet
    std::uint32_t id = 0;
    std::uint32_t species = 0;  ///< number of the liquid
  };
  /// What is remembered of a droplet between two looks.
  struct Memory {
    std::vector<std::uint32_t> parents;
    Vector3d velocity = Vector3d::Zero();  ///< relative to a shear flow where there is one
    RunningAngles angles;
  };

  std::vector<Component> connected_components(const Beads& beads, const Pairs& pairs,
                                              const std::vector<std::uint8_t>& solvents) const;
  /// @returns for each droplet that has merged into another one: which.
  std::map<std::uint32_t, std::uint32_t> give_identities(std::uint64_t step,
                                                         std::vector<Component>& components);
  DropletObservation measure(const Component& component, const Pairs& pairs, double elapsed);
  void measure_angles(DropletObservation& droplet, const Component& component, double elapsed);

  Parameters parameters_;
  double wall_plane_;
  std::uint64_t last_step_ = 0;
  std::uint32_t next_id_ = 1;
  std::size_t vapour_beads_ = 0;
  std::vector<std::uint32_t> droplet_of_bead_;              ///< by bead id
  std::map<std::uint32_t, std::uint32_t> evaporated_from_;  ///< droplet, by bead id
  std::map<std::uint32_t, Memory> memory_;                  ///< by droplet id
  std::vector<DropletObservation> droplets_;
  std::vector<DropletEvent> events_;
};

}  // namespace dmf::engine
