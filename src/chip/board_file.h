#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "chip/layout.h"

namespace dmf::chip {

/// What a board file of a real controller says, in metres.
struct BoardFile {
  /// Channel and outline of each, in the order of the file: m, seen from above with y up, centred around (0,
  /// 0).
  std::vector<Electrode> electrodes;
  Vector2d extent_m = Vector2d::Zero();  ///< width and height of all of it
  double pitch_m = 0;  ///< of its finest grid; without a grid the square root of the median area
  double drawn_gap_m =
      0;  ///< what the file leaves between neighbours: the median distance to the nearest one
};

/// How to read a file that does not say everything.
struct BoardFileOptions {
  std::optional<double> unit_m;          ///< one unit of the file, m, where the file says none
  std::vector<std::uint32_t> leave_out;  ///< channels to pass over
};

/// By its name: ends in .json or .svg.
bool is_board_file(const std::string& file);

/// Reads a PurpleDrop board definition (.json) or a DropBot or MicroDrop device drawing (.svg);
/// docs/board_files.md says what is read of each.
/// @throws engine::InvalidInput "file: place: value, allowed: ..." for everything that is wrong: a file over
/// 4 MiB, broken text, no electrodes, a channel given twice, outlines that are open, cross themselves or
/// overlap, no scale.
BoardFile read_board_file(const std::string& file, const BoardFileOptions& options);

/// The text that read_board_file() reads. @throws engine::InvalidInput for a file that is none or over 4 MiB.
std::string board_text(const std::string& file);

/// Same from text; `name` stands for the file in messages and ends in .json or .svg.
BoardFile parse_board_file(const std::string& text, const std::string& name, const BoardFileOptions& options);

/// The electrodes in r_c, ready for a layout. Pads that the file draws nearer to each other are drawn in
/// evenly, so that neighbours stand nine tenths of the gap apart: near enough to be neighbours however
/// unevenly they are drawn, while pads that touch at a corner are none.
/// @param length_m  one r_c.
/// @param gap  of the layout, r_c.
/// @throws engine::InvalidInput for pads that are too narrow for that.
std::vector<Electrode> electrodes_of(const BoardFile& board, double length_m, double gap);

}  // namespace dmf::chip
