#include "chip/configuration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "engine/parameters.h"
#include "engine/yaml_reader.h"

namespace dmf::chip {

namespace fs = std::filesystem;

std::string config_directory() {
  const char* chosen = std::getenv("DMF_SIM_CONFIG");
  if (chosen && *chosen) return chosen;
  std::error_code ignored;
  return fs::is_directory(DMF_SOURCE_CONFIG_DIR, ignored) ? DMF_SOURCE_CONFIG_DIR : DMF_INSTALL_CONFIG_DIR;
}

std::string find_config(const std::string& kind, const std::string& name) {
  const fs::path as_path(name);
  if (name.find('/') != std::string::npos || as_path.extension() == ".yaml") return name;

  const fs::path directory = fs::path(config_directory()) / kind;
  std::error_code error;
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  if (std::count(names.begin(), names.end(), name)) return (directory / (name + ".yaml")).string();
  const std::string near = engine::nearest_word(name, names);
  const std::string hint = near.empty() ? "" : fmt::format(" (did you mean {}?)", near);
  throw engine::InvalidInput(
      fmt::format("{}: there is no such file in {}{}, allowed: {}", name, directory.string(), hint,
                  names.empty() ? "a path" : fmt::format("{}, or a path", fmt::join(names, ", "))));
}

}  // namespace dmf::chip
