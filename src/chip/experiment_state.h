#pragma once
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "chip/experiment.h"
#include "chip/run.h"
#include "chip/scene_hash.h"

namespace dmf::chip {

/// What an Experiment consists of; for its own files only. experiment.cpp has what it shows and saves,
/// experiment_commands.cpp what becomes of commands.
struct Experiment::State {
  State(const Scene& given, const engine::Execution& how, std::optional<std::uint64_t> seed)
      : scene(std::make_shared<const Scene>(given)),
        execution(how),
        parameters(given.parameters),
        curve(load_curve(given)) {
    if (seed) parameters.seed = *seed;
    start();
  }

  void start() {
    auto fresh = std::make_unique<Run>(scene, parameters, curve, execution);
    fresh->place();
    run = std::move(fresh);
  }

  /// What decides how runs of the scene go; worked out when it is first asked for.
  const SceneContent& scene_content();
  std::string save();
  void load(const std::string& bytes);

  Reply apply(const Command& command);
  /// Neither the schedule nor a pattern can hold a reset or load a pattern into the sequence that is being
  /// played: the scene refuses that. So `sequence` outlives its commands.
  void play_due(Sequence& sequence);

  // Each carries out a command that was found sound and says what it did, or throws engine::InvalidInput,
  // unchanged.
  std::string carry_out(const SetElectrodes& command);
  std::string carry_out(const SetHv& command);
  std::string carry_out(const SetElectrodeVoltages& command);
  std::string carry_out(const SetWettability& command);
  std::string carry_out(const LoadPattern& command);
  std::string carry_out(const DispenseDroplet& command);
  std::string carry_out(const AddMicroparticle& command);
  std::string carry_out(const Remove& command);
  std::string carry_out(const SetBodyForces& command);
  std::string carry_out(const InjectFault& command);
  std::string carry_out(const SetDisabledChannels& command);
  std::string carry_out(const Halt& command);
  std::string carry_out(const Reset& command);

  /// @returns what the board's protection made of it, to be added to a reply.
  template <typename BoardCommand>
  std::string change_board(const BoardCommand& command) {
    Board next = run->board;
    next.charge_until(run->simulation->steps());
    next.apply(command);
    const std::string halted = protect(next);
    run->show(next);
    if (!halted.empty()) note(BoardEvent::Kind::halted, halted);
    return halted.empty() ? "" : fmt::format("; the rail was halted, set_hv enables it again: {}", halted);
  }
  /// Halts the rail of a board whose voltages do harm. @returns the reason; empty when they don't.
  std::string protect(Board& board);
  /// While the run goes on: liquid that spreads takes more current.
  void protect_if_due();
  void note(BoardEvent::Kind kind, const std::string& message);

  /// "; disabled and left out: 2, 3" for those of these channels that are; else nothing.
  std::string left_out(const std::vector<std::uint32_t>& channels) const;
  std::vector<std::uint32_t> channels_where(bool (Board::*holds)(std::size_t) const) const;
  bool sensing_due() const;
  /// F, of each pad as it is.
  std::vector<double> capacitances();
  CapacitanceReading sense();
  /// Keeps a reading when its time has come and somebody wants it.
  void sense_if_due();

  std::shared_ptr<const Scene> scene;
  engine::Execution execution;
  engine::Parameters parameters;
  engine::ContactAngleCurve curve;
  std::unique_ptr<Run> run;
  std::optional<PadCapacitance> pad_capacitance;  ///< once it was needed
  std::optional<SceneContent> content;            ///< the same
  bool readings_wanted = false;
};

}  // namespace dmf::chip
