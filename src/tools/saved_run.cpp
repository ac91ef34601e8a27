#include "tools/saved_run.h"

#include <fmt/format.h>
#include <time.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "chip/checkpoint_file.h"
#include "engine/archive.h"
#include "engine/parameters.h"

namespace dmf::tools {

SavedRun::SavedRun(std::string folder, const std::string& name, double every)
    : folder_(std::move(folder)),
      name_(file_name(name) + ".state"),
      every_(every),
      start_(thread_seconds()),
      last_(std::chrono::steady_clock::now()) {}

std::optional<std::string> SavedRun::load() {
  if (!std::filesystem::exists(folder_ + "/" + name_)) return std::nullopt;
  try {
    engine::Archive archive(chip::CheckpointFolder(folder_).read(name_).state);
    std::vector<char> state;
    archive(earlier_computing_);
    archive(state);
    return std::string(state.begin(), state.end());
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
  engine::Archive archive;
  double computing = earlier_computing_ + thread_seconds() - start_;
  std::vector<char> bytes(state.begin(), state.end());
  archive(computing);
  archive(bytes);
  checkpoint.state = archive.take();
  chip::CheckpointFolder(folder_).write(name_, checkpoint);
  last_ = std::chrono::steady_clock::now();
}

void SavedRun::remove() const { std::filesystem::remove(folder_ + "/" + name_); }

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

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
