#include "chip/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "chip/experiment_state.h"
#include "chip/rail_protection.h"

namespace dmf::chip {

using Json = nlohmann::ordered_json;

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

// ---- saved runs ----

// One line of JSON for what the chip knows, then the engine's bytes.

const SceneContent& Experiment::State::scene_content() {
  if (!content) content = content_of(*scene);
  return *content;
}

std::string Experiment::State::save() {
  Json saved;
  saved["scene"] = scene->name;
  for (const auto& [part, hash] : scene_content()) saved["content"][part] = hash;
  saved["seed"] = parameters.seed;
  saved.update(run->save());
  std::string bytes = run->simulation->save_state();
  return bytes.insert(0, saved.dump() + "\n");
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
    if (const auto content = saved.at("content").get<SceneContent>(); content != scene_content()) {
      throw engine::InvalidInput(
          fmt::format("saved run: of a scene {} that differs in {}, allowed: one of the scene as it is now",
                      name, differing_parts(content, scene_content())));
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
  if (history().size() >= kMaxHistory && !std::holds_alternative<Reset>(command)) {
    Reply refused;
    refused.step = steps();
    refused.message = fmt::format("the run has had {} commands, allowed: up to {}, then reset",
                                  history().size(), kMaxHistory);
    return refused;
  }
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
std::uint64_t Experiment::scene_hash() const { return hash_of(state_->scene_content()); }
void Experiment::load(const std::string& bytes) { state_->load(bytes); }
const Scene& Experiment::scene() const { return *state_->scene; }
const engine::Simulation& Experiment::simulation() const { return *state_->run->simulation; }
std::uint64_t Experiment::steps() const { return simulation().steps(); }
const std::vector<CommandRecord>& Experiment::history() const { return state_->run->history; }
const std::string& Experiment::fault() const { return state_->run->fault; }

}  // namespace dmf::chip
