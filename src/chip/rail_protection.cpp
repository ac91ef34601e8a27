#include "chip/rail_protection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dmf::chip {

double pad_current(const Board& board, const std::vector<double>& capacitances) {
  constexpr double kTwoPi = 2 * M_PI;
  double charge = 0;
  for (std::size_t index = 0; index < capacitances.size(); ++index)
    charge += capacitances[index] * board.voltage(index);
  return kTwoPi * board.rail().frequency * charge;
}

std::optional<Trip> find_trip(const Board& board, const Scene& scene,
                              const std::function<std::vector<double>()>& capacitances) {
  const std::vector<Electrode>& electrodes = scene.layout.electrodes();
  const double breakdown = scene.electrowetting.breakdown_voltage;
  Trip trip;
  std::vector<std::uint32_t> shorted;
  double highest = 0;
  for (std::size_t index = 0; index < electrodes.size(); ++index) {
    const double voltage = board.voltage(index);
    if (breakdown > 0 && voltage > breakdown) {
      trip.broken_down.push_back(electrodes[index].channel);
      highest = std::max(highest, voltage);
    } else if (voltage > 0 && board.faults(index).shorted) {
      shorted.push_back(electrodes[index].channel);
    }
  }
  if (!trip.broken_down.empty()) {
    trip.reason = fmt::format("the dielectric of channel {} broke down: {} V, allowed: up to {} V",
                              fmt::join(trip.broken_down, ", "), highest, breakdown);
    return trip;
  }
  if (!shorted.empty()) {
    trip.reason = fmt::format("over-current: channel {} is shorted", fmt::join(shorted, ", "));
    return trip;
  }
  if (scene.rail.current_limit > 0) {
    const double current = pad_current(board, capacitances());
    if (current > scene.rail.current_limit) {
      trip.reason =
          fmt::format("over-current: {:.4g} A, allowed: up to {:.4g} A", current, scene.rail.current_limit);
      return trip;
    }
  }
  return std::nullopt;
}

}  // namespace dmf::chip
