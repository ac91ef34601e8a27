#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "chip/board.h"
#include "chip/board_event.h"
#include "chip/capacitance.h"
#include "chip/command.h"
#include "chip/explanation.h"
#include "chip/scene.h"
#include "engine/simulation.h"

namespace dmf::chip {

/// State of one electrode as a controller would read it.
struct ElectrodeState {
  std::uint32_t channel;
  bool on;               ///< switched to the rail
  double voltage;        ///< V rms on the pad now
  double contact_angle;  ///< degrees, on the pad
  bool disabled = false;
};

/// What a test of all channels for shorts found.
struct ShortsReport {
  bool success = false;  ///< false: the rail is enabled
  std::string message;
  std::vector<std::uint32_t> channels;  ///< rising
};

/// What became of a command that the scene's schedule or a running pattern gave.
struct ScheduledReply {
  Command command;
  Reply reply;
};

/// A chip with its droplets and microparticles: turns commands into wettability and steps the engine.
/// Everything that the node, the headless tool and the tests run is one of these. Not thread-safe.
///
/// Data flows one way: command -> rail and channels -> voltage of each pad -> contact angle over the plate ->
/// engine. A command is refused whole or takes effect before the next step, and is then in history().
class Experiment {
 public:
  /// Commands that a run keeps; more are refused until a reset. docs/ros_api.md says what each takes.
  static constexpr std::size_t kMaxHistory = 1'000'000;

  /// Builds the engine and places the scene's droplets and microparticles. `seed` replaces the scene's.
  /// @throws engine::InvalidInput.
  Experiment(const Scene& scene, const engine::Execution& execution, std::optional<std::uint64_t> seed = {});
  ~Experiment();

  /// Never throws for bad input: the reply says what was wrong; nothing has changed then, not one bit of the
  /// state. After an instability every command but Reset is refused with the reason. What a pattern has for
  /// its own time 0 takes effect when it is loaded; it runs on until its end, the next LoadPattern or Reset.
  Reply apply(const Command& command);

  /// Applies what the schedule and then the running pattern have for now, then one time step. One of their
  /// commands that is refused (a place that is occupied by then) is skipped, see take_scheduled_replies().
  /// @throws engine::Instability, now and on every later call.
  void step();

  std::shared_ptr<const engine::Snapshot> observe(const engine::ObserveRequest& request = {}) const;
  std::vector<engine::DropletEvent> take_events();
  std::vector<engine::MicroparticleEvent> take_microparticle_events();
  std::vector<BoardEvent> take_board_events();
  /// What the schedule and patterns did since the last call, in order.
  std::vector<ScheduledReply> take_scheduled_replies();

  std::vector<ElectrodeState> electrodes() const;  ///< in the order of layout().electrodes()
  RailState rail() const;
  /// Channels under a droplet's footprint: those whose pad the wetted area overlaps.
  std::vector<std::uint32_t> channels_under(const engine::DropletObservation& droplet) const;
  /// Tests every channel with a low voltage, as a board does before it enables the rail. Refused while the
  /// rail is enabled.
  ShortsReport detect_shorts() const;
  /// What the board senses of all channels at this step: a function of the state, the seed and the step.
  CapacitanceReading sense() const;
  /// Whether step() keeps a reading at every multiple of the sensing interval. Changes nothing else.
  void want_readings(bool wanted);
  /// The newest reading since the last call.
  std::optional<CapacitanceReading> take_reading();
  /// Why a droplet moves or does not. @throws engine::InvalidInput when there is none of that id.
  DropletExplanation explain_droplet(std::uint32_t id) const;
  /// Contact angle that is commanded at a point (r_c), degrees.
  double commanded_angle(double x, double y) const;

  /// The run as bytes, history and place in the schedule and pattern included: an experiment of the same
  /// scene that loads it goes on with the same bits.
  std::string save() const;
  /// Takes over a saved run, its seed too. @throws engine::InvalidInput, unchanged, when the bytes are not a
  /// run of this scene, by name and content (scene_hash.h), or not sound: no bytes, however they were forged,
  /// make it crash or take more memory than a run of their length. Recovers from an instability.
  void load(const std::string& bytes);
  /// Of what decides how runs of the scene go: saved runs belong to one.
  std::uint64_t scene_hash() const;

  const Scene& scene() const;
  const engine::Simulation& simulation() const;
  std::uint64_t steps() const;
  /// Accepted commands since the start or the last reset, oldest first. Reset itself is the first entry after
  /// one. Only those given to apply(): what the schedule and patterns do follows from the scene. So the
  /// scene, the seed and this list, each command applied when steps() is its step, give the same run again,
  /// bit for bit.
  const std::vector<CommandRecord>& history() const;
  /// Why the run was stopped, empty while it is sound.
  const std::string& fault() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace dmf::chip
