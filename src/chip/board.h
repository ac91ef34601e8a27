#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "chip/command.h"
#include "chip/scene.h"
#include "engine/wettability.h"

namespace dmf::chip {

/// State of the shared high-voltage rail.
struct RailState {
  double voltage = 0;    ///< V rms asked for
  double frequency = 0;  ///< Hz
  bool enabled = false;
  std::string halted;  ///< why it was switched off and stays so until it is enabled again; empty: it was not
};

/// What is wrong with a pad, besides a board that is disconnected.
struct PadFaults {
  bool stuck_on = false;
  bool stuck_off = false;
  bool shorted = false;
  double strength = 1;  ///< of its voltage
};

/// How far the pads' electrowetting numbers have come on their way to what the voltages ask for.
struct PadCharge {
  std::uint64_t step = 0;       ///< at which they were so
  std::vector<double> numbers;  ///< by index of the electrode
};

/// What a controller has set, and what contact angle follows from it where: rail and channels -> voltage of
/// each pad -> its charge -> angle of each pad -> angle at each point of the plate. A plain value: a copy is
/// another board.
/// Takes commands that were found sound (command_rules.h). Pads are named by their index in
/// layout().electrodes().
class Board {
 public:
  /// As the scene starts: all off, its wettability program shown if it has one.
  explicit Board(std::shared_ptr<const Scene> scene);

  void apply(const SetElectrodes& command);
  void apply(const SetHv& command);
  void apply(const SetElectrodeVoltages& command);
  void apply(const SetWettability& command);
  void apply(const InjectFault& command);
  void apply(const SetDisabledChannels& command);
  void apply(const Halt& command);
  /// @throws engine::InvalidInput for a command that is none of the above.
  void apply(const Command& command);

  /// Commands that turn a board on which all is off into one like this but for charge(), in order.
  std::vector<Command> as_commands() const;

  /// With a charging time a pad's electrowetting number follows its voltage exponentially. Takes all pads on
  /// to a step, at most this late; a pad whose angle is within 0.05 degrees of its end is there.
  void charge_until(std::uint64_t step);
  /// Takes all pads to where their voltages lead, as after a long time.
  void settle();
  /// Some pad's angle is not yet what its voltage leads to.
  bool charging() const;
  PadCharge charge() const;
  /// @throws engine::InvalidInput, unchanged, unless there is one number from 0 to saturation for each pad.
  void set_charge(const PadCharge& charge);

  const RailState& rail() const { return rail_; }
  /// Switched on by SetElectrodes, and not disabled.
  bool is_on(std::size_t index) const { return pads_[index].on && !pads_[index].disabled; }
  bool is_disabled(std::size_t index) const { return pads_[index].disabled; }
  /// On, or driven past the rail: somebody wants a voltage on this pad, whether it has one or not.
  bool is_wanted(std::size_t index) const { return pads_[index].on || pads_[index].own_voltage > 0.0; }
  /// Driven past the rail.
  bool is_driven(std::size_t index) const { return pads_[index].own_voltage.has_value(); }
  const PadFaults& faults(std::size_t index) const { return pads_[index].faults; }
  bool disconnected() const { return disconnected_; }
  /// A wettability program overrides the voltages.
  bool shows_program() const { return program_.has_value(); }
  /// V rms that a sound pad would have.
  double commanded_voltage(std::size_t index) const;
  /// V rms on the pad: none when its channel is disabled or stuck off or the board disconnected; the rail's
  /// when it is stuck on and the rail enabled; all of it times the strength of a weak one. A disabled channel
  /// is cut off the rail, so that it has none either when it is stuck on.
  double voltage(std::size_t index) const;
  /// What of its capacitance a channel senses: it is read by the charge that its own voltage moves.
  double sensed_share(std::size_t index) const;
  /// Degrees, from the pad's charge or at its centre from the program that overrides it.
  double contact_angle(std::size_t index) const;
  /// Degrees at a point of the plate, r_c.
  double contact_angle_at(const Vector2d& point) const;
  /// The same as the engine takes it: keeps a copy of this board.
  engine::ContactAngleField field() const;

 private:
  struct Pad {
    bool on = false;
    bool disabled = false;
    std::optional<double> own_voltage;  ///< V rms, drives the pad past the rail
    PadFaults faults;
    double number = 0;  ///< electrowetting number, up to saturation
    double angle = 0;   ///< degrees, from its number
  };

  /// Where the pad's number goes.
  double target_number(std::size_t index) const;
  void set_number(std::size_t index, double number);
  /// After voltages changed.
  void update_angles();
  double program_angle_at(double x) const;

  std::shared_ptr<const Scene> scene_;
  RailState rail_;
  bool disconnected_ = false;
  std::vector<Pad> pads_;
  std::uint64_t charged_step_ = 0;         ///< up to which the numbers have followed
  std::optional<SetWettability> program_;  ///< overrides the angles of the voltages
};

}  // namespace dmf::chip
