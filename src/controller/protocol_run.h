#pragma once
#include <optional>
#include <vector>

#include "controller/coordinator.h"
#include "controller/protocol.h"

namespace dmf::controller {

/// Runs a protocol over a coordinator, step by step. To be shown every reading after the coordinator; what it
/// wants of the rail has to be done by whoever drives the board.
///
///     coordinator.update(reading, rail);
///     run.update();
///     if (const auto rail = run.wanted_rail()) board.set_hv(*rail);
class ProtocolRun {
 public:
  ProtocolRun(Protocol protocol, Coordinator& coordinator);

  void update();
  /// Cancels what runs; its liquid is held.
  void cancel();

  /// The rail as this step wants it, until the coordinator has seen it so.
  const std::optional<Rail>& wanted_rail() const { return wanted_rail_; }
  const Status& status() const { return status_; }
  bool is_running() const { return status_.state == State::running; }
  std::size_t step() const { return step_; }  ///< from 0; as many as there are when all are done
  const Protocol& protocol() const { return protocol_; }

 private:
  bool rail_is_set();
  void begin();
  void begin_work(const Activate& work);
  void begin_work(const Wait&);
  void begin_work(const Parallel& work);
  bool is_done(const Activate& work);
  bool is_done(const Wait& work);
  bool is_done(const Parallel& work);
  void fail(const std::string& reason);
  void stop_work();
  void estimate();

  Protocol protocol_;
  Coordinator& coordinator_;
  Status status_;
  std::size_t step_ = 0;
  bool has_begun_ = false;
  double step_start_ = 0;   ///< s, of its work
  double rail_asked_ = -1;  ///< s; below 0: not yet
  std::optional<Rail> wanted_rail_;
  std::vector<Coordinator::Key> keys_;  ///< of the operations of this step
  double step_progress_ = 0, step_time_left_ = 0;
};

}  // namespace dmf::controller
