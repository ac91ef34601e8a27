#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace dmf::controller {

using Channel = std::uint32_t;
using Channels = std::set<Channel>;
using Point = std::array<double, 2>;  ///< x, y in m

/// One pad as the board describes it.
struct Electrode {
  Channel channel = 0;
  std::vector<Point> outline;       ///< m, corners, not closed
  std::vector<Channel> neighbours;  ///< pads that a droplet can be pulled to from here
};

/// What a channel senses of the liquid over it.
struct Sensing {
  double liquid_capacitance = 0;  ///< of the part of the pad that is wetted, F/m^2
  double filler_capacitance = 0;  ///< of the part that is not, F/m^2
  double offset = 0;              ///< in every reading, F
  double noise = 0;               ///< standard deviation of a reading, F
};

/// What a controller knows of a board before it does anything: plain numbers, in SI units.
struct BoardDescription {
  std::vector<Electrode> electrodes;
  double gap = 0;  ///< between pads, m
  Sensing sensing;
  double threshold_voltage = 0;  ///< V rms; up to it nothing moves
};

/// The electrodes as a graph: where a droplet can go from each, and where another droplet would touch it.
class Layout {
 public:
  /// @throws InvalidInput for a channel that is given twice, a neighbour that is none, an outline without
  /// area and a liquid that can't be told from the filler.
  explicit Layout(BoardDescription board);

  bool has(Channel channel) const { return pads_.count(channel) > 0; }
  /// @throws InvalidInput "channel 9 does not exist; channels are 0-7".
  void require(Channel channel) const;
  const Channels& channels() const { return channels_; }
  const Sensing& sensing() const { return board_.sensing; }
  double threshold_voltage() const { return board_.threshold_voltage; }

  const Channels& neighbours(Channel channel) const { return pads_.at(channel).neighbours; }
  bool are_neighbours(Channel a, Channel b) const { return neighbours(a).count(b) > 0; }
  /// Channels on which another droplet would touch one on this channel: its own, its neighbours, and those
  /// that share a corner with it.
  const Channels& near(Channel channel) const { return pads_.at(channel).near; }
  /// near() of near() and so on, `rings` times; 0 is the channel itself.
  Channels within(Channel channel, int rings) const;
  double area(Channel channel) const { return pads_.at(channel).area; }  ///< m^2
  const Point& centroid(Channel channel) const { return pads_.at(channel).centroid; }
  /// a and b lie on opposite sides of `middle`: the way over it bends by less than 45 degrees.
  bool are_opposite(Channel middle, Channel a, Channel b) const;

 private:
  struct Pad {
    Channels neighbours;
    Channels near;
    Point centroid{};
    double area = 0;
  };

  BoardDescription board_;
  Channels channels_;
  std::map<Channel, Pad> pads_;
};

/// "0-3, 8, 10-12".
std::string channels_text(const Channels& channels);

}  // namespace dmf::controller
