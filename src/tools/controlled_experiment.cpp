#include "tools/controlled_experiment.h"

#include "chip/capacitance.h"

namespace dmf::tools {

controller::BoardDescription describe_board(const chip::Scene& scene) {
  controller::BoardDescription board;
  const double length = scene.units.length_m;
  for (const chip::Electrode& electrode : scene.layout.electrodes()) {
    controller::Electrode pad{electrode.channel, {}, electrode.neighbours};
    for (const auto& corner : electrode.outline)
      pad.outline.push_back({corner.x() * length, corner.y() * length});
    board.electrodes.push_back(pad);
  }
  board.gap = scene.layout.gap() * length;
  board.sensing = {chip::liquid_capacitance(scene), chip::filler_capacitance(scene), scene.sensing.offset,
                   scene.sensing.noise};
  board.threshold_voltage = scene.electrowetting.threshold_voltage;
  return board;
}

ControlledExperiment::ControlledExperiment(const chip::Scene& scene, const engine::Execution& execution,
                                           std::optional<std::uint64_t> seed,
                                           double ros_seconds_per_time_unit)
    : experiment_(scene, execution, seed),
      coordinator_(controller::Layout(describe_board(scene))),
      seconds_per_tau_(ros_seconds_per_time_unit) {
  experiment_.want_readings(true);
}

double ControlledExperiment::time() const { return experiment_.simulation().time() * seconds_per_tau_; }

void ControlledExperiment::advance(controller::ProtocolRun* run) {
  std::optional<chip::CapacitanceReading> sensed;
  while (!sensed) {
    experiment_.step();
    sensed = experiment_.take_reading();
  }
  controller::Reading reading{time(), {}};
  const auto& electrodes = experiment_.scene().layout.electrodes();
  for (std::size_t index = 0; index < electrodes.size(); ++index)
    reading.capacitance[electrodes[index].channel] = sensed->capacitance[index];
  const chip::RailState rail = experiment_.rail();
  coordinator_.update(reading, {rail.voltage, rail.frequency, rail.enabled});
  if (run) run->update();
  drive(run);
}

void ControlledExperiment::drive(controller::ProtocolRun* run) {
  if (run && run->wanted_rail()) {
    const controller::Rail& rail = *run->wanted_rail();
    experiment_.apply(chip::SetHv{rail.voltage, rail.frequency, rail.enabled});
  }
  const auto on = coordinator_.on();
  if (!on || on == on_) return;
  const chip::Reply reply = experiment_.apply(chip::SetElectrodes{{on->begin(), on->end()}});
  if (!reply.success) return;  // as a node would: told again at the next reading
  on_ = on;
  controller::Channels disabled;
  for (const chip::ElectrodeState& electrode : experiment_.electrodes())
    if (electrode.disabled) disabled.insert(electrode.channel);
  coordinator_.note_disabled(disabled);
}

void ControlledExperiment::finish(controller::ProtocolRun& run, double limit) {
  const double end = time() + limit;
  while (run.is_running()) {
    if (time() > end) run.cancel();
    advance(&run);
  }
}

}  // namespace dmf::tools
