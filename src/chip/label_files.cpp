#include "chip/label_files.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "engine/parameters.h"

namespace dmf::chip {

using engine::LabelGrid;

std::string label_file_bytes(const std::string& path) {
  std::error_code error;
  // A pipe or a device would never come to an end.
  if (!std::filesystem::is_regular_file(path, error))
    throw engine::InvalidInput(fmt::format("{}: is no file", path));
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error || bytes == 0 || bytes > LabelGrid::most)
    throw engine::InvalidInput(fmt::format("{}: {} bytes, allowed: 1 to {}", path, bytes, LabelGrid::most));
  std::string text(bytes, '\0');
  std::ifstream input(path, std::ios::binary);
  if (!input.read(text.data(), static_cast<std::streamsize>(bytes)))
    throw engine::InvalidInput(fmt::format("{}: can't be read", path));
  return text;
}

std::vector<std::uint8_t> raw_labels(const std::string& bytes, const std::array<int, 3>& voxels) {
  const std::size_t count = static_cast<std::size_t>(voxels[0]) * voxels[1] * voxels[2];
  if (bytes.size() != count)
    throw engine::InvalidInput(fmt::format("the file has {} bytes, allowed: {} x {} x {} = {}, one a voxel",
                                           bytes.size(), voxels[0], voxels[1], voxels[2], count));
  return {bytes.begin(), bytes.end()};
}

LabelPicture png_labels(const std::string& bytes, int threshold) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const auto refuse = [&image](const std::string& why) {
    png_image_free(&image);
    throw engine::InvalidInput(why);
  };
  if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()))
    refuse(fmt::format("{}, allowed: a PNG picture", image.message));
  // Before any of it is allocated.
  if (image.width > LabelGrid::most_along || image.height > LabelGrid::most_along ||
      std::size_t{image.width} * image.height > LabelGrid::most)
    refuse(fmt::format("{} x {} pixels, allowed: up to {} along a side, {} in all", image.width, image.height,
                       LabelGrid::most_along, LabelGrid::most));
  image.format = PNG_FORMAT_GRAY;
  LabelPicture picture;
  picture.columns = static_cast<int>(image.width);
  picture.rows = static_cast<int>(image.height);
  picture.labels.resize(PNG_IMAGE_SIZE(image));
  const png_color black{0, 0, 0};
  if (!png_image_finish_read(&image, &black, picture.labels.data(), 0, nullptr))
    refuse(fmt::format("{}, allowed: a PNG picture", image.message));
  for (std::uint8_t& value : picture.labels) value = value >= threshold ? LabelGrid::solid : LabelGrid::fluid;
  return picture;
}

}  // namespace dmf::chip
