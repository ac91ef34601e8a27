#pragma once
#include <cstdint>
#include <optional>

#include "chip/experiment.h"
#include "controller/coordinator.h"
#include "controller/protocol_run.h"

namespace dmf::tools {

/// What a scene tells a controller of its board, as the node's ~get_layout does.
controller::BoardDescription describe_board(const chip::Scene& scene);

/// A controller and the chip it drives in one process, as fast as the engine goes: the coordinator gets what
/// the node's topics would tell it, and no more, and what it wants goes the way of the node's services. Its
/// clock is the node's.
class ControlledExperiment {
 public:
  /// @throws InvalidInput when the scene can't be run, or its chip has no electrodes.
  ControlledExperiment(const chip::Scene& scene, const engine::Execution& execution,
                       std::optional<std::uint64_t> seed = {}, double ros_seconds_per_time_unit = 0.02);

  /// On to the next reading, and what the coordinator makes of it.
  /// @param run  a protocol that is under way, or none.
  void advance(controller::ProtocolRun* run = nullptr);
  /// Until the protocol is over; cancels it when that takes longer.
  /// @param limit  s of the controller's clock, from now.
  void finish(controller::ProtocolRun& run, double limit);

  chip::Experiment& experiment() { return experiment_; }
  controller::Coordinator& coordinator() { return coordinator_; }
  double time() const;  ///< s of the controller's clock

 private:
  void drive(controller::ProtocolRun* run);

  chip::Experiment experiment_;
  controller::Coordinator coordinator_;
  double seconds_per_tau_;
  std::optional<controller::Channels> on_;
};

}  // namespace dmf::tools
