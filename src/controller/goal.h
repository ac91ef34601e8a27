#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "controller/layout.h"

namespace dmf::controller {

/// When a step is done, and when it is given up. Times in s of the controller's clock.
struct Limits {
  double success_threshold = 0.8;  ///< of the capacitance that the droplet had at the start; (0, 1]
  double step_timeout = 6;         ///< for one try of one step; > 0
  unsigned retries = 2;            ///< further tries of a step; up to 100
  double timeout = 0;              ///< for the whole operation; 0: none
};

/// Moves the droplet on `channel`, by the quickest way to `to` or along `path`.
struct Move {
  Channel channel = 0;
  Channel to = 0;             ///< when `path` is empty
  std::vector<Channel> path;  ///< from a neighbour of `channel` on
  Limits limits;
};

/// Pulls the droplet on `channel` apart, onto two neighbours on opposite sides.
struct Split {
  Channel channel = 0;
  std::vector<Channel> onto;  ///< two channels; empty: the first opposite pair that is free
  Limits limits;
};

/// Moves the droplet on `channel` into the one on `into`.
struct Merge {
  Channel channel = 0;
  Channel into = 0;
  Limits limits;
};

/// Draws a droplet from the reservoir: liquid is pulled out along `path`, then its neck is broken.
struct Dispense {
  Channel reservoir = 0;
  std::vector<Channel>
      path;          ///< two or more, from a neighbour of the reservoir on; the last holds the droplet
  double least = 0;  ///< electrodes that the droplet has to cover to be good, 0: any
  double most = 0;   ///< 0: any
  Limits limits;
};

/// Moves the droplet on `channel` around and around.
struct Mix {
  Channel channel = 0;
  /// The other electrodes of the loop, from a neighbour of `channel` to a neighbour of it again; one alone:
  /// to and fro. Empty: the shortest loop there is.
  std::vector<Channel> loop;
  unsigned laps = 1;
  Limits limits;
};

using Goal = std::variant<Move, Split, Merge, Dispense, Mix>;

/// "move", "split", ...
std::string name_of(const Goal& goal);
/// The channel of the droplet that the goal is for.
Channel channel_of(const Goal& goal);

/// What is wrong with a goal on this board, whatever liquid there is; each "key: value, allowed: ...":
/// channels that do not exist, ways that leave the electrodes, numbers out of range. Empty when nothing is.
std::vector<std::string> violations(const Goal& goal, const Layout& layout);

}  // namespace dmf::controller
