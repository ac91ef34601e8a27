#include "chip/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "chip/command_rules.h"

namespace dmf::chip {

namespace {

using Json = nlohmann::ordered_json;

/// A timed list of commands that is being played.
struct Sequence {
  const std::vector<ScheduledCommand>* commands = nullptr;  ///< null: nothing is played
  std::uint64_t start_step = 0;
  std::size_t next = 0;

  /// The next command if its time has come.
  const Command* take_due(std::uint64_t step, double time_step) {
    if (!commands || next >= commands->size()) return nullptr;
    const ScheduledCommand& candidate = (*commands)[next];
    if (step < start_step + static_cast<std::uint64_t>(std::llround(candidate.time / time_step)))
      return nullptr;
    ++next;
    return &candidate.command;
  }
};

/// Everything that a reset starts anew.
struct Run {
  /// A chip without liquid.
  Run(const std::shared_ptr<const Scene>& scene, const engine::Parameters& parameters,
      const engine::ContactAngleCurve& curve, const engine::Execution& execution)
      : simulation(std::make_unique<engine::Simulation>(parameters, curve, execution)), board(scene) {
    show(board);
    constexpr double kShownInAChargingTime = 10;
    const double charging_steps = scene->electrowetting.charging_time / parameters.time_step;
    charging_interval =
        std::max<std::uint64_t>(1, static_cast<std::uint64_t>(charging_steps / kShownInAChargingTime));
    const double settle_steps = scene->settle_time / parameters.time_step;
    schedule = {&scene->schedule, static_cast<std::uint64_t>(std::llround(settle_steps)), 0};
  }

  /// What the scene has on the plate from the start. @throws engine::InvalidInput naming its key.
  void place(const Scene& scene) {
    const auto attempt = [&scene](const std::string& key, const auto& action) {
      try {
        action();
      } catch (const engine::InvalidInput& error) {
        throw engine::InvalidInput(fmt::format("{}: {}: {}", scene.source, key, error.what()));
      }
    };
    for (std::size_t i = 0; i < scene.droplets.size(); ++i) {
      attempt(fmt::format("droplets[{}]", i), [&] { simulation->add_droplet(scene.droplets[i]); });
    }
    for (std::size_t i = 0; i < scene.microparticles.size(); ++i) {
      attempt(fmt::format("microparticles[{}]", i),
              [&] { simulation->add_microparticle(scene.microparticles[i]); });
    }
    const engine::BodyForces& forces = scene.body_forces;
    if (!forces.gravity.isZero(0) || !forces.magnetic.isZero(0))
      attempt("body_forces", [&] { simulation->set_body_forces(forces); });
  }

  /// Takes charging pads on to this step, now and then: the wall is shown anew some ten times in a charging
  /// time.
  void charge_pads() {
    if (simulation->steps() % charging_interval != 0 || !board.charging()) return;
    Board next = board;
    next.charge_until(simulation->steps());
    show(next);
  }

  /// Makes a board the one that the wall shows, or changes nothing and throws.
  void show(const Board& next) {
    if (simulation->parameters().domain.has_wall()) simulation->set_wettability(next.field());
    board = next;
  }

  std::unique_ptr<engine::Simulation> simulation;
  Board board;
  std::uint64_t charging_interval = 1;  ///< steps
  Sequence schedule;
  Sequence pattern;
  std::string pattern_name;                ///< of the pattern that was loaded last; empty before the first
  std::uint32_t newest_microparticle = 0;  ///< id of the one that a command added last
  std::vector<CommandRecord> history;
  std::vector<ScheduledReply> scheduled_replies;
  std::optional<CapacitanceReading> reading;  ///< that nobody has taken yet
  std::string fault;
};

}  // namespace

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
    fresh->place(*scene);
    run = std::move(fresh);
  }

  std::string save() const;
  void load(const std::string& bytes);
  /// A run that goes on from what save() wrote before the engine's bytes.
  std::unique_ptr<Run> run_from(const Json& saved, const engine::Parameters& saved_parameters) const;

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
  std::string carry_out(const Reset& command);

  template <typename BoardCommand>
  void change_board(const BoardCommand& command) {
    Board next = run->board;
    next.charge_until(run->simulation->steps());
    next.apply(command);
    run->show(next);
  }

  std::vector<std::uint32_t> channels_on() const;
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

CapacitanceReading Experiment::State::sense() {
  if (!pad_capacitance) pad_capacitance.emplace(*scene);
  engine::ObserveRequest request;
  request.wetted = true;
  const auto snapshot = run->simulation->observe(request);
  // Without a plate there are no electrodes either.
  const engine::WettedArea wetted = snapshot->wetted.value_or(engine::WettedArea{});
  return read_channels(pad_capacitance->capacitances(wetted), *scene, parameters.seed, snapshot->step);
}

void Experiment::State::sense_if_due() {
  if (!readings_wanted) return;
  const double steps = std::round(scene->sensing.interval / parameters.time_step);
  const auto interval = static_cast<std::uint64_t>(std::max(1.0, steps));
  if (run->simulation->steps() % interval == 0) run->reading = sense();
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
      reply.applied_channels = channels_on();
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
  change_board(command);
  const std::string on = fmt::format("{}", fmt::join(command.channels, ", "));
  std::string message =
      command.channels.empty() ? "all channels off" : "channels on: " + on + "; all others off";
  const RailState& rail = run->board.rail();
  if (!command.channels.empty() && !rail.enabled)
    message += "; the rail is disabled, so no pad has a voltage";
  return message;
}

std::string Experiment::State::carry_out(const SetHv& command) {
  change_board(command);
  if (!command.enabled) return "rail disabled";
  return fmt::format("rail at {} V, {} Hz", command.voltage, command.frequency);
}

std::string Experiment::State::carry_out(const SetElectrodeVoltages& command) {
  change_board(command);
  return fmt::format("channels {} driven past the rail until the next set_electrodes",
                     fmt::join(command.channels, ", "));
}

std::string Experiment::State::carry_out(const SetWettability& command) {
  change_board(command);
  return fmt::format("wettability program of {} positions over the whole plate", command.positions.size());
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

std::vector<std::uint32_t> Experiment::State::channels_on() const {
  std::vector<std::uint32_t> channels;
  const auto& electrodes = scene->layout.electrodes();
  for (std::size_t i = 0; i < electrodes.size(); ++i) {
    if (run->board.is_on(i)) channels.push_back(electrodes[i].channel);
  }
  return channels;
}

// ---- saved runs ----

// One line of JSON for what the chip knows, then the engine's bytes.

std::string Experiment::State::save() const {
  Json saved;
  saved["scene"] = scene->name;
  saved["seed"] = parameters.seed;
  saved["board"] = Json::array();
  for (const Command& command : run->board.as_commands()) saved["board"].push_back(to_json(command));
  if (run->board.charging()) {
    const PadCharge charge = run->board.charge();
    saved["charge"] = {{"step", charge.step}, {"numbers", charge.numbers}};
  }
  saved["schedule_next"] = run->schedule.next;
  saved["pattern"] = run->pattern_name;
  saved["pattern_start"] = run->pattern.start_step;
  saved["pattern_next"] = run->pattern.next;
  saved["history"] = Json::array();
  for (const auto& [step, command] : run->history) saved["history"].push_back({step, to_json(command)});
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
    auto loaded = run_from(saved, saved_parameters);
    loaded->simulation->load_state(bytes.substr(end + 1));
    run = std::move(loaded);
    parameters = saved_parameters;
  } catch (const Json::exception& error) {
    throw engine::InvalidInput(fmt::format("saved run: {}", error.what()));
  }
}

std::unique_ptr<Run> Experiment::State::run_from(const Json& saved,
                                                 const engine::Parameters& saved_parameters) const {
  auto loaded = std::make_unique<Run>(scene, saved_parameters, curve, execution);
  Board board(scene);
  for (const Json& text : saved.at("board")) {
    const Command command = command_from_json(text.get<std::string>());
    const auto wrong = violations(command, *scene, curve);
    if (!wrong.empty()) throw engine::InvalidInput(fmt::format("saved run: {}", fmt::join(wrong, "; ")));
    board.apply(command);
  }
  if (saved.contains("charge")) {
    const Json& charge = saved["charge"];
    board.set_charge(
        {charge.at("step").get<std::uint64_t>(), charge.at("numbers").get<std::vector<double>>()});
  }
  loaded->show(board);
  loaded->schedule.next = saved.at("schedule_next").get<std::size_t>();
  loaded->pattern_name = saved.at("pattern").get<std::string>();
  if (const auto pattern = scene->patterns.find(loaded->pattern_name); pattern != scene->patterns.end()) {
    loaded->pattern = {&pattern->second, saved.at("pattern_start").get<std::uint64_t>(),
                       saved.at("pattern_next").get<std::size_t>()};
  }
  for (const Json& record : saved.at("history")) {
    const auto step = record.at(0).get<std::uint64_t>();
    loaded->history.push_back({step, command_from_json(record.at(1).get<std::string>())});
  }
  return loaded;
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
  state_->sense_if_due();
}

std::shared_ptr<const engine::Snapshot> Experiment::observe(const engine::ObserveRequest& request) const {
  return state_->run->simulation->observe(request);
}

std::vector<engine::DropletEvent> Experiment::take_events() { return state_->run->simulation->take_events(); }

std::vector<engine::MicroparticleEvent> Experiment::take_microparticle_events() {
  return state_->run->simulation->take_microparticle_events();
}

std::vector<ScheduledReply> Experiment::take_scheduled_replies() {
  return std::exchange(state_->run->scheduled_replies, {});
}

std::vector<ElectrodeState> Experiment::electrodes() const {
  const Board& board = state_->run->board;
  const auto& electrodes = scene().layout.electrodes();
  std::vector<ElectrodeState> states;
  for (std::size_t i = 0; i < electrodes.size(); ++i) {
    states.push_back({electrodes[i].channel, board.is_on(i), board.voltage(i), board.contact_angle(i)});
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
