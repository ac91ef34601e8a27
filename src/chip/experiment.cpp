#include "chip/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "chip/command_rules.h"
#include "chip/rail_protection.h"
#include "chip/run.h"

namespace dmf::chip {

using Json = nlohmann::ordered_json;

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

  std::string save() const;
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
  bool readings_wanted = false;
};

// ---- sensing ----

std::vector<double> Experiment::State::capacitances() {
  if (!pad_capacitance) pad_capacitance.emplace(*scene);
  engine::ObserveRequest request;
  request.wetted = true;
  // Without a plate there are no electrodes either.
  return pad_capacitance->capacitances(
      run->simulation->observe(request)->wetted.value_or(engine::WettedArea{}));
}

CapacitanceReading Experiment::State::sense() {
  std::vector<double> sensed = capacitances();
  for (std::size_t index = 0; index < sensed.size(); ++index) sensed[index] *= run->board.sensed_share(index);
  return read_channels(std::move(sensed), *scene, parameters.seed, run->simulation->steps());
}

bool Experiment::State::sensing_due() const {
  const double steps = std::round(scene->sensing.interval / parameters.time_step);
  return run->simulation->steps() % static_cast<std::uint64_t>(std::max(1.0, steps)) == 0;
}

void Experiment::State::sense_if_due() {
  if (readings_wanted && sensing_due()) run->reading = sense();
}

// ---- protection ----

std::string Experiment::State::protect(Board& board) {
  const auto trip = find_trip(board, *scene, [this] { return capacitances(); });
  if (!trip) return "";
  for (const std::uint32_t channel : trip->broken_down) board.apply(InjectFault{fault::kShort, channel});
  board.apply(Halt{trip->reason});
  return trip->reason;
}

void Experiment::State::protect_if_due() {
  if (scene->rail.current_limit <= 0 || !sensing_due()) return;
  Board next = run->board;
  next.charge_until(run->simulation->steps());
  const std::string halted = protect(next);
  if (halted.empty()) return;
  run->show(next);
  note(BoardEvent::Kind::halted, halted);
}

void Experiment::State::note(BoardEvent::Kind kind, const std::string& message) {
  run->board_events.push_back({kind, run->simulation->steps(), message});
}

// ---- commands ----

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
  std::vector<std::uint32_t> on, left_out;
  for (const std::uint32_t channel : command.channels) {
    (board.is_disabled(scene->layout.index_of(channel)) ? left_out : on).push_back(channel);
  }
  std::string message =
      on.empty() ? "all channels off" : fmt::format("channels on: {}; all others off", fmt::join(on, ", "));
  if (!left_out.empty()) message += fmt::format("; disabled and left out: {}", fmt::join(left_out, ", "));
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
         halted;
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

std::vector<std::uint32_t> Experiment::State::channels_where(bool (Board::*holds)(std::size_t) const) const {
  std::vector<std::uint32_t> channels;
  const auto& electrodes = scene->layout.electrodes();
  for (std::size_t i = 0; i < electrodes.size(); ++i) {
    if ((run->board.*holds)(i)) channels.push_back(electrodes[i].channel);
  }
  return channels;
}

// ---- saved runs ----

// One line of JSON for what the chip knows, then the engine's bytes.

std::string Experiment::State::save() const {
  Json saved;
  saved["scene"] = scene->name;
  saved["seed"] = parameters.seed;
  saved.update(run->save());
  return saved.dump() + "\n" + run->simulation->save_state();
}

void Experiment::State::load(const std::string& bytes) {
  try {
    const std::size_t end = bytes.find('\n');
    if (end == std::string::npos) throw engine::InvalidInput("saved run: ends early");
    const Json saved = Json::parse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(end));
    const auto name = saved.at("scene").get<std::string>();
    if (name != scene->name) {
      throw engine::InvalidInput(fmt::format("saved run: of scene {}, allowed: {}", name, scene->name));
    }
    engine::Parameters saved_parameters = parameters;
    saved_parameters.seed = saved.at("seed").get<std::uint64_t>();
    auto loaded = std::make_unique<Run>(scene, saved_parameters, curve, execution);
    loaded->restore(saved, curve);
    loaded->simulation->load_state(bytes.substr(end + 1));
    run = std::move(loaded);
    parameters = saved_parameters;
  } catch (const Json::exception& error) {
    throw engine::InvalidInput(fmt::format("saved run: {}", error.what()));
  }
}

// ---- the experiment ----

Experiment::Experiment(const Scene& scene, const engine::Execution& execution,
                       std::optional<std::uint64_t> seed)
    : state_(std::make_unique<State>(scene, execution, seed)) {}

Experiment::~Experiment() = default;

Reply Experiment::apply(const Command& command) {
  Reply reply = state_->apply(command);
  if (reply.success) state_->run->history.push_back({reply.step, command});
  return reply;
}

void Experiment::step() {
  if (!fault().empty()) throw engine::Instability(fault());
  state_->run->charge_pads();
  state_->play_due(state_->run->schedule);
  state_->play_due(state_->run->pattern);
  try {
    state_->run->simulation->step();
  } catch (const engine::Instability& instability) {
    state_->run->fault = instability.what();
    throw;
  }
  state_->protect_if_due();
  state_->sense_if_due();
}

std::shared_ptr<const engine::Snapshot> Experiment::observe(const engine::ObserveRequest& request) const {
  return state_->run->simulation->observe(request);
}

std::vector<engine::DropletEvent> Experiment::take_events() { return state_->run->simulation->take_events(); }

std::vector<engine::MicroparticleEvent> Experiment::take_microparticle_events() {
  return state_->run->simulation->take_microparticle_events();
}

std::vector<BoardEvent> Experiment::take_board_events() {
  return std::exchange(state_->run->board_events, {});
}

std::vector<ScheduledReply> Experiment::take_scheduled_replies() {
  return std::exchange(state_->run->scheduled_replies, {});
}

std::vector<ElectrodeState> Experiment::electrodes() const {
  const Board& board = state_->run->board;
  const auto& electrodes = scene().layout.electrodes();
  std::vector<ElectrodeState> states;
  for (std::size_t i = 0; i < electrodes.size(); ++i) {
    states.push_back({electrodes[i].channel, board.is_on(i), board.voltage(i), board.contact_angle(i),
                      board.is_disabled(i)});
  }
  return states;
}

RailState Experiment::rail() const { return state_->run->board.rail(); }

std::vector<std::uint32_t> Experiment::channels_under(const engine::DropletObservation& droplet) const {
  std::vector<Vector2d> footprint;
  for (const auto& corner : droplet.footprint) footprint.push_back(corner.cast<double>());
  std::vector<std::uint32_t> channels;
  for (const std::size_t index : scene().layout.overlapping(footprint)) {
    channels.push_back(scene().layout.electrodes()[index].channel);
  }
  return channels;
}

ShortsReport Experiment::detect_shorts() const {
  const Board& board = state_->run->board;
  ShortsReport report;
  if (board.rail().enabled) {
    report.message = "the rail is enabled, allowed: a rail that is off (set_hv, halt)";
    return report;
  }
  report.success = true;
  const auto& electrodes = scene().layout.electrodes();
  for (std::size_t i = 0; i < electrodes.size(); ++i) {
    // What is unplugged or does not switch draws no current either.
    if (board.faults(i).shorted && board.sensed_share(i) > 0)
      report.channels.push_back(electrodes[i].channel);
  }
  std::sort(report.channels.begin(), report.channels.end());
  report.message = report.channels.empty()
                       ? "no channel is shorted"
                       : fmt::format("channels shorted: {}", fmt::join(report.channels, ", "));
  return report;
}

DropletExplanation Experiment::explain_droplet(std::uint32_t id) const {
  const auto snapshot = observe();
  std::vector<std::uint32_t> known;
  for (const engine::DropletObservation& droplet : snapshot->droplets) {
    if (droplet.id == id) return chip::explain_droplet(droplet, state_->run->board, scene());
    known.push_back(droplet.id);
  }
  throw engine::InvalidInput(
      fmt::format("droplet {} does not exist; droplets are [{}]", id, fmt::join(known, ", ")));
}

CapacitanceReading Experiment::sense() const { return state_->sense(); }

void Experiment::want_readings(bool wanted) { state_->readings_wanted = wanted; }

std::optional<CapacitanceReading> Experiment::take_reading() {
  return std::exchange(state_->run->reading, std::nullopt);
}

double Experiment::commanded_angle(double x, double y) const {
  return state_->run->board.contact_angle_at({x, y});
}

std::string Experiment::save() const { return state_->save(); }
void Experiment::load(const std::string& bytes) { state_->load(bytes); }
const Scene& Experiment::scene() const { return *state_->scene; }
const engine::Simulation& Experiment::simulation() const { return *state_->run->simulation; }
std::uint64_t Experiment::steps() const { return simulation().steps(); }
const std::vector<CommandRecord>& Experiment::history() const { return state_->run->history; }
const std::string& Experiment::fault() const { return state_->run->fault; }

}  // namespace dmf::chip
