#pragma once
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

/// What a controller has set, and what contact angle follows from it where: rail and channels -> voltage of
/// each pad
/// -> angle of each pad -> angle at each point of the plate. A plain value: a copy is another board.
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

  /// Commands that turn a board on which all is off into one like this, in order.
  std::vector<Command> as_commands() const;

  const RailState& rail() const { return rail_; }
  bool is_on(std::size_t index) const { return pads_[index].on; }
  /// V rms on the pad.
  double voltage(std::size_t index) const;
  /// Degrees, from the pad's voltage or at its centre from the program that overrides it.
  double contact_angle(std::size_t index) const;
  /// Degrees at a point of the plate, r_c.
  double contact_angle_at(const Vector2d& point) const;
  /// The same as the engine takes it: keeps a copy of this board.
  engine::ContactAngleField field() const;

 private:
  struct Pad {
    bool on = false;
    std::optional<double> own_voltage;  ///< V rms, drives the pad past the rail
    double angle = 0;                   ///< degrees, from its voltage
  };

  void update_angles();
  double program_angle_at(double x) const;

  std::shared_ptr<const Scene> scene_;
  RailState rail_;
  std::vector<Pad> pads_;
  std::optional<SetWettability> program_;  ///< overrides the angles of the voltages
};

}  // namespace dmf::chip
