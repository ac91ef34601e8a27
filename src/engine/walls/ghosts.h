#pragma once
#include <cstdint>
#include <vector>

#include "engine/archive.h"
#include "engine/beads.h"
#include "engine/cell_grid.h"
#include "engine/noise.h"
#include "engine/pair_law.h"
#include "engine/parameters.h"

namespace dmf::engine {

/// Images of beads that are more than shifted by a period: those beyond sheared sides (Lees and Edwards
/// 1972), which move past, and the mirror images behind symmetric sides (Lan 2.2.3). While a pass over pairs
/// runs, they stand as beads behind the last bead, so that no loop knows of them: what they feel nobody sums.
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
  /// Takes beads that left through a sheared side to its other side.
  void wrap(Beads& beads) const;
  /// Notes who has images within `range` of the domain. @param restored  with the images as they were listed.
  void list(const AlignedVector<Record>& listed, double range, bool restored = false);
  /// Appends the runs of images that a box reaches into, numbered behind `beads` beads.
  void append_runs(const Eigen::Vector3f& lower, const Eigen::Vector3f& upper, std::uint32_t beads,
                   std::vector<BeadRun>& runs) const;

  std::uint32_t source(std::size_t ghost) const { return ghosts_[ghost].source; }
  Record position(std::size_t ghost, const Beads& beads) const;
  /// Of an image of `velocity`, a bead's; w as it is.
  Record velocity(std::size_t ghost, const Record& velocity) const;

  /// Images of positions and predicted velocities behind those of the beads, and away again.
  void place(Beads& beads) const;
  void remove(Beads& beads) const;

  /// Sets right the noise between a bead and its own mirror image: the pair has one end, so that it needs
  /// sqrt(2) of what a pair gets, from a number of its own. Adds to the forces `to`.
  void correct_own_noise(const Beads& beads, AlignedVector<Record>& to) const;

  /// What a list depends on besides the beads' positions.
  void archive(Archive& archive);

 private:
  struct Ghost {
    std::uint32_t source;
    float sign[3], shift[3];
    float sheared;       ///< -1, 0, 1: how often beyond the upper sheared side
    std::uint32_t salt;  ///< which mirrors: 0 for none
  };
  struct Mirror {
    int axis;
    bool upper;
  };
  std::uint32_t key_change(std::uint32_t salt) const;

  Domain search_;
  bool sheared_;
  std::vector<Mirror> mirrors_;
  double speed_, width_, height_;  ///< of the upper image along x, r_c / tau; of the box, r_c
  MdpdLaw<double> law_;
  std::uint64_t seed_;
  double offset_ = 0, listed_offset_ = 0;  ///< of the upper image, in [-width / 2, width / 2]
  float moved_ = 0;
  StepKey key_{};
  std::vector<Ghost> ghosts_;
  CellGrid grid_;
};

/// Has the images there as long as it lives.
class GhostsInPlace {
 public:
  GhostsInPlace(const Ghosts& ghosts, Beads& beads) : ghosts_(ghosts), beads_(beads) {
    if (ghosts_.needed()) ghosts_.place(beads_);
  }
  ~GhostsInPlace() {
    if (ghosts_.needed()) ghosts_.remove(beads_);
  }
  GhostsInPlace(const GhostsInPlace&) = delete;
  GhostsInPlace& operator=(const GhostsInPlace&) = delete;

 private:
  const Ghosts& ghosts_;
  Beads& beads_;
};

}  // namespace dmf::engine
