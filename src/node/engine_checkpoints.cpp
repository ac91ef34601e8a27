#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "node/engine_thread.h"

// The engine thread's automatic checkpoints: it copies the state, the writer's own thread does the rest.

namespace dmf::node {

chip::Checkpoint EngineThread::checkpoint() const {
  chip::Checkpoint now = chip::checkpoint_of(*experiment_);
  now.ros_time = clock_.nanoseconds(now.time);
  now.run = run_;
  now.paused = paused_;
  return now;
}

EngineThread::Progress EngineThread::progress() const {
  return {run_, experiment_->steps(), experiment_->history().size(), paused_};
}

void EngineThread::checkpoint_if_due() {
  if (!writer_) return;
  note_checkpoints();
  const Clock::time_point now = Clock::now();
  // After a fault the state is garbage, and the last checkpoint is from before.
  if (now < next_checkpoint_ || !fault_.empty()) return;
  next_checkpoint_ = now + std::chrono::duration_cast<Clock::duration>(
                               std::chrono::duration<double>(settings_.checkpoint_period));
  if (saved_progress_ == progress()) return;
  if (writer_->busy()) {
    if (checkpoints_.left_out++ == 0)
      note("checkpoint_failed", "one is left out, the last is still being written");
    return;
  }
  saved_progress_ = progress();
  writer_->put(checkpoint());
}

void EngineThread::note_checkpoints() {
  for (const chip::CheckpointWriter::Report& report : writer_->take_reports()) {
    const bool failed = !report.problem.empty();
    if (failed) {
      saved_progress_.reset();
      // Once, not every minute: diagnostics go on telling it.
      if (checkpoints_.problem.empty())
        note("checkpoint_failed", fmt::format("step {}: {}; the run goes on", report.step, report.problem));
    } else {
      checkpoints_.name = report.name;
      checkpoints_.step = report.step;
      checkpoints_.left_out = 0;
      last_checkpoint_ = Clock::now();
      note("checkpoint_saved", fmt::format("automatic: step {} in {}", report.step, report.name));
    }
    checkpoints_.problem = report.problem;
  }
}

std::string EngineThread::write_last_checkpoint() {
  if (!writer_ || thread_.joinable()) return "";
  writer_->wait();
  note_checkpoints();
  if (!fault_.empty() || saved_progress_ == progress()) return "";
  writer_->put(checkpoint());
  writer_->wait();
  note_checkpoints();
  if (!checkpoints_.problem.empty())
    return fmt::format("step {} could not be saved: {}", experiment_->steps(), checkpoints_.problem);
  return fmt::format("step {} saved in {}", checkpoints_.step, checkpoints_.name);
}

}  // namespace dmf::node
