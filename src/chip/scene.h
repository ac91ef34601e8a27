#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "chip/board_file.h"
#include "chip/command.h"
#include "chip/electrowetting.h"
#include "chip/layout.h"
#include "chip/scene_files.h"
#include "engine/microparticle.h"
#include "engine/parameters.h"
#include "engine/simulation.h"
#include "engine/units.h"
#include "engine/wettability.h"

namespace dmf::chip {

/// What the high-voltage supply gives.
struct Rail {
  double current_limit = 0;  ///< of all pads together, A rms; more halts the rail. 0: none
};

/// How the board senses the capacitance of its channels.
struct Sensing {
  double interval = 1;             ///< between two readings, tau; > 0
  double noise = 0;                ///< standard deviation of a reading, F; >= 0
  double offset = 0;               ///< in every reading, F: stray capacitance of traces and switches; >= 0
  double filler_permittivity = 1;  ///< relative, of what surrounds the liquid between two plates; >= 1
};

/// A command of a scene's own schedule or pattern.
struct ScheduledCommand {
  double time = 0;  ///< tau after the end of settle_time, or after the pattern was loaded
  Command command;
};

/// The board file that a scene takes its electrodes from, and how finely it is simulated.
struct SceneBoard {
  std::string path;        ///< of the file, as found
  BoardFile file;          ///< in metres
  double resolution = 10;  ///< r_c per pitch

  double length_m() const { return file.pitch_m / resolution; }  ///< one r_c, m
};

/// What one YAML file under config/scenes says: the same for the node, dmf_run, tests and benchmarks.
struct Scene {
  std::string name;
  std::string description;
  std::string source;  ///< file it was read from
  SceneFiles files;    ///< all that it was read from: rebuild_scene(files.all()) gives it again
  engine::Parameters parameters;
  engine::Units units;
  std::string calibration_file;  ///< resolved path; empty means Lan's own fit
  Electrowetting electrowetting;
  Rail rail;
  Sensing sensing;
  std::optional<SceneBoard> board;        ///< where the layout comes from a board file
  Layout layout;                          ///< inside the domain
  std::optional<SetWettability> program;  ///< shown from the start, as if commanded before the first step
  double default_duration = 0;  ///< tau that dmf_run simulates when not told otherwise, settling included
  double settle_time = 0;       ///< tau at rest before the scene's clock of commands starts
  std::vector<engine::DropletPlacement> droplets;
  std::vector<engine::FillPlacement> fills;  ///< placed after droplets and microparticles, around them
  std::string microparticle_calibration;     ///< of their contact angles: a name or a path
  std::vector<engine::MicroparticlePlacement> microparticles;  ///< placed after the droplets
  std::vector<engine::ChainPlacement> chains;        ///< placed after all liquid, whose beads they take
  std::vector<engine::MembranePlacement> membranes;  ///< placed after the chains
  engine::BodyForces body_forces;                    ///< that act from the start
  std::vector<ScheduledCommand> schedule;            ///< by rising time
  std::map<std::string, std::vector<ScheduledCommand>> patterns;  ///< for ~load_pattern, by rising time
};

/// Of the scene's liquid, N/m.
double surface_tension(const Scene& scene);

/// The relation of wall attraction and contact angle that the scene names.
/// @throws engine::InvalidInput when its file can't be read.
engine::ContactAngleCurve load_curve(const Scene& scene);

/// The relation of a microparticle's attraction A_ls and its contact angle that the scene names. Read only
/// when a contact angle is asked for. @throws engine::InvalidInput when its file can't be read.
engine::ContactAngleCurve load_microparticle_curve(const Scene& scene);

/// A_ls of a microparticle on which the liquid shows a contact angle, degrees, by that relation.
/// @throws engine::InvalidInput for an angle outside it, and with two dimensions, for which none is measured.
double microparticle_attraction(const Scene& scene, double contact_angle_deg);

/// Reads a scene; docs/scene_format.md lists the keys. Lengths, times, angles, voltages are numbers in
/// reduced units (r_c, tau), degrees and volts, or text with a unit ("1.5 mm", "20 um", "5 ms", "63 V", "150
/// deg").
/// @param file  path, or a bare name ("electrode_line") looked up in config/scenes.
/// @throws engine::InvalidInput listing *all* violations, each "file:line: key: value, allowed: ...".
Scene load_scene(const std::string& file);

/// A scene that is a board file and nothing else: no droplets, all else as a scene has it by default.
/// @param file_unit  what one unit of the file is ("1 mm"), empty when the file says so itself.
/// @throws engine::InvalidInput as load_scene.
Scene load_board(const std::string& file, double resolution, const std::string& file_unit);

/// A scene from text, for tests; `name` stands for the file in messages.
Scene parse_scene(const std::string& yaml, const std::string& name);

/// A scene from the texts that one was read from, and from nothing else. @throws engine::InvalidInput as
/// load_scene, and when one is missing.
Scene rebuild_scene(const std::vector<SceneFile>& files);

}  // namespace dmf::chip
