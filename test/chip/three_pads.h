#pragma once
#include <cstdint>
#include <string>

#include "chip/experiment.h"

/// The chip that tests of experiments drive.
namespace dmf::chip::testing {

// Three pads, a droplet small enough to simulate in a blink, and a row of commands of its own.
inline const char* const kScene = R"(
domain: {lower: [-20, -8, 0], upper: [20, 8, 10]}
wettability: {calibration: lan2016, rest_angle: 110}
chip:
  gap: 2
  grids: [{origin: [-12, 0], columns: 3, rows: 1, pitch: 12}]
  electrowetting: {reference_voltage: 63, reference_angle: 60, saturation_angle: 55, max_voltage: 80}
droplets: [{center: [-12, 0], radius: 2}]
patterns:
  walk:
    - {at: 0, set_hv: {voltage: 63 V}}
    - {at: 0, set_electrodes: {channels: [1]}}
    - {at: 0.05, set_electrodes: {channels: [2]}}
  crowd:
    - {at: 0, dispense_droplet: {x: -12, y: 0, radius: 2}}
  stop: []
)";

inline Scene scene(const std::string& more = "") { return parse_scene(kScene + more, "scene.yaml"); }

inline Experiment start(const std::string& more = "") {
  return Experiment(scene(more), engine::Execution{1, "auto"});
}

inline std::uint64_t hash(const Experiment& experiment) {
  engine::ObserveRequest request;
  request.hash = true;
  return experiment.observe(request)->state_hash.value();
}

inline void run(Experiment& experiment, int steps) {
  for (int i = 0; i < steps; ++i) experiment.step();
}

/// Everything of an experiment that a refused command must leave as it is.
inline std::string state_of(const Experiment& experiment) {
  return experiment.save() + std::to_string(hash(experiment));
}

/// A sphere at rest on the plate at (x, 0), m.
inline AddMicroparticle body(double x, double radius) {
  AddMicroparticle command;
  command.x = x;
  command.radius = radius;
  return command;
}

/// A sound one but for one member.
template <typename Member, typename Value>
AddMicroparticle with(Member AddMicroparticle::*member, Value value) {
  AddMicroparticle command = body(0, 1e-5);
  command.*member = value;
  return command;
}

}  // namespace dmf::chip::testing
