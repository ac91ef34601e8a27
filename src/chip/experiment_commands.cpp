#include <fmt/format.h>

#include <algorithm>

#include "chip/command_rules.h"
#include "chip/experiment_state.h"

namespace dmf::chip {

Reply Experiment::State::apply(const Command& command) {
  Reply reply;
  reply.step = run->simulation->steps();
  const bool stopped = !run->fault.empty() && !std::holds_alternative<Reset>(command);
  const auto wrong = violations(command, *scene, curve);
  if (stopped) {
    reply.message = fmt::format("the run has stopped, allowed: reset. It stopped because: {}", run->fault);
  } else if (!wrong.empty()) {
    reply.message = fmt::format("{}", fmt::join(wrong, "; "));
  } else {
    try {
      reply.message = std::visit([this](const auto& sound) { return carry_out(sound); }, command);
      reply.success = true;
      reply.step = run->simulation->steps();
      reply.applied_channels = channels_where(&Board::is_on);
      reply.disabled_channels = channels_where(&Board::is_disabled);
      if (std::holds_alternative<AddMicroparticle>(command)) reply.microparticle = run->newest_microparticle;
    } catch (const engine::InvalidInput& refusal) {
      reply.message = refusal.what();
    } catch (const engine::Instability& instability) {
      run->fault = instability.what();
      reply.message = fmt::format("the run has stopped, allowed: reset. It stopped because: {}", run->fault);
    }
  }
  return reply;
}

void Experiment::State::play_due(Sequence& sequence) {
  while (const Command* command = sequence.take_due(run->simulation->steps(), parameters.time_step)) {
    const Reply reply = apply(*command);
    run->scheduled_replies.push_back({*command, reply});
  }
}

std::string Experiment::State::carry_out(const SetElectrodes& command) {
  const std::string halted = change_board(command);
  const Board& board = run->board;
  std::vector<std::uint32_t> on;
  for (const std::uint32_t channel : command.channels) {
    if (!board.is_disabled(scene->layout.index_of(channel))) on.push_back(channel);
  }
  std::string message =
      on.empty() ? "all channels off" : fmt::format("channels on: {}; all others off", fmt::join(on, ", "));
  message += left_out(command.channels);
  if (!halted.empty()) return message + halted;
  if (!on.empty() && !board.rail().enabled) {
    message += "; the rail is disabled, so no pad has a voltage";
    if (!board.rail().halted.empty()) message += ", for it was halted: " + board.rail().halted;
  }
  return message;
}

std::string Experiment::State::carry_out(const SetHv& command) {
  const std::string halted = change_board(command);
  if (!command.enabled) return "rail disabled" + halted;
  return fmt::format("rail at {} V, {} Hz", command.voltage, command.frequency) + halted;
}

std::string Experiment::State::carry_out(const SetElectrodeVoltages& command) {
  const std::string& why = run->board.rail().halted;
  const bool any =
      std::any_of(command.voltages.begin(), command.voltages.end(), [](double v) { return v > 0; });
  if (!why.empty() && any) {
    throw engine::InvalidInput(
        fmt::format("the rail is halted, allowed: set_hv that enables it. It was halted because: {}", why));
  }
  const std::string halted = change_board(command);
  return fmt::format("channels {} driven past the rail until the next set_electrodes",
                     fmt::join(command.channels, ", ")) +
         left_out(command.channels) + halted;
}

std::string Experiment::State::carry_out(const SetWettability& command) {
  const std::string halted = change_board(command);
  return fmt::format("wettability program of {} positions over the whole plate", command.positions.size()) +
         halted;
}

std::string Experiment::State::carry_out(const InjectFault& command) {
  std::string message;
  if (command.all) {
    message = "all faults cleared";
  } else if (command.kind == fault::kDisconnected) {
    message = "the chip is disconnected";
  } else if (command.kind == fault::kClear) {
    message = fmt::format("channel {}: faults cleared", command.channel);
  } else if (command.kind == fault::kWeak) {
    message = fmt::format("channel {}: weak, {} of its voltage", command.channel, command.strength);
  } else {
    message = fmt::format("channel {}: {}", command.channel, command.kind);
  }
  note(BoardEvent::Kind::fault_injected, message);  // before what follows from it
  return message + change_board(command);
}

std::string Experiment::State::carry_out(const SetDisabledChannels& command) {
  const std::string halted = change_board(command);
  if (command.channels.empty()) return "no channel disabled" + halted;
  return fmt::format("channels disabled: {}", fmt::join(command.channels, ", ")) + halted;
}

std::string Experiment::State::carry_out(const Halt& command) {
  change_board(command);
  note(BoardEvent::Kind::halted, run->board.rail().halted);
  return "rail disabled and all channels off; set_hv enables it again";
}

std::string Experiment::State::carry_out(const LoadPattern& command) {
  const std::vector<ScheduledCommand>& commands = scene->patterns.at(command.name);
  run->pattern = {&commands, run->simulation->steps(), 0};
  run->pattern_name = command.name;
  // Its commands for its time 0 count as part of loading it: a paused chip shows them at once.
  play_due(run->pattern);
  return fmt::format("pattern {} of {} commands started", command.name, commands.size());
}

std::string Experiment::State::carry_out(const DispenseDroplet& command) {
  const std::size_t beads = run->simulation->add_droplet(placement_of(command, *scene));
  return fmt::format("droplet of {} beads dispensed", beads);
}

std::string Experiment::State::carry_out(const AddMicroparticle& command) {
  run->newest_microparticle = run->simulation->add_microparticle(placement_of(command, *scene));
  return fmt::format("microparticle {} added", run->newest_microparticle);
}

std::string Experiment::State::carry_out(const Remove& command) {
  if (command.microparticle > 0) {
    run->simulation->remove_microparticle(command.microparticle);
    return fmt::format("microparticle {} removed", command.microparticle);
  }
  run->simulation->remove_droplet(command.droplet);
  return fmt::format("droplet {} removed", command.droplet);
}

std::string Experiment::State::carry_out(const SetBodyForces& command) {
  run->simulation->set_body_forces(body_forces_of(command, *scene));
  return fmt::format("gravity ({:g}) m/s^2, magnetic force ({:g}) N", fmt::join(command.gravity, ", "),
                     fmt::join(command.magnetic, ", "));
}

std::string Experiment::State::carry_out(const Reset&) {
  start();
  return "back at the start of the scene";
}

std::string Experiment::State::left_out(const std::vector<std::uint32_t>& channels) const {
  std::vector<std::uint32_t> disabled;
  for (const std::uint32_t channel : channels) {
    if (run->board.is_disabled(scene->layout.index_of(channel))) disabled.push_back(channel);
  }
  if (disabled.empty()) return "";
  return fmt::format("; disabled and left out: {}", fmt::join(disabled, ", "));
}

std::vector<std::uint32_t> Experiment::State::channels_where(bool (Board::*holds)(std::size_t) const) const {
  std::vector<std::uint32_t> channels;
  const auto& electrodes = scene->layout.electrodes();
  for (std::size_t i = 0; i < electrodes.size(); ++i) {
    if ((run->board.*holds)(i)) channels.push_back(electrodes[i].channel);
  }
  return channels;
}

}  // namespace dmf::chip
