#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace dmf::chip {

/// Bytes of a file that labels voxels. @throws engine::InvalidInput when it can't be read or is too large.
std::string label_file_bytes(const std::string& path);

/// Labels of a raw file: a byte a voxel, 0 fluid, 1 solid, x fastest, then y.
/// @throws engine::InvalidInput unless it has a byte for each voxel.
std::vector<std::uint8_t> raw_labels(const std::string& bytes, const std::array<int, 3>& voxels);

/// One picture of a stack.
struct LabelPicture {
  int columns = 0, rows = 0;
  std::vector<std::uint8_t> labels;  ///< row by row from the top
};
/// Labels of a PNG file of any kind, in grey: solid where the grey value, 0 (black) to 255 (white), reaches
/// the threshold. @throws engine::InvalidInput when it is no such file or larger than a label grid can be.
LabelPicture png_labels(const std::string& bytes, int threshold);

}  // namespace dmf::chip
