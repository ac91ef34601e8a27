#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "controller/goal.h"
#include "controller/operation.h"

namespace dmf::controller {

/// Switches exactly these channels on for a while, as the steps of MicroDrop do.
struct Activate {
  Channels channels;
  double duration = 0;  ///< s
  /// Wetted fraction that each of the channels shall reach: the step is done as soon as they have, and fails
  /// when they have not within the duration.
  std::optional<double> volume_threshold;
};
/// Holds all droplets where they are.
struct Wait {
  double duration = 0;  ///< s
};
/// Operations side by side; the step is done when all are.
struct Parallel {
  std::vector<Goal> goals;
};

struct Step {
  std::string name;                 ///< for people
  std::optional<double> voltage;    ///< V rms, from this step on
  std::optional<double> frequency;  ///< Hz
  std::variant<Activate, Wait, Parallel> work;
};

struct Protocol {
  std::string name;
  std::vector<Step> steps;
};

/// Reads a protocol; docs/controller.md lists the keys. Times need a unit ("2.5 s").
/// @throws InvalidInput with everything that is wrong, "file:line: key: value, allowed: ...": unknown keys,
/// channels that do not exist, times that are not above 0, voltages above the highest, ways that leave the
/// electrodes.
Protocol load_protocol(const std::string& file, const Layout& layout, double max_voltage);
/// The same from text; `name` stands for the file in messages.
Protocol parse_protocol(const std::string& text, const std::string& name, const Layout& layout,
                        double max_voltage);

}  // namespace dmf::controller
