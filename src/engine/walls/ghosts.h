#pragma once
#include <cstdint>
#include <vector>

#include "engine/archive.h"
#include "engine/beads.h"
#include "engine/bodies/body_beads.h"
#include "engine/cell_grid.h"
#include "engine/noise.h"
#include "engine/pair_law.h"
#include "engine/parameters.h"
#include "engine/walls/sheared_domain.h"

namespace dmf::engine {

/// Images of beads that are more than shifted by a period: those beyond sheared sides (Lees and Edwards
/// 1972), which move past, and the mirror images behind symmetric sides (Lan 2.2.3). While a pass over pairs
/// runs, they stand as beads behind the last bead, so that no loop knows of them: what they feel nobody sums.
/// Beads of microparticles have images of their own, likewise.
///
/// A run without such sides has none of it.
class Ghosts {
 public:
  explicit Ghosts(const Parameters& parameters);

  /// The domain as the search for pairs shall see it: sheared sides are closed.
  const Domain& search_domain() const { return search_; }
  bool needed() const { return sheared_ || !mirrors_.empty(); }
  std::size_t size() const { return ghosts_.size(); }

  /// Where the images beyond sheared sides are at a time, tau, and noise for one's own mirror image.
  void advance(double time, std::uint64_t step);
  /// How far they have moved since they were listed, r_c.
  float moved() const { return moved_; }
  /// The box with its images as they stand.
  ShearedDomain images() const { return {domain_, offset_, speed_}; }
  /// Takes beads that left through a sheared side to its other side.
  void wrap(Beads& beads) const;
  /// Notes who has images within `range` of the domain.
  /// @param protrusion  how far beyond sheared sides microparticles look for them besides, r_c.
  /// @param restored    with the images as they were listed.
  void list(const AlignedVector<Record>& listed, double range, double protrusion, bool restored);
  /// Appends the runs of images that a box reaches into, numbered behind the beads.
  void append_runs(const Eigen::Vector3f& lower, const Eigen::Vector3f& upper,
                   std::vector<BeadRun>& runs) const;

  // Of a bead, or of an image by its number among the beads:
  std::uint32_t source(std::uint32_t bead) const { return bead < beads_ ? bead : ghost(bead).source; }
  Record position(std::uint32_t bead, const Beads& beads) const;
  /// @param velocity  of the source; w as it is.
  Record velocity(std::uint32_t bead, const Record& velocity) const;
  /// What the source feels of the image of something that pushes the bead with this force.
  Vector3d force_on_source(std::uint32_t bead, const Vector3d& force) const;

  /// Beads of microparticles that stand together, and the box that they were in when they were listed.
  struct Patch {
    std::uint32_t begin, end;
    Eigen::Vector3f lower, upper;
  };
  /// Notes the images of a microparticle within `range` of the domain, patch by patch.
  /// @param body_beads  how many beads all microparticles have: images are numbered behind them.
  /// @returns the patches of each image.
  std::vector<std::vector<Patch>> list_body(const std::vector<Patch>& patches, double range,
                                            std::size_t body_beads);
  void forget_bodies() { of_bodies_.clear(); }

  /// Images of positions and velocities behind those of the beads, and away again.
  void place(Beads& beads, BodyBeads& bodies) const;
  void remove(Beads& beads, BodyBeads& bodies) const;

  /// Sets right the noise between a bead and its own mirror image: the pair has one end, so that it needs
  /// sqrt(2) of what a pair gets, from a number of its own. Adds to the forces `to`.
  void correct_own_noise(const Beads& beads, AlignedVector<Record>& to) const;

  /// What a list depends on besides the beads' positions.
  void archive(Archive& archive);

 private:
  /// How an image comes from what it is of.
  struct Image {
    float sign[3] = {1, 1, 1}, shift[3] = {0, 0, 0};
    float sheared = 0;       ///< -1, 0, 1: how often beyond the upper sheared side
    std::uint32_t salt = 0;  ///< which mirrors: 0 for none
  };
  struct Ghost {
    std::uint32_t source;
    Image image;
  };
  /// An image of a box, and where that stands.
  struct BoxImage {
    Image image;
    Eigen::Vector3f lower, upper;
  };
  struct Mirror {
    int axis;
    bool upper;
  };
  /// Those images of a box that are within `range` of the domain, behind the box itself. Beyond sheared
  /// sides, where they were listed, within that and `protrusion`.
  void find_images(const Eigen::Vector3f& lower, const Eigen::Vector3f& upper, double range,
                   double protrusion, std::vector<BoxImage>& found) const;
  Record position(const Image& image, const Record& of, double offset) const;
  Record velocity(const Image& image, const Record& of) const;
  std::uint32_t key_change(std::uint32_t salt) const;
  const Ghost& ghost(std::uint32_t bead) const { return ghosts_[bead - beads_]; }

  Domain domain_, search_;
  bool sheared_;
  std::vector<Mirror> mirrors_;
  double speed_, width_, height_;  ///< of the upper image along x, r_c / tau; of the box, r_c
  MdpdLaw<double> law_;
  std::uint64_t seed_;
  double offset_ = 0, listed_offset_ = 0;  ///< of the upper image, in [-width / 2, width / 2]
  float moved_ = 0;
  StepKey key_{};
  std::uint32_t beads_ = 0xffffffffu;  ///< how many there are: images are numbered behind them
  std::vector<Ghost> ghosts_, of_bodies_;
  CellGrid grid_;
};

/// Has the images there as long as it lives.
class GhostsInPlace {
 public:
  GhostsInPlace(const Ghosts& ghosts, Beads& beads, BodyBeads& bodies)
      : ghosts_(ghosts), beads_(beads), bodies_(bodies) {
    if (ghosts_.needed()) ghosts_.place(beads_, bodies_);
  }
  ~GhostsInPlace() {
    if (ghosts_.needed()) ghosts_.remove(beads_, bodies_);
  }
  GhostsInPlace(const GhostsInPlace&) = delete;
  GhostsInPlace& operator=(const GhostsInPlace&) = delete;

 private:
  const Ghosts& ghosts_;
  Beads& beads_;
  BodyBeads& bodies_;
};

}  // namespace dmf::engine
