#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "chip/polygon.h"

namespace dmf::chip {

// What a board file may ask for. Real boards have some hundred electrodes with some hundred corners; the
// limits keep a file of another kind from taking minutes and gigabytes.
constexpr std::size_t kMaxBoardElectrodes = 500;
constexpr std::size_t kMaxCorners = 1000;            ///< of one electrode
constexpr std::size_t kMaxBoardCorners = 50000;      ///< of all electrodes
constexpr double kMaxCoordinate = 1e6;               ///< in units of the file
constexpr std::uint64_t kMaxBoardChannel = 1000000;  ///< as in a scene's own `chip`

/// An electrode as a board file draws it: corners in units of the file, y down as on a screen.
struct DrawnElectrode {
  std::uint32_t channel = 0;
  Polygon outline;
  std::string place;  ///< where it stands in the file, for messages: "layout.peripherals[0].electrodes[1]"
};

/// What a board file says, before it is judged as a whole.
struct BoardDrawing {
  std::vector<DrawnElectrode> electrodes;
  std::optional<double> pitch;   ///< of the finest grid, units of the file; boards without a grid have none
  std::optional<double> unit_m;  ///< one unit of the file, m, if the file says so
  std::string unit_hint;         ///< if it does not: what the file lacks
};

/// Collects what is wrong with a board file, so that all of it is told at once; a file that is nothing but
/// faults is told the first ones.
class BoardFaults {
 public:
  /// @param place  "line 12: path electrode05" or "layout.grids[0].pitch"; empty for the file as a whole.
  void note(const std::string& place, const std::string& violation);
  bool any() const { return count_ > 0; }
  /// More would be told in numbers only.
  bool many() const { return count_ >= kMostTold; }
  /// @throws engine::InvalidInput "file: place: violation" for each, if there is any.
  void refuse_if_any(const std::string& file) const;

 private:
  static constexpr std::size_t kMostTold = 20;
  std::vector<std::string> told_;
  std::size_t count_ = 0;
};

/// A PurpleDrop board definition (JSON). docs/board_files.md says what is read.
BoardDrawing read_purpledrop(const std::string& text, BoardFaults& faults);

/// A DropBot or MicroDrop device drawing (SVG). docs/board_files.md says what is read.
BoardDrawing read_microdrop(const std::string& text, BoardFaults& faults);

}  // namespace dmf::chip
