#pragma once
#include <memory>
#include <string>
#include <vector>

#include "controller/droplets.h"
#include "controller/goal.h"
#include "controller/traffic.h"

namespace dmf::controller {

/// The shared high-voltage rail as the board tells.
struct Rail {
  double voltage = 0;    ///< V rms
  double frequency = 0;  ///< Hz
  bool enabled = false;
};

/// How long steps take on this board: the mean of those done, from a guess on.
class StepTimes {
 public:
  void add(double seconds);
  double mean() const { return mean_; }

 private:
  double mean_ = 2.5;  ///< s
  unsigned count_ = 0;
};

/// What operations see at one reading, and what they share.
struct View {
  double time;  ///< s
  const Layout& layout;
  const Wetting& wetting;
  const DropletFinder& droplets;
  Rail rail;
  bool rail_is_off;          ///< and has been for a while
  const Channels& disabled;  ///< the board refuses to switch them on
  bool alone;                ///< nothing else is under way that might still make room
  Traffic& traffic;
  Channels& dead;  ///< disabled, or found not to answer; whoever finds one adds it
  StepTimes& step_times;
};

/// Whether to give up because something is in the way. Not while anything else is under way that may still
/// clear it, and not at once: droplets that have just been moved still draw back from the electrodes they
/// came from.
class Obstruction {
 public:
  /// @param found  what is in the way; empty: nothing. @param step_timeout  s, that a step may take.
  bool is_final(const std::string& found, const View& view, double step_timeout);

 private:
  double since_ = -1;  ///< s; below 0: nothing is in the way
};

enum class State { running, succeeded, failed, cancelled };

/// How far an operation is.
struct Status {
  State state = State::running;
  double progress = 0;   ///< 0 to 1
  double time_left = 0;  ///< s, estimated
  std::string text;      ///< what it does now; at the end what was done, or why it failed
};

/// One thing that is done with droplets: a small state machine that is shown every reading and says which
/// electrodes it wants on.
class Operation {
 public:
  Operation(Traffic::Key key, const Limits& limits, double time) : key_(key), limits_(limits), start_(time) {}
  virtual ~Operation() = default;

  /// One look. Ends the operation when it is done, when its time is over or the rail is off.
  void update(View& view);
  /// Ends it, with its liquid in a safe place: held by the electrodes of hold().
  void cancel(View& view);

  const Status& status() const { return status_; }
  bool is_running() const { return status_.state == State::running; }
  /// Electrodes that shall be on.
  const Channels& on() const { return on_; }
  /// Electrodes whose liquid is this operation's: other droplets keep clear of them.
  virtual Channels claims() const = 0;
  /// Those of them that a droplet of the traffic is on or steps to.
  virtual Channels walks_on() const { return {}; }
  virtual bool is_blocked() const { return false; }
  /// Electrodes that hold the liquid when it is over, or if it ended now.
  virtual Channels hold(const Wetting& wetting) const = 0;

 protected:
  virtual void advance(View& view) = 0;

  void succeed(const std::string& text);
  void fail(const std::string& reason);

  Traffic::Key key_;
  Limits limits_;
  double start_;  ///< s
  Status status_;
  Channels on_;

 private:
  void end(View& view);
};

/// Why a droplet does not follow.
struct NoAnswer {
  std::string reason;
  bool is_electrode = false;  ///< the electrode is at fault, and another way may do; else rail or droplet
};
/// @param from  the electrode it is on. @param to  the one that was switched on.
/// @param covered  the largest part of `from` that it was seen to wet: at rest it shrinks.
NoAnswer why_no_answer(const View& view, Channel from, Channel to, double covered);

/// Droplets near to electrodes that are not on `own`: "blocked by droplet 3"; empty when there is none.
std::string why_no_room(const View& view, const Channels& cells, const Channels& own);

/// The operation for a sound goal whose droplet is sensed. @throws InvalidInput when it can't begin: what
/// depends on where the liquid is.
std::unique_ptr<Operation> make_operation(const Goal& goal, Traffic::Key key, View& view);

}  // namespace dmf::controller
