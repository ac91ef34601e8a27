#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chip/capacitance.h"
#include "node/convert.h"
#include "node/convert_values.h"

// What the board is, senses and suffers; convert.cpp has what is on it.

namespace dmf::node {

namespace {

diagnostic_msgs::KeyValue value(const std::string& key, const std::string& text) {
  diagnostic_msgs::KeyValue pair;
  pair.key = key;
  pair.value = text;
  return pair;
}

}  // namespace

dmf_sim::ElectrodeArray to_electrodes(const Frame& frame) {
  dmf_sim::ElectrodeArray message;
  message.header.stamp = to_ros_time(frame.stamp);
  message.header.frame_id = kChipFrame;
  message.step = frame.snapshot->step;
  message.hv_voltage = frame.rail.voltage;
  message.hv_frequency = frame.rail.frequency;
  message.hv_enabled = frame.rail.enabled;
  message.electrodes.reserve(frame.electrodes.size());
  for (const chip::ElectrodeState& electrode : frame.electrodes) {
    dmf_sim::ElectrodeState state;
    state.channel = electrode.channel;
    state.on = electrode.on;
    state.disabled = electrode.disabled;
    state.voltage = electrode.voltage;
    state.contact_angle_deg = electrode.contact_angle;
    message.electrodes.push_back(state);
  }
  return message;
}

dmf_sim::Layout to_layout(const ConversionContext& context) {
  const chip::Scene& scene = context.scene;
  const double length = scene.units.length_m;
  const double z = context.plate_z() * length;
  dmf_sim::Layout layout;
  layout.header.stamp = to_ros_time(1'000'000'000);
  layout.header.frame_id = kChipFrame;
  layout.scene = scene.name;
  layout.lower = to_point(scene.parameters.domain.lower * length);
  layout.upper = to_point(scene.parameters.domain.upper * length);
  layout.gap = scene.layout.gap() * length;
  for (const chip::Electrode& electrode : scene.layout.electrodes()) {
    dmf_sim::ElectrodeOutline message;
    message.channel = electrode.channel;
    message.centroid = to_point({electrode.centroid.x() * length, electrode.centroid.y() * length, z});
    for (const auto& corner : electrode.outline) {
      message.outline.push_back(to_point({corner.x() * length, corner.y() * length, z}));
    }
    message.neighbours = electrode.neighbours;
    layout.electrodes.push_back(message);
  }
  const engine::Domain& domain = scene.parameters.domain;
  if (domain.has_top_plate()) layout.plate_gap = domain.size().z() * length;
  const chip::Electrowetting& law = scene.electrowetting;
  layout.max_voltage = law.max_voltage;
  layout.reference_voltage = law.reference_voltage;
  layout.reference_angle_deg = law.reference_angle;
  layout.rest_angle_deg = law.rest_angle;
  layout.saturation_angle_deg = law.saturation_angle;
  layout.threshold_voltage = law.threshold_voltage;
  layout.cutoff_frequency = law.cutoff_frequency;
  layout.breakdown_voltage = law.breakdown_voltage;
  layout.charging_time = law.charging_time * scene.units.time_s;
  layout.liquid_capacitance = chip::liquid_capacitance(scene);
  layout.filler_capacitance = chip::filler_capacitance(scene);
  layout.capacitance_noise = scene.sensing.noise;
  layout.capacitance_offset = scene.sensing.offset;
  layout.sensing_interval = scene.sensing.interval * scene.units.time_s;
  layout.length_unit = scene.units.length_m;
  layout.time_unit = scene.units.time_s;
  layout.mass_unit = scene.units.mass_kg;
  layout.time_step_mdpd = scene.parameters.time_step;
  layout.ros_seconds_per_time_unit = context.ros_seconds_per_time_unit;
  layout.display_scale = context.display_scale;
  return layout;
}

dmf_sim::Capacitance to_capacitance(const CapacitanceNote& note, const ConversionContext& context) {
  dmf_sim::Capacitance message;
  message.header.stamp = to_ros_time(note.stamp);
  message.header.frame_id = kChipFrame;
  message.run = note.run;
  message.step = note.reading.step;
  message.time = note.time * context.scene.units.time_s;
  for (const chip::Electrode& electrode : context.scene.layout.electrodes())
    message.channels.push_back(electrode.channel);
  message.capacitance = note.reading.capacitance;
  return message;
}

dmf_sim::ExplainDroplet::Response to_response(const chip::DropletExplanation& explanation,
                                              const ConversionContext& context) {
  const engine::Units& units = context.scene.units;
  const Eigen::Vector2d& driving = explanation.driving_force;
  dmf_sim::ExplainDroplet::Response response;
  response.driving_force = to_vector(Vector3d(driving.x(), driving.y(), 0) * units.force_N());
  response.driving_force_mdpd = driving.norm();
  response.opposing_force = explanation.opposing_force * units.force_N();
  for (const double force : explanation.side_forces) response.side_forces.push_back(force * units.force_N());
  response.channels = explanation.channels;
  response.has_nearest_channel = explanation.nearest_channel.has_value();
  response.nearest_channel = explanation.nearest_channel.value_or(0);
  response.nearest_distance = explanation.nearest_distance * units.length_m;
  response.needed_voltage = or_nan(explanation.needed_voltage);
  return response;
}

namespace {

diagnostic_msgs::DiagnosticStatus checkpoint_diagnostics(const CheckpointStatus& checkpoints,
                                                         const std::string& hardware) {
  using diagnostic_msgs::DiagnosticStatus;
  DiagnosticStatus status;
  status.name = "chip: checkpoints";
  status.hardware_id = hardware;
  status.level = !checkpoints.problem.empty() ? DiagnosticStatus::ERROR
                 : checkpoints.left_out > 0   ? DiagnosticStatus::WARN
                                              : DiagnosticStatus::OK;
  status.message = !checkpoints.wanted            ? "automatic ones are switched off"
                   : !checkpoints.problem.empty() ? checkpoints.problem
                   : checkpoints.left_out > 0     ? "the last is still being written"
                   : checkpoints.name.empty()     ? "none written yet"
                                                  : fmt::format("step {} saved", checkpoints.step);
  status.values = {value("last", checkpoints.name), value("step", fmt::format("{}", checkpoints.step)),
                   value("age (s)", checkpoints.name.empty() ? "" : fmt::format("{:.0f}", checkpoints.age)),
                   value("left out", fmt::format("{}", checkpoints.left_out))};
  return status;
}

}  // namespace

diagnostic_msgs::DiagnosticArray to_diagnostics(const Frame& frame, const ConversionContext& context) {
  using diagnostic_msgs::DiagnosticStatus;
  const engine::Snapshot& snapshot = *frame.snapshot;
  // Of the temperature, relative. That of n beads fluctuates by sqrt(2 / 3n): five of these are no news.
  const double beads = static_cast<double>(std::max<std::size_t>(snapshot.moving_beads, 1));
  const double tolerance = std::max(0.1, 5 * std::sqrt(2 / (3 * beads)));
  const double target = context.scene.parameters.liquid.temperature;

  DiagnosticStatus engine;
  engine.name = "chip: engine";
  engine.hardware_id = "dmf_sim " + context.scene.name;
  if (!frame.fault.empty()) {
    engine.level = DiagnosticStatus::ERROR;
    engine.message = "halted: " + frame.fault;
  } else if (snapshot.moving_beads > 0 && std::abs(snapshot.temperature / target - 1) > tolerance) {
    engine.level = DiagnosticStatus::WARN;
    engine.message = fmt::format("temperature {:.3f}, thermostat at {:.3f}", snapshot.temperature, target);
  } else {
    engine.level = DiagnosticStatus::OK;
    engine.message = frame.paused ? "paused" : "running";
  }
  engine.values = {value("step", fmt::format("{}", snapshot.step)),
                   value("steps per second", fmt::format("{:.1f}", frame.steps_per_second)),
                   value("limited by", limit_name(frame.limit)),
                   value("temperature (k_BT)", fmt::format("{:.4f}", snapshot.temperature)),
                   value("moving beads", fmt::format("{}", snapshot.moving_beads)),
                   value("droplets", fmt::format("{}", snapshot.droplets.size())),
                   value("microparticles", fmt::format("{}", snapshot.microparticles.size())),
                   value("kernel", frame.kernel),
                   value("threads", fmt::format("{}", frame.threads))};

  std::size_t on = 0, disabled = 0;
  for (const auto& electrode : frame.electrodes) {
    on += electrode.on ? 1 : 0;
    disabled += electrode.disabled ? 1 : 0;
  }
  DiagnosticStatus rail;
  rail.name = "chip: high voltage";
  rail.hardware_id = engine.hardware_id;
  const bool halted = !frame.rail.halted.empty();
  rail.level = halted ? DiagnosticStatus::ERROR : DiagnosticStatus::OK;
  rail.message = halted               ? "halted: " + frame.rail.halted
                 : frame.rail.enabled ? fmt::format("{:g} V rms", frame.rail.voltage)
                                      : "off";
  rail.values = {value("voltage (V rms)", fmt::format("{:g}", frame.rail.voltage)),
                 value("frequency (Hz)", fmt::format("{:g}", frame.rail.frequency)),
                 value("enabled", frame.rail.enabled ? "true" : "false"),
                 value("halted", frame.rail.halted),
                 value("electrodes on", fmt::format("{}", on)),
                 value("electrodes disabled", fmt::format("{}", disabled))};

  diagnostic_msgs::DiagnosticArray array;
  array.header.stamp = to_ros_time(frame.stamp);
  array.status = {engine, rail, checkpoint_diagnostics(frame.checkpoints, engine.hardware_id)};
  return array;
}

std::string clock_conflict(const std::vector<std::string>& others) {
  return fmt::format("/clock is published by {} too and jumps for every node, allowed: one clock only",
                     fmt::join(others, ", "));
}

diagnostic_msgs::DiagnosticStatus clock_status(const std::vector<std::string>& others,
                                               const ConversionContext& context) {
  using diagnostic_msgs::DiagnosticStatus;
  DiagnosticStatus clock;
  clock.name = "chip: clock";
  clock.hardware_id = "dmf_sim " + context.scene.name;
  clock.level = others.empty() ? DiagnosticStatus::OK : DiagnosticStatus::ERROR;
  clock.message = others.empty() ? "the only one" : clock_conflict(others);
  clock.values = {value("other publishers", fmt::format("{}", fmt::join(others, ", ")))};
  return clock;
}

diagnostic_msgs::DiagnosticStatus memory_status(const MemoryUse& memory, const ConversionContext& context) {
  diagnostic_msgs::DiagnosticStatus status;
  status.name = "chip: memory";
  status.hardware_id = "dmf_sim " + context.scene.name;
  status.level = diagnostic_msgs::DiagnosticStatus::OK;
  status.message = fmt::format("{:.1f} MB in use", memory.in_use);
  status.values = {value("in use (MB)", fmt::format("{:.4f}", memory.in_use)),
                   value("kept free (MB)", fmt::format("{:.4f}", memory.kept)),
                   value("resident (MB)", fmt::format("{:.4f}", memory.resident))};
  return status;
}

}  // namespace dmf::node
