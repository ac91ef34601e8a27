#include "tools/saved_run.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "chip/checkpoint_file.h"
#include "engine/parameters.h"

namespace dmf::tools {

SavedRun::SavedRun(std::string folder, const std::string& name, double every)
    : folder_(std::move(folder)),
      name_(file_name(name) + ".state"),
      every_(every),
      last_(std::chrono::steady_clock::now()) {}

std::optional<std::string> SavedRun::load() const {
  if (!std::filesystem::exists(folder_ + "/" + name_)) return std::nullopt;
  try {
    return chip::CheckpointFolder(folder_).read(name_).state;
  } catch (const engine::InvalidInput& problem) {
    fmt::print(stderr, "{}/{}: passed over, the run starts again: {}\n", folder_, name_, problem.what());
    return std::nullopt;
  }
}

bool SavedRun::due() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - last_).count() >= every_;
}

void SavedRun::save(const std::string& state, std::uint64_t seed, std::uint64_t step) {
  chip::Checkpoint checkpoint;
  checkpoint.scene = name_;
  checkpoint.seed = seed;
  checkpoint.step = step;
  checkpoint.state = state;
  chip::CheckpointFolder(folder_).write(name_, checkpoint);
  last_ = std::chrono::steady_clock::now();
}

void SavedRun::remove() const { std::filesystem::remove(folder_ + "/" + name_); }

std::string file_name(const std::string& key) {
  std::string name;
  for (const char c : key) {
    if (c == '=') continue;
    name += c == ' ' || c == '/' || c == ',' ? '_' : c;
  }
  return name;
}

void replace_file(const std::string& file, const std::string& text) {
  if (const auto folder = std::filesystem::path(file).parent_path(); !folder.empty())
    std::filesystem::create_directories(folder);
  const std::string temporary = file + ".new";
  std::ofstream out(temporary);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(fmt::format("{}: can't be written; is the disk full?", temporary));
  std::filesystem::rename(temporary, file);
}

}  // namespace dmf::tools
