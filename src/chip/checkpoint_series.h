#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "chip/checkpoint_file.h"
#include "chip/experiment.h"

namespace dmf::chip {

/// The checkpoints that a program writes by itself while a run goes on: PREFIX, a number of twelve digits,
/// SUFFIX. The last ones are kept. What else lies in the folder is none of its business. One process writes a
/// series at a time: a lock, which ends with the process however it ends, keeps others out.
class CheckpointSeries {
 public:
  enum class Numbering {
    by_step,  ///< the number is the step
    counted,  ///< one more than the highest there is: where runs start over, a later one has a higher number
  };

  /// @param keep  how many are kept, > 0.
  CheckpointSeries(std::filesystem::path folder, std::string prefix, std::string suffix, Numbering numbering,
                   unsigned keep);

  /// Takes the lock, and what an earlier owner left unfinished away. write() does so by itself.
  /// @throws engine::InvalidInput when another process has it; std::runtime_error when the disk refuses.
  void claim();

  /// Writes one more, then takes those away that are older than the ones to keep. Numbers above the written
  /// one stay: an older run, or one that is damaged, is not older than what it was passed over for.
  /// @returns its name. @throws as claim() and CheckpointFolder::write().
  std::string write(const Checkpoint& checkpoint);

  /// Of those that are there, rising.
  std::vector<std::uint64_t> numbers() const;
  std::uint64_t next_number() const;
  std::string name_of(std::uint64_t number) const;
  const CheckpointFolder& folder() const { return folder_; }
  const std::string& prefix() const { return prefix_; }

 private:
  class Lock;
  std::uint64_t number_in(const std::string& name) const;  ///< kNone when it is not of this series

  CheckpointFolder folder_;
  std::string prefix_, suffix_;
  Numbering numbering_;
  unsigned keep_;
  std::shared_ptr<Lock> lock_;
};

/// Which checkpoint of a series a run may go on from.
struct ResumeRule {
  std::uint64_t first_number = 0;     ///< none before this one
  std::optional<std::uint64_t> seed;  ///< of this seed only
};

struct ResumePoint {
  std::string name;
  Checkpoint checkpoint;  ///< without its state, which the experiment has now
};

/// Goes on from the newest good checkpoint of the experiment's scene. Those that can't be used are told to
/// `passed_over`, by name and with the reason. @returns nothing, the experiment unchanged, when none can.
std::optional<ResumePoint> resume(Experiment& experiment, const CheckpointSeries& series,
                                  const ResumeRule& rule,
                                  const std::function<void(const std::string&)>& passed_over);

}  // namespace dmf::chip
