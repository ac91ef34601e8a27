#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "chip/board.h"

namespace dmf::chip {

/// Why the board's protection halts the rail.
struct Trip {
  std::string reason;
  std::vector<std::uint32_t> broken_down;  ///< channels whose dielectric failed: shorted from then on
};

/// Current of the pads, A rms: 2 pi f sum C_i V_i, what charges and discharges them at the rail's frequency.
/// None at DC.
/// @param capacitances  F, by index of the electrode.
double pad_current(const Board& board, const std::vector<double>& capacitances);

/// What is wrong with the voltages on a board's pads: one above the breakdown voltage, one on a shorted pad,
/// more current than `rail.current_limit` allows. Empty when nothing is.
/// @param capacitances  asked for only when the current is limited.
std::optional<Trip> find_trip(const Board& board, const Scene& scene,
                              const std::function<std::vector<double>()>& capacitances);

}  // namespace dmf::chip
