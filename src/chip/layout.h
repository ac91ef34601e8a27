#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "chip/electrode_index.h"

namespace dmf::chip {

using Eigen::Vector2d;

/// One pad of the chip. Outline in reduced units (r_c), counter-clockwise, not closed, on the wall plane.
struct Electrode {
  std::uint32_t channel = 0;
  std::vector<Vector2d> outline;
  /// Channels of electrodes at most one gap (and a rounding error) away, rising. Filled in by Layout.
  std::vector<std::uint32_t> neighbours;
  Vector2d centroid = Vector2d::Zero();  ///< filled in by Layout
};

/// A rectangular array of square electrodes, numbered row by row: the channel of (column, row) is
/// first_channel + row * columns + column. A hole has no electrode, and its number stays unused.
struct ElectrodeGrid {
  Vector2d origin = Vector2d::Zero();  ///< centre of column 0, row 0, r_c
  std::uint32_t columns = 1;
  std::uint32_t rows = 1;
  double pitch = 1;  ///< from centre to centre, r_c; an electrode is pitch - gap wide
  std::uint32_t first_channel = 0;
  std::vector<std::array<std::uint32_t, 2>> holes;  ///< (column, row)
};

/// The electrodes of a grid, outline and channel only.
/// @throws engine::InvalidInput when gap >= pitch, a hole is outside the grid or given twice.
std::vector<Electrode> electrodes_of(const ElectrodeGrid& grid, double gap);

/// The electrodes of a chip and how far the wettability ramps between them.
class Layout {
 public:
  /// No electrode: a bare plate.
  Layout() = default;
  /// @param electrodes  channel and outline, either way round; may be empty.
  /// @param gap  width over which the contact angle ramps from one electrode to the next, r_c, > 0.
  /// @throws engine::InvalidInput naming every duplicate channel, outline with fewer than 3 corners, with a
  /// non-finite corner or that crosses itself, and every overlapping pair.
  Layout(std::vector<Electrode> electrodes, double gap);

  const std::vector<Electrode>& electrodes() const { return electrodes_; }
  double gap() const { return gap_; }
  /// Index into electrodes(). @throws engine::InvalidInput "channel 9 does not exist; channels are 0-7".
  std::size_t index_of(std::uint32_t channel) const;
  /// "0-7" or "0-3, 8, 10-12": the channels there are, for messages.
  std::string channels_text() const;

  /// The weight of each electrode at a point p. With d_i the distance from p to electrode i, 0 inside, and
  /// the gap g:
  ///
  ///     w_i = max(0, g - d_i),   w_bare = max(0, g - sum w_i),   all divided by their sum.
  ///
  /// So it is 1 inside an electrode whose neighbours are a gap or more away, goes linearly from one to the
  /// other across the gap between two parallel edges, and fades to the bare plate within a gap. Continuous
  /// everywhere. Calls `visit(index, weight)` for each weight > 0, by rising index, and returns the weight of
  /// the bare plate.
  double weights(const Vector2d& point, const std::function<void(std::size_t, double)>& visit) const;

  /// Indices of the electrodes that share an area with a polygon, rising. Empty for fewer than 3 corners.
  std::vector<std::size_t> overlapping(const std::vector<Vector2d>& polygon) const;

 private:
  std::vector<Electrode> electrodes_;
  double gap_ = 1;
  ElectrodeIndex near_;  ///< electrodes within a gap of a point
};

}  // namespace dmf::chip
