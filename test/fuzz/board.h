#pragma once
#include "chip/board_file.h"
#include "target.h"
#include "yaml/invalid_input.h"

/// A board file of either format, told by its name: what is accepted has electrodes that are somewhere.
inline int try_board(const std::uint8_t* data, std::size_t size, const char* name) {
  using namespace dmf;
  chip::BoardFileOptions options;
  options.unit_m = 1e-3;
  for (const bool with_unit : {true, false}) try {
      const chip::BoardFile board =
          chip::parse_board_file(text_of(data, size), name, with_unit ? options : chip::BoardFileOptions{});
      require(!board.electrodes.empty() && board.pitch_m > 0, "an accepted board has electrodes and a pitch");
      for (const chip::Electrode& electrode : board.electrodes)
        for (const auto& corner : electrode.outline)
          require(corner.allFinite(), "every corner of an accepted board is somewhere");
      chip::electrodes_of(board, board.pitch_m / 10, 2);
    } catch (const InvalidInput&) {
    }
  return 0;
}
