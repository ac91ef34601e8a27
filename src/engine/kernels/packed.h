#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "engine/beads.h"
#include "engine/neighbours.h"

namespace dmf::engine {

/// What the kernels lay side by side while they work on one cell. Whole lanes are written behind each array.
struct Packed {
  float *x, *y, *z;               ///< beads near the cell
  std::uint32_t* name;            ///< and which they are
  float* squared_distance;        ///< of the pairs of all beads of the cell, row after row
  std::uint16_t* in_range;        ///< slots, likewise
  std::uint32_t* first_distance;  ///< of each bead of the cell, and the end
  std::uint32_t* bead_in_slot;    ///< 0 until numbered
  std::uint32_t* wall_in_range;   ///< of one bead
};

/// Memory of one thread for what is packed.
///
/// The processor takes a load for a reload of what was just stored when the lower 12 bits of their addresses
/// agree, and waits. So what a sweep loads (x, y, z, name) and what it stores (distances, slots) begin at
/// different places of a page: 41 instead of 65 ns a bead for the density pass, and the same with every
/// thread, wherever its memory happens to lie.
class Workbench {
 public:
  static Workbench& of_this_thread() {
    static thread_local Workbench workbench;
    return workbench;
  }

  /// Room for the largest cell of the block; holds until the next call.
  Packed room_for(const NeighbourBlock& block) {
    std::size_t beads = 0;
    for (const NeighbourCell& cell : block.cells) beads = std::max<std::size_t>(beads, cell.end - cell.begin);
    const std::size_t near = std::max({block.slots, block.wall_slots, block.body_slots});
    const std::size_t pairs = std::max<std::size_t>(beads, 1) * near;
    Packed packed;
    // Once to count, once to deal out.
    for (const bool counting : {true, false}) {
      std::size_t used = 0;
      const auto deal = [&](auto*& array, std::size_t count, std::size_t place_in_page) {
        array = reinterpret_cast<std::decay_t<decltype(array)>>(
            counting ? nullptr : memory_.data() + used + place_in_page);
        used += (place_in_page + (count + most_lanes) * sizeof *array + page - 1) / page * page;
      };
      deal(packed.x, near, 0);
      deal(packed.y, near, 64);
      deal(packed.z, near, 128);
      deal(packed.name, near, 192);
      deal(packed.squared_distance, pairs, 2048);
      deal(packed.in_range, pairs, 3072);
      deal(packed.first_distance, beads + 1, 0);
      deal(packed.bead_in_slot, near, 0);
      deal(packed.wall_in_range, near, 1024);
      if (memory_.size() < used) memory_.resize(used);
    }
    std::fill_n(packed.bead_in_slot, near + most_lanes, 0u);
    return packed;
  }

 private:
  static constexpr std::size_t page = 4096, most_lanes = 64;
  AlignedVector<char> memory_;
};

}  // namespace dmf::engine
