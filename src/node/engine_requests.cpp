#include <fmt/format.h>

#include <utility>
#include <variant>

#include "node/engine_thread.h"
#include "node/process_memory.h"

// What others ask of the engine thread. Each request runs on it, between two steps.

namespace dmf::node {

template <class Request>
auto EngineThread::ask(Request request) -> decltype(request()) {
  // std::function wants something that can be copied, which a packaged task can't.
  auto task = std::make_shared<std::packaged_task<decltype(request())()>>(std::move(request));
  auto answer = task->get_future();
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) throw EngineStopped();
    requests_.emplace_back([task] { (*task)(); });
    requested_.notify_all();
  }
  task.reset();  // the queue's copy is the only one: dropping it breaks the promise
  try {
    return answer.get();
  } catch (const std::future_error&) {
    throw EngineStopped();
  }
}

chip::Reply EngineThread::apply(const chip::Command& command) {
  return ask([this, &command] {
    const bool reset = std::holds_alternative<chip::Reset>(command);
    if (!reset && !fault_.empty()) {
      chip::Reply refused;
      refused.message = "refused, the run was halted: " + fault_ + "; allowed: ~reset, ~load_checkpoint";
      refused.step = experiment_->steps();
      return refused;
    }
    const double old_time = time_of(experiment_->steps());
    if (reset) collect_events();
    chip::Reply reply = experiment_->apply(command);
    if (fault_.empty() && !experiment_->fault().empty()) halt(experiment_->fault());
    if (!reply.success) return reply;
    if (reset) {
      end_advance(false, "ended by ~reset");
      begin_run(old_time);
      note("reset", "the scene from its start");
      release_memory();
      if (paused_) reply.message += "; paused, ~unpause_physics starts it";
    } else {
      collect_commands();
      collect_scheduled();
      collect_events();
      if (paused_) {
        reply.message += "; paused, it acts from the next step on";
        publish_soon();
      }
    }
    return reply;
  });
}

Outcome EngineThread::pause() {
  return ask([this]() -> Outcome {
    const std::uint64_t step = experiment_->steps();
    if (!fault_.empty()) return {true, "already halted by a fault: " + fault_, step};
    end_advance(false, "ended by ~pause_physics");
    if (paused_) return {true, "was paused already", step};
    paused_ = true;
    put_hash();
    note("paused", "");
    publish_soon();
    return {true, fmt::format("paused at step {}", step), step};
  });
}

Outcome EngineThread::resume() {
  return ask([this]() -> Outcome {
    const std::uint64_t step = experiment_->steps();
    if (!fault_.empty()) {
      return {false, "refused, the run was halted: " + fault_ + "; allowed: ~reset, ~load_checkpoint", step};
    }
    if (!paused_) return {true, "was running already", step};
    paused_ = false;
    rate_.restart(Clock::now(), step);
    note("unpaused", "");
    publish_soon();
    return {true, fmt::format("goes on from step {}", step), step};
  });
}

Outcome EngineThread::advance(std::uint64_t steps) {
  using Answer = std::variant<Outcome, std::future<Outcome>>;
  Answer answer = ask([this, steps]() -> Answer {
    const std::uint64_t now = experiment_->steps();
    if (steps < 1 || steps > kMaxAdvance) {
      return Outcome{false, fmt::format("steps: {}, allowed: 1 to {}", steps, kMaxAdvance), now};
    }
    if (!fault_.empty()) {
      return Outcome{false, "refused, the run was halted: " + fault_ + "; allowed: ~reset, ~load_checkpoint",
                     now};
    }
    if (!paused_) return Outcome{false, "refused, the run is not paused; call ~pause_physics first", now};
    if (advance_) {
      return Outcome{
          false,
          fmt::format("refused, another ~step is under way ({} of {} steps done); wait for it or end it "
                      "with ~pause_physics",
                      advance_->done, advance_->asked),
          now};
    }
    advance_.emplace();
    advance_->asked = steps;
    rate_.restart(Clock::now(), now);
    publish_soon();  // from here on at the full rate
    return advance_->answer.get_future();
  });
  if (auto* refused = std::get_if<Outcome>(&answer)) return *refused;
  try {
    return std::get<std::future<Outcome>>(answer).get();
  } catch (const std::future_error&) {
    throw EngineStopped();
  }
}

std::shared_ptr<const Frame> EngineThread::inspect(bool hash) {
  return ask([this, hash] {
    engine::ObserveRequest request;
    request.hash = hash;
    return make_frame(request);
  });
}

Explained EngineThread::explain_droplet(std::uint32_t id) {
  return ask([this, id] {
    Explained explained;
    explained.outcome.step = experiment_->steps();
    if (!fault_.empty()) {
      explained.outcome.message =
          "refused, the run was halted: " + fault_ + "; allowed: ~reset, ~load_checkpoint";
      return explained;
    }
    try {
      explained.explanation = experiment_->explain_droplet(id);
      explained.outcome.success = true;
      explained.outcome.message = explained.explanation.message;
    } catch (const engine::InvalidInput& error) {
      explained.outcome.message = error.what();
    }
    return explained;
  });
}

chip::ShortsReport EngineThread::detect_shorts() {
  return ask([this] {
    if (fault_.empty()) return experiment_->detect_shorts();
    chip::ShortsReport refused;
    refused.message = "refused, the run was halted: " + fault_ + "; allowed: ~reset, ~load_checkpoint";
    return refused;
  });
}

SavedRun EngineThread::save() {
  return ask([this] {
    SavedRun saved;
    saved.outcome.step = experiment_->steps();
    if (!fault_.empty()) {
      saved.outcome.message = "refused, the run was halted: " + fault_ + "; its state is not worth keeping";
      return saved;
    }
    saved.checkpoint = checkpoint();
    saved.outcome.success = true;
    return saved;
  });
}

Outcome EngineThread::load(const std::string& state, const std::string& name) {
  return ask([this, &state, &name]() -> Outcome {
    const double old_time = time_of(experiment_->steps());
    collect_events();
    try {
      experiment_->load(state);
    } catch (const engine::InvalidInput& error) {
      return {false, error.what(), experiment_->steps()};
    }
    end_advance(false, "ended by ~load_checkpoint");
    begin_run(old_time);
    note("checkpoint_loaded", name);
    return {true, "", experiment_->steps(), run_, clock_.nanoseconds(time_of(experiment_->steps()))};
  });
}

void EngineThread::announce(const std::string& kind, const std::string& message) {
  ask([this, &kind, &message] { note(kind, message); });
}

}  // namespace dmf::node
