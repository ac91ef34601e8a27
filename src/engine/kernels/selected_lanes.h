#pragma once
#include <cstdint>

namespace dmf::engine {

/// For each pattern of up to eight mask bits: the lanes that are set, first to last, then whatever; and how
/// many.
struct SelectedLanes {
  std::uint8_t order[256][8];
  std::uint8_t count[256];
};

constexpr SelectedLanes make_selected_lanes() {
  SelectedLanes table{};
  for (int bits = 0; bits < 256; ++bits)
    for (int lane = 0; lane < 8; ++lane)
      if (bits >> lane & 1) table.order[bits][table.count[bits]++] = static_cast<std::uint8_t>(lane);
  return table;
}

inline constexpr SelectedLanes selected_lanes = make_selected_lanes();

}  // namespace dmf::engine
