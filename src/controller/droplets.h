#pragma once
#include <map>
#include <optional>
#include <vector>

#include "controller/layout.h"

namespace dmf::controller {

/// What the board sensed of every channel at one moment.
struct Reading {
  double time = 0;                        ///< s
  std::map<Channel, double> capacitance;  ///< F
};

/// How much of each pad is wetted, 0 to 1, and a little beyond by the noise of the reading.
using Wetting = std::map<Channel, double>;

/// A pad of area A of which the fraction f is wetted has the capacitance C = offset + (f c_liquid + (1 - f)
/// c_filler) A; this is f. A channel without a reading counts as dry.
Wetting wetting_of(const Layout& layout, const Reading& reading);

/// A droplet as far as a board can know it: the electrodes on which it is sensed.
struct Droplet {
  std::uint32_t id = 0;  ///< from 1, kept while it is sensed, never used twice
  Channels channels;     ///< wetted beyond the threshold, connected
  Channel main = 0;      ///< the one that is wetted most
  double covered = 0;    ///< sum of the wetted fractions: how many electrodes it covers
};

/// Finds droplets from capacitance alone, as with a real board: electrodes that are wetted beyond a threshold
/// and are neighbours belong to one droplet. Two droplets side by side on neighbouring electrodes can't be
/// told from one; whoever moves droplets keeps an electrode free between them.
class DropletFinder {
 public:
  /// @param threshold  fraction of a pad, (0, 1): below it the pad only borders on a droplet, or two droplets
  /// beside it spill onto it.
  DropletFinder(const Layout& layout, double threshold) : layout_(layout), threshold_(threshold) {}

  /// The droplets of this moment by rising id. One keeps the id of the droplet before with which it has most
  /// in common, or else of one that was on a neighbouring electrode.
  const std::vector<Droplet>& update(const Wetting& wetting);
  const std::vector<Droplet>& droplets() const { return droplets_; }
  const Droplet* on(Channel channel) const;  ///< nullptr: none
  double threshold() const { return threshold_; }

 private:
  const Layout& layout_;
  double threshold_;
  std::vector<Droplet> droplets_;
  std::uint32_t next_id_ = 1;
};

}  // namespace dmf::controller
