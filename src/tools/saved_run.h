#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace dmf::tools {

/// Where a run of hours keeps its state while it is under way, so that a killed study goes on inside it. One
/// file, checked when it is read, replaced in one go: a crash leaves the old state or the new one.
class SavedRun {
 public:
  /// @param name   what the run is called; part of the file's name, see file_name().
  /// @param every  seconds of wall time between two states; 0: one whenever asked.
  SavedRun(std::string folder, const std::string& name, double every);

  /// What an earlier call has saved. Nothing when there is no state, or when it is damaged: that is told on
  /// standard error.
  std::optional<std::string> load();
  /// Processor time that this run had taken when what load() gave was saved, s.
  double earlier_computing() const { return earlier_computing_; }
  /// Is it time for another state?
  bool due() const;
  void save(const std::string& state, std::uint64_t seed, std::uint64_t step);
  /// The run is over.
  void remove() const;

 private:
  std::string folder_, name_;
  double every_;
  double earlier_computing_ = 0, start_;
  std::chrono::steady_clock::time_point last_;
};

/// What the calling thread has had of a processor since it began, s.
double thread_seconds();

/// A run's key as a file's name: "pickup_size R=5 seed=1" is pickup_size_R5_seed1.
std::string file_name(const std::string& key);

/// Writes a text so that a reader finds the old file or the new one. @throws std::runtime_error with the
/// reason when the disk refuses.
void replace_file(const std::string& file, const std::string& text);

}  // namespace dmf::tools
