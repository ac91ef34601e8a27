#include "chip/checkpoint_writer.h"

#include <exception>
#include <utility>

namespace dmf::chip {

CheckpointWriter::CheckpointWriter(CheckpointSeries series) : series_(std::move(series)) {
  thread_ = std::thread([this] { loop(); });
}

CheckpointWriter::~CheckpointWriter() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

bool CheckpointWriter::put(Checkpoint checkpoint) {
  const std::lock_guard lock(mutex_);
  if (next_ || writing_) return false;
  next_ = std::move(checkpoint);
  changed_.notify_all();
  return true;
}

bool CheckpointWriter::busy() {
  const std::lock_guard lock(mutex_);
  return next_ || writing_;
}

void CheckpointWriter::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !next_ && !writing_; });
}

std::vector<CheckpointWriter::Report> CheckpointWriter::take_reports() {
  const std::lock_guard lock(mutex_);
  return std::exchange(reports_, {});
}

void CheckpointWriter::loop() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return next_ || stopping_; });
    if (!next_) return;
    const Checkpoint checkpoint = std::move(*next_);
    next_.reset();
    writing_ = true;
    lock.unlock();
    Report report;
    report.step = checkpoint.step;
    try {
      report.name = series_.write(checkpoint);
    } catch (const std::exception& error) {
      report.problem = error.what();
    }
    lock.lock();
    reports_.push_back(std::move(report));
    writing_ = false;
    changed_.notify_all();
  }
}

}  // namespace dmf::chip
