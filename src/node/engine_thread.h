#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include "chip/checkpoint_file.h"
#include "chip/checkpoint_writer.h"
#include "chip/experiment.h"
#include "chip/hash_chain.h"
#include "node/frame.h"
#include "node/outbox.h"
#include "node/rate_meter.h"
#include "node/run_clock.h"

namespace dmf::node {

/// Nobody will answer any more: the node is shutting down.
class EngineStopped : public std::runtime_error {
 public:
  EngineStopped() : std::runtime_error("the node is shutting down") {}
};

struct EngineSettings {
  bool paused = false;       ///< wait for resume() before the first step
  double publish_rate = 30;  ///< frames per second of wall time, Hz, > 0; at most kIdleRate while paused
  double display_rate = 10;  ///< frames with beads per second while wanted, Hz, > 0
  double max_steps_per_second = 0;          ///< 0: as fast as it can
  double ros_seconds_per_time_unit = 0.02;  ///< ROS seconds per tau, > 0
  double checkpoint_period = 60;            ///< s of wall time between two automatic checkpoints; 0: none

  // Where an earlier process of this node was (node/start.h).
  std::uint32_t first_run = 0;                 ///< run number of the first run
  std::uint64_t ros_start = RunClock::kStart;  ///< ns of ROS time at which it begins
  std::string resumed_from;                    ///< what it goes on from, for people; empty: the scene's start
  std::uint32_t hash_interval = 100;           ///< steps between two hashes of the state; 0: none at all
};

/// Whether something was done, and the sentence for whoever asked.
struct Outcome {
  bool success = false;
  std::string message;
  std::uint64_t step = 0;   ///< steps of the run when it was answered
  std::uint32_t run = 0;    ///< number of the run that load() began
  std::uint64_t stamp = 0;  ///< of its start, ROS time in ns
};

/// Why a droplet moves or does not.
struct Explained {
  Outcome outcome;
  chip::DropletExplanation explanation;
};

/// The complete state of a run.
struct SavedRun {
  Outcome outcome;
  chip::Checkpoint checkpoint;
};

/// An EngineThread::advance() in progress.
struct Advance {
  std::uint64_t asked = 0;
  std::uint64_t done = 0;
  std::promise<Outcome> answer;
};

/// The thread that owns the experiment: takes requests between two steps, steps, and leaves frames in the
/// outbox. All requests may come from any thread, block until the engine has answered, which takes at most
/// one step (advance() excepted), and throw EngineStopped when it no longer will. No ROS in here.
class EngineThread {
 public:
  static constexpr double kIdleRate = 5;                   ///< Hz, most frames per second while nothing moves
  static constexpr std::uint64_t kMaxAdvance = 1'000'000;  ///< steps that one advance() may ask for
  static constexpr std::uint64_t kClockTick =
      10'000'000;  ///< ns of ROS time after which the clock is told anew

  /// @param writer  of the automatic checkpoints; must outlive the thread. Null: none are written.
  EngineThread(std::unique_ptr<chip::Experiment> experiment, const EngineSettings& settings,
               chip::CheckpointWriter* writer = nullptr);
  ~EngineThread();
  EngineThread(const EngineThread&) = delete;
  EngineThread& operator=(const EngineThread&) = delete;

  /// Applies a command before the next step. Reset begins a new run and recovers from a fault; the run stays
  /// paused or running as it was, so paused after a fault.
  chip::Reply apply(const chip::Command& command);

  Outcome pause();  ///< also ends a running advance()
  Outcome resume();
  /// Computes `steps` steps, 1 to kMaxAdvance, while paused. @returns when they are done, or when something
  /// ended them early.
  Outcome advance(std::uint64_t steps);

  /// The state right now. The snapshot's hash is set when asked for and the run is sound.
  std::shared_ptr<const Frame> inspect(bool hash);

  /// Why a droplet moves or does not.
  Explained explain_droplet(std::uint32_t id);
  /// Which channels are shorted, as the board can find out while the rail is off.
  chip::ShortsReport detect_shorts();

  SavedRun save();
  /// Goes on from a saved state: a new run. The run stays paused or running; it recovers from a fault.
  /// `name` is what people call the state. Refused, unchanged, when the state is not one of this scene's.
  Outcome load(const std::string& state, const std::string& name);
  /// Puts something on record among the events.
  void announce(const std::string& kind, const std::string& message);

  /// Whether anybody looks at the beads: frames contain them only then.
  void want_beads(bool wanted) { beads_wanted_ = wanted; }
  /// How many listen to the capacitance: readings are taken only while somebody does, and one at once for
  /// whoever joins.
  void want_capacitance(std::uint32_t listeners) { capacitance_listeners_ = listeners; }

  Outbox& outbox() { return outbox_; }

  /// Ends the thread after the step in progress and answers every open request with EngineStopped.
  /// Idempotent.
  void stop();
  /// Once stopped: writes the run as it ended, and returns when that is done. @returns what became of it, for
  /// people; empty when there was nothing new to write.
  std::string write_last_checkpoint();

 private:
  using Clock = std::chrono::steady_clock;

  /// Runs `request` on the engine thread, between two steps, and hands back what it returns.
  template <class Request>
  auto ask(Request request) -> decltype(request());

  void loop();
  bool run_requests();  ///< false: stop
  void wait_until(Clock::time_point deadline);
  bool moving() const { return fault_.empty() && (!paused_ || advance_); }
  void step();
  void halt(const std::string& reason);
  void end_advance(bool success, const std::string& message);
  void begin_run(double old_time);
  void publish_if_due();
  void publish_soon() { next_frame_ = Clock::now(); }
  void put_capacitance();
  void begin_chain();
  /// Leaves a hash of the state now in the outbox, unless there is one of this moment.
  void put_hash();
  std::shared_ptr<const Frame> make_frame(const engine::ObserveRequest& request);
  void collect_commands();
  void collect_scheduled();
  void collect_events();
  chip::Checkpoint checkpoint() const;
  void checkpoint_if_due();
  void note_checkpoints();
  void note(const std::string& kind, const std::string& message);
  void note(const std::string& kind, const std::string& message, std::uint64_t step);
  double time_of(std::uint64_t step) const;
  std::uint64_t seed() const;

  // Owned by the engine thread after construction.
  std::unique_ptr<chip::Experiment> experiment_;
  EngineSettings settings_;
  RunClock clock_;
  RateMeter rate_;
  std::uint32_t run_ = 0;
  bool paused_;
  std::string fault_;
  std::optional<Advance> advance_;
  std::size_t commands_seen_ = 0;         ///< how much of the history is in the outbox
  std::optional<chip::HashChain> chain_;  ///< of the present run; none without hashes
  std::shared_ptr<const engine::Snapshot>
      last_snapshot_;  ///< shown after a fault: the state itself is garbage then
  Clock::time_point next_step_, next_frame_, next_display_;
  std::uint64_t last_tick_ = 0;         ///< ns
  std::uint32_t served_listeners_ = 0;  ///< of the capacitance, that had a reading
  bool paced_ = false;                  ///< waited for max_steps_per_second since the last frame

  /// What a checkpoint would hold: the same again is not written.
  struct Progress {
    std::uint32_t run;
    std::uint64_t step;
    std::size_t commands;
    bool paused;
    bool operator==(const Progress& other) const {
      return run == other.run && step == other.step && commands == other.commands && paused == other.paused;
    }
  };
  Progress progress() const;
  chip::CheckpointWriter* writer_;
  Clock::time_point next_checkpoint_, last_checkpoint_;
  std::optional<Progress> saved_progress_;  ///< when the last one was handed to the writer, or at the start
  CheckpointStatus checkpoints_;

  // Shared.
  std::atomic<bool> beads_wanted_{false};
  std::atomic<std::uint32_t> capacitance_listeners_{0};
  Outbox outbox_;
  std::mutex mutex_;
  std::condition_variable requested_;
  std::deque<std::function<void()>> requests_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace dmf::node
