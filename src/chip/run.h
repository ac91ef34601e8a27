#pragma once
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "chip/board.h"
#include "chip/board_event.h"
#include "chip/capacitance.h"
#include "chip/command.h"
#include "chip/experiment.h"
#include "chip/scene.h"
#include "engine/simulation.h"

namespace dmf::chip {

/// A timed list of commands that is being played.
struct Sequence {
  const std::vector<ScheduledCommand>* commands = nullptr;  ///< null: nothing is played
  std::uint64_t start_step = 0;
  std::size_t next = 0;

  /// The next command if its time has come.
  const Command* take_due(std::uint64_t step, double time_step);
};

/// Everything of an experiment that a reset starts anew.
struct Run {
  /// A chip without liquid.
  Run(const std::shared_ptr<const Scene>& scene, const engine::Parameters& parameters,
      const engine::ContactAngleCurve& curve, const engine::Execution& execution);

  /// What the scene has on the plate from the start. @throws engine::InvalidInput naming its key.
  void place();

  /// Makes a board the one that the wall shows, or changes nothing and throws.
  void show(const Board& next);
  /// Takes charging pads on to this step, now and then: the wall is shown anew some ten times in a charging
  /// time.
  void charge_pads();

  /// What the run knows besides the engine's state.
  nlohmann::ordered_json save() const;
  /// Takes all that over, on a run without liquid; the engine's state follows.
  /// @throws engine::InvalidInput, nlohmann::json::exception.
  void restore(const nlohmann::ordered_json& saved, const engine::ContactAngleCurve& curve);

  std::shared_ptr<const Scene> scene;
  std::unique_ptr<engine::Simulation> simulation;
  Board board;
  std::uint64_t charging_interval = 1;  ///< steps
  Sequence schedule;
  Sequence pattern;
  std::string pattern_name;                ///< of the pattern that was loaded last; empty before the first
  std::uint32_t newest_microparticle = 0;  ///< id of the one that a command added last
  std::vector<CommandRecord> history;
  std::vector<ScheduledReply> scheduled_replies;
  std::vector<BoardEvent> board_events;
  std::optional<CapacitanceReading> reading;  ///< that nobody has taken yet
  std::string fault;
};

}  // namespace dmf::chip
