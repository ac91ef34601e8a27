#pragma once
#include <cstdint>
#include <memory>
#include <optional>
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
  /// @throws engine::InvalidInput for a command that is none of the above.
  void apply(const Command& command);

  /// Commands that turn a board on which all is off into one like this but for charge(), in order.
  std::vector<Command> as_commands() const;

  /// With a charging time a pad's electrowetting number follows its voltage exponentially. Takes all pads on
  /// to a step, at most this late; a pad whose angle is within 0.05 degrees of its end is there.
  void charge_until(std::uint64_t step);
  /// Some pad's angle is not yet what its voltage leads to.
  bool charging() const;
  PadCharge charge() const;
  /// @throws engine::InvalidInput, unchanged, unless there is one number from 0 to saturation for each pad.
  void set_charge(const PadCharge& charge);

  const RailState& rail() const { return rail_; }
  bool is_on(std::size_t index) const { return pads_[index].on; }
  /// V rms on the pad.
  double voltage(std::size_t index) const;
  /// Degrees, from the pad's charge or at its centre from the program that overrides it.
  double contact_angle(std::size_t index) const;
  /// Degrees at a point of the plate, r_c.
  double contact_angle_at(const Vector2d& point) const;
  /// The same as the engine takes it: keeps a copy of this board.
  engine::ContactAngleField field() const;

 private:
  struct Pad {
    bool on = false;
    std::optional<double> own_voltage;  ///< V rms, drives the pad past the rail
    double number = 0;                  ///< electrowetting number, up to saturation
    double angle = 0;                   ///< degrees, from its number
  };

  /// Where the pad's number goes.
  double target_number(std::size_t index) const;
  void set_number(std::size_t index, double number);
  /// After voltages changed.
  void update_angles();
  double program_angle_at(double x) const;

  std::shared_ptr<const Scene> scene_;
  RailState rail_;
  std::vector<Pad> pads_;
  std::uint64_t charged_step_ = 0;         ///< up to which the numbers have followed
  std::optional<SetWettability> program_;  ///< overrides the angles of the voltages
};

}  // namespace dmf::chip
