#include "chip/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "chip/command_rules.h"

namespace dmf::chip {

using Json = nlohmann::ordered_json;

const Command* Sequence::take_due(std::uint64_t step, double time_step) {
  if (!commands || next >= commands->size()) return nullptr;
  const ScheduledCommand& candidate = (*commands)[next];
  if (step < start_step + static_cast<std::uint64_t>(std::llround(candidate.time / time_step)))
    return nullptr;
  ++next;
  return &candidate.command;
}

Run::Run(const std::shared_ptr<const Scene>& given, const engine::Parameters& parameters,
         const engine::ContactAngleCurve& curve, const engine::Execution& execution)
    : scene(given),
      simulation(std::make_unique<engine::Simulation>(parameters, curve, execution)),
      board(given) {
  show(board);
  constexpr double kShownInAChargingTime = 10;
  const double charging_steps = scene->electrowetting.charging_time / parameters.time_step;
  charging_interval =
      std::max<std::uint64_t>(1, static_cast<std::uint64_t>(charging_steps / kShownInAChargingTime));
  const double settle_steps = scene->settle_time / parameters.time_step;
  schedule = {&scene->schedule, static_cast<std::uint64_t>(std::llround(settle_steps)), 0};
}

void Run::place() {
  const auto attempt = [this](const std::string& key, const auto& action) {
    try {
      action();
    } catch (const engine::InvalidInput& error) {
      throw engine::InvalidInput(fmt::format("{}: {}: {}", scene->source, key, error.what()));
    }
  };
  for (std::size_t i = 0; i < scene->droplets.size(); ++i) {
    attempt(fmt::format("droplets[{}]", i), [&] { simulation->add_droplet(scene->droplets[i]); });
  }
  for (std::size_t i = 0; i < scene->microparticles.size(); ++i) {
    attempt(fmt::format("microparticles[{}]", i),
            [&] { simulation->add_microparticle(scene->microparticles[i]); });
  }
  for (std::size_t i = 0; i < scene->fills.size(); ++i) {
    attempt(fmt::format("fills[{}]", i), [&] { simulation->fill(scene->fills[i]); });
  }
  for (std::size_t i = 0; i < scene->chains.size(); ++i)
    attempt(fmt::format("chains[{}]", i), [&] { simulation->add_chains(scene->chains[i]); });
  for (std::size_t i = 0; i < scene->membranes.size(); ++i)
    attempt(fmt::format("membranes[{}]", i), [&] { simulation->add_membrane(scene->membranes[i]); });
  const engine::BodyForces& forces = scene->body_forces;
  if (!forces.gravity.isZero(0) || !forces.magnetic.isZero(0))
    attempt("body_forces", [&] { simulation->set_body_forces(forces); });
}

void Run::show(const Board& next) {
  const engine::Parameters& parameters = simulation->parameters();
  if (parameters.domain.has_wall() && !fixed_wall_attraction(parameters))
    simulation->set_wettability(next.field());
  board = next;
}

void Run::charge_pads() {
  if (simulation->steps() % charging_interval != 0 || !board.charging()) return;
  Board next = board;
  next.charge_until(simulation->steps());
  show(next);
}

Json Run::save() const {
  Json saved;
  saved["board"] = Json::array();
  for (const Command& command : board.as_commands()) saved["board"].push_back(to_json(command));
  if (board.charging()) {
    const PadCharge charge = board.charge();
    saved["charge"] = {{"step", charge.step}, {"numbers", charge.numbers}};
  }
  saved["schedule_next"] = schedule.next;
  saved["pattern"] = pattern_name;
  saved["pattern_start"] = pattern.start_step;
  saved["pattern_next"] = pattern.next;
  saved["history"] = Json::array();
  for (const auto& [step, command] : history) saved["history"].push_back({step, to_json(command)});
  return saved;
}

void Run::restore(const Json& saved, const engine::ContactAngleCurve& curve) {
  Board restored(scene);
  for (const Json& text : saved.at("board")) {
    const Command command = command_from_json(text.get<std::string>());
    const auto wrong = violations(command, *scene, curve);
    if (!wrong.empty()) throw engine::InvalidInput(fmt::format("saved run: {}", fmt::join(wrong, "; ")));
    restored.apply(command);
  }
  if (saved.contains("charge")) {
    const Json& charge = saved["charge"];
    restored.set_charge(
        {charge.at("step").get<std::uint64_t>(), charge.at("numbers").get<std::vector<double>>()});
  } else {
    restored.settle();
  }
  show(restored);
  schedule.next = saved.at("schedule_next").get<std::size_t>();
  pattern_name = saved.at("pattern").get<std::string>();
  if (const auto found = scene->patterns.find(pattern_name); found != scene->patterns.end()) {
    pattern = {&found->second, saved.at("pattern_start").get<std::uint64_t>(),
               saved.at("pattern_next").get<std::size_t>()};
  }
  for (const Json& record : saved.at("history")) {
    const auto step = record.at(0).get<std::uint64_t>();
    history.push_back({step, command_from_json(record.at(1).get<std::string>())});
  }
}

}  // namespace dmf::chip
