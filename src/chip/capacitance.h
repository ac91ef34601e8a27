#pragma once
#include <cstdint>
#include <vector>

#include "chip/scene.h"
#include "engine/observe/wetted_area.h"

namespace dmf::chip {

/// Of a pad under liquid, F/m^2: that of the dielectric, for the liquid conducts.
double liquid_capacitance(const Scene& scene);
/// Of a pad under the filler between two plates, F/m^2: dielectric and filler in series. 0 for an open chip.
double filler_capacitance(const Scene& scene);

/// What liquid on the plate makes of the capacitance of each pad, without noise and offset.
class PadCapacitance {
 public:
  /// Works out which cells each pad consists of: milliseconds for a large board.
  explicit PadCapacitance(const Scene& scene);

  /// Of each pad, r_c^2, by index of the electrode.
  std::vector<double> wetted_areas(const engine::WettedArea& wetted) const;
  /// Of each pad, F: c_liquid * wetted area + c_filler * the rest.
  std::vector<double> capacitances(const engine::WettedArea& wetted) const;

 private:
  /// Part of a pad that lies in a cell of the plate.
  struct Part {
    int column, row;
    double area;  ///< r_c^2
  };

  std::vector<std::vector<Part>> parts_;  ///< by index of the electrode
  std::vector<double> pad_areas_;         ///< r_c^2
  double liquid_, filler_;                ///< F / r_c^2
};

/// What a board senses of all its channels at one step.
struct CapacitanceReading {
  std::uint64_t step = 0;
  std::vector<double> capacitance;  ///< F, by index of the electrode
};

/// Adds to each channel's capacitance what the electronics add: the offset and Gaussian noise, a function of
/// seed, step and channel.
CapacitanceReading read_channels(std::vector<double> capacitance, const Scene& scene, std::uint64_t seed,
                                 std::uint64_t step);

}  // namespace dmf::chip
