#pragma once
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "chip/checkpoint_series.h"

namespace dmf::chip {

/// Writes the checkpoints of a series on a thread of its own, one at a time: whoever runs the experiment
/// copies its state and goes on, and does not wait for the disk.
class CheckpointWriter {
 public:
  /// What became of one checkpoint.
  struct Report {
    std::uint64_t step = 0;
    std::string name;     ///< that it has; empty when it could not be written
    std::string problem;  ///< why not
  };

  explicit CheckpointWriter(CheckpointSeries series);
  /// Waits for the write that is under way.
  ~CheckpointWriter();
  CheckpointWriter(const CheckpointWriter&) = delete;
  CheckpointWriter& operator=(const CheckpointWriter&) = delete;

  /// Hands a checkpoint over. False, and nothing is done, while the last one is still being written.
  bool put(Checkpoint checkpoint);
  /// A checkpoint is being written: the next would not be taken.
  bool busy();
  /// Until nothing is being written.
  void wait();
  /// What became of those that were put in since the last call, in order.
  std::vector<Report> take_reports();

 private:
  void loop();

  CheckpointSeries series_;  ///< of the thread
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Checkpoint> next_;
  bool writing_ = false, stopping_ = false;
  std::vector<Report> reports_;
  std::thread thread_;
};

}  // namespace dmf::chip
