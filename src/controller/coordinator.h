#pragma once
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "controller/droplets.h"
#include "controller/goal.h"
#include "controller/operation.h"

namespace dmf::controller {

/// How an operation ended, or how far it is.
struct Report {
  Status status;
  std::vector<Droplet> droplets;  ///< on the electrodes that it used; at its end those that are left
};

/// Runs operations side by side on one board. It is shown every reading, and says which electrodes shall be
/// on: those that the operations want and those that hold the droplets which nobody moves. What it knows of
/// droplets comes from capacitance alone, so that it can drive a real board. Not thread-safe.
///
///     coordinator.update(reading, rail);          // each time the board has sensed
///     board.set_electrodes(coordinator.on());     // when that has changed
///     coordinator.note_disabled(disabled);        // what the board does not switch on
class Coordinator {
 public:
  using Key = Traffic::Key;

  /// @param wetted_fraction  of a pad beyond which a droplet is on it, (0, 1).
  explicit Coordinator(Layout layout, double wetted_fraction = 0.3);

  void update(const Reading& reading, const Rail& rail);

  /// @throws InvalidInput when the goal is unsound, no droplet is where it says, or another operation has it;
  /// with everything that is wrong.
  Key start(const Goal& goal);
  /// Leaves the liquid of the operation held. Unknown and finished operations are left alone.
  void cancel(Key key);
  Report report(Key key) const;
  /// Forgets an operation that is over.
  void forget(Key key);
  bool is_running(Key key) const;
  bool is_idle() const;

  /// Exactly these channels on in place of all else, until the next of these calls, none or an operation
  /// begins.
  /// @throws InvalidInput while an operation runs, or for a channel that does not exist.
  void set_manual(std::optional<Channels> channels);

  /// Electrodes that shall be on now; nothing before the first operation or manual step.
  std::optional<Channels> on() const;
  /// The channels that the board says are disabled, after it was told on(). What else it did not switch on
  /// has another reason: a rail that was halted switches nothing on.
  void note_disabled(const Channels& disabled);
  /// Electrodes that were disabled or found not to answer are tried again.
  void forget_dead_electrodes();

  const Layout& layout() const { return layout_; }
  const std::vector<Droplet>& droplets() const { return finder_.droplets(); }
  const Wetting& wetting() const { return wetting_; }
  const Rail& rail() const { return rail_; }
  /// Off, and for longer than news of it may be late: a board is told to switch it on by another way than it
  /// tells that it is on.
  bool rail_is_off() const;
  double time() const { return time_; }
  const Channels& dead() const { return dead_; }

 private:
  View view();
  std::vector<Obstacle> obstacles() const;
  void update_holds();

  Layout layout_;
  DropletFinder finder_;
  Traffic traffic_;
  Wetting wetting_;
  Rail rail_;
  double rail_on_ = 0;  ///< s, when it was last on, or an operation began that takes it for on
  double time_ = 0;
  bool has_reading_ = false;
  bool is_active_ = false;
  Channels disabled_, dead_;
  Channels holds_;
  std::optional<Channels> manual_;
  StepTimes step_times_;
  std::map<Key, std::unique_ptr<Operation>> operations_;
  Key next_key_ = 1;
};

}  // namespace dmf::controller
