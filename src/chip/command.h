#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/microparticle.h"

namespace dmf::chip {

/// Everything that a controller can tell the chip, as plain values in SI units. A command takes effect
/// between two steps or not at all. `to_json` / `command_from_json` are exact inverses: a recorded command
/// can be applied again.
///
/// The voltage of a pad is its own one when SetElectrodeVoltages gave it one, else the rail's when its
/// channel is on and the rail is enabled, else 0; disabled channels and faults come on top (Board::voltage).
/// SetWettability overrides the angles that follow from the voltages until the next SetElectrodes, SetHv,
/// SetElectrodeVoltages or Halt, whoever gives it.

struct SetElectrodes {  ///< these channels on, all others off; every pad is back on the rail
  std::vector<std::uint32_t> channels;
};
struct SetHv {           ///< the shared rail
  double voltage = 0;    ///< V rms
  double frequency = 0;  ///< Hz, [0, 100e3]; 0 is DC. What of the voltage acts, see Electrowetting
  bool enabled = false;
};
struct SetElectrodeVoltages {  ///< drives single electrodes past the rail; unlisted unchanged
  std::vector<std::uint32_t> channels;
  std::vector<double> voltages;  ///< V rms, as long as channels
};
struct SetWettability {  ///< piecewise-linear theta(x) over the whole plate, constant beyond its ends
  std::vector<double> positions;           ///< x, m, strictly rising
  std::vector<double> contact_angles_deg;  ///< as long as positions
};
struct LoadPattern {  ///< starts a named timed sequence of the scene, in place of the one that runs
  std::string name;
};
struct DispenseDroplet {  ///< a droplet on the plate above (x, y), or a pancake between two plates
  double x = 0, y = 0;    ///< m
  double volume = 0;      ///< m^3; 0: `fills` says it
  double fills = 0;       ///< between two plates: so many times the electrode nearest to (x, y)
  std::string species{};  ///< name of its liquid; empty: the first one
};
struct AddMicroparticle {   ///< a rigid body of beads at rest
  double x = 0, y = 0;      ///< m, of a sphere's centre; for `points` the place of their origin
  double height = 0;        ///< of its lowest point over the plate, m; 0: it rests on the plate
  double radius = 0;        ///< of the sphere, or of the contact sphere around each of `points`, m
  std::uint32_t beads = 0;  ///< of the sphere's shell, see engine::MicroparticlePlacement
  bool smooth = false;      ///< one bead of a smooth surface in place of the shell
  std::vector<Eigen::Vector3d> points;  ///< beads from the origin, m, in place of a sphere
  std::optional<double> mass;           ///< of the whole body, kg; by default that of a bead, for each bead
  /// A_ls, reduced.
  double attraction = engine::MicroparticlePlacement{}.attraction;
  std::optional<double> contact_angle_deg;  ///< in place of the attraction, within the scene's calibration
  double static_friction = engine::MicroparticlePlacement{}.static_friction;
  std::optional<double> kinetic_friction;  ///< by default the static one
  double rolling_friction = engine::MicroparticlePlacement{}.rolling_friction;
  bool magnetic = false;  ///< feels SetBodyForces::magnetic
};
struct Remove {  ///< takes a droplet or a microparticle off the chip; exactly one of both ids is not 0
  std::uint32_t droplet = 0;
  std::uint32_t microparticle = 0;
};
struct SetBodyForces {               ///< forces that act from afar, in place of those before
  std::array<double, 3> gravity{};   ///< of all liquid and microparticles, m/s^2
  std::array<double, 3> magnetic{};  ///< on each magnetic microparticle, N
};
struct InjectFault {          ///< makes an electrode or the board faulty, or sound again; faults add up
  std::string kind;           ///< one of fault_kinds()
  std::uint32_t channel = 0;  ///< means nothing with `disconnected` and with `all`
  double strength = 1;        ///< of `weak`: what of its voltage the pad has, [0, 1]
  bool all = false;           ///< with `clear`: every fault of the board
};
struct SetDisabledChannels {  ///< these stay off whatever is commanded, all others are free
  std::vector<std::uint32_t> channels;
};
struct Halt {          ///< the rail off at once and all channels off, until SetHv enables it again
  std::string reason;  ///< empty: it was commanded
};
struct Reset {};  ///< the scene from its start

/// What InjectFault knows: a pad that has the rail's voltage whenever the rail is enabled, one that never has
/// any, one that leaks to ground, one with a part of its voltage, a board that is unplugged, and none of it.
namespace fault {
constexpr const char* kStuckOn = "stuck_on";
constexpr const char* kStuckOff = "stuck_off";
constexpr const char* kShort = "short";
constexpr const char* kWeak = "weak";
constexpr const char* kDisconnected = "disconnected";
constexpr const char* kClear = "clear";
}  // namespace fault
const std::vector<std::string>& fault_kinds();
/// The fault is one of a channel.
bool has_channel(const InjectFault& command);

using Command =
    std::variant<SetElectrodes, SetHv, SetElectrodeVoltages, SetWettability, LoadPattern, DispenseDroplet,
                 AddMicroparticle, Remove, SetBodyForces, InjectFault, SetDisabledChannels, Halt, Reset>;

/// "set_electrodes", "set_hv", ...: the name of the service that gives this command.
std::string name_of(const Command& command);
/// {"command": "set_hv", "voltage": 63, ...}: the members in SI units, angles in degrees; numbers round-trip
/// exactly.
std::string to_json(const Command& command);
/// @throws engine::InvalidInput naming the key.
Command command_from_json(const std::string& json);

/// What became of a command.
struct Reply {
  bool success = false;
  std::string message;                           ///< what was done, or what was wrong and what is allowed
  std::uint64_t step = 0;                        ///< at which it took effect
  std::vector<std::uint32_t> applied_channels;   ///< channels that are on now (set_electrodes)
  std::vector<std::uint32_t> disabled_channels;  ///< channels that are disabled now (set_disabled_channels)
  std::uint32_t microparticle = 0;               ///< id of the new one (add_microparticle), else 0
};

/// An accepted command with the step before which it took effect.
struct CommandRecord {
  std::uint64_t step;
  Command command;
};

}  // namespace dmf::chip
