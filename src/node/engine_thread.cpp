#include "node/engine_thread.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

namespace dmf::node {

namespace {

std::chrono::nanoseconds period(double rate) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / rate));
}

std::chrono::nanoseconds seconds(double time) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * time));
}

const char* kind_name(engine::DropletEvent::Kind kind) {
  switch (kind) {
    case engine::DropletEvent::Kind::appeared:
      return "appeared";
    case engine::DropletEvent::Kind::vanished:
      return "vanished";
    case engine::DropletEvent::Kind::merged:
      return "merged";
    case engine::DropletEvent::Kind::split:
      return "split";
  }
  return "";
}

std::string describe(const engine::DropletEvent& event) {
  const std::string from = fmt::format("{}", fmt::join(event.from, ", "));
  const std::string to = fmt::format("{}", fmt::join(event.to, ", "));
  switch (event.kind) {
    case engine::DropletEvent::Kind::appeared:
      return "droplet " + to + " appeared";
    case engine::DropletEvent::Kind::vanished:
      return "droplet " + from + " vanished";
    case engine::DropletEvent::Kind::merged:
      return "droplets " + from + " merged into " + to;
    case engine::DropletEvent::Kind::split:
      return "droplet " + from + " split into " + to;
  }
  return "";
}

std::string describe(const engine::MicroparticleEvent& event) {
  const bool picked_up = event.kind == engine::MicroparticleEvent::Kind::picked_up;
  return fmt::format("droplet {} {} microparticle {}", event.droplet, picked_up ? "took up" : "lost",
                     event.microparticle);
}

}  // namespace

EngineThread::EngineThread(std::unique_ptr<chip::Experiment> experiment, const EngineSettings& settings,
                           chip::CheckpointWriter* writer)
    : experiment_(std::move(experiment)),
      settings_(settings),
      clock_(settings.ros_seconds_per_time_unit, settings.ros_start, time_of(experiment_->steps())),
      run_(settings.first_run),
      paused_(settings.paused),
      writer_(settings.checkpoint_period > 0 ? writer : nullptr) {
  thread_ = std::thread([this] { loop(); });
}

EngineThread::~EngineThread() { stop(); }

void EngineThread::stop() {
  std::deque<std::function<void()>> abandoned;
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    abandoned.swap(requests_);  // their broken promises tell whoever waits
    requested_.notify_all();
  }
  abandoned.clear();
  if (thread_.joinable()) thread_.join();
  advance_.reset();
  outbox_.close();
}

// ---- the thread itself ----

void EngineThread::loop() {
  next_step_ = next_frame_ = next_display_ = Clock::now();
  rate_.restart(Clock::now(), experiment_->steps());
  last_checkpoint_ = Clock::now();
  next_checkpoint_ = last_checkpoint_ + seconds(settings_.checkpoint_period);
  saved_progress_ = progress();  // the scene's start, or a checkpoint: there already
  collect_commands();
  if (!settings_.resumed_from.empty()) note("checkpoint_loaded", settings_.resumed_from);
  begin_chain();
  while (run_requests()) {
    if (moving()) {
      if (Clock::now() >= next_step_) {
        step();
      } else {
        paced_ = true;
        wait_until(std::min(next_step_, next_frame_));
      }
    } else {
      wait_until(next_frame_);
    }
    publish_if_due();
    checkpoint_if_due();
  }
}

bool EngineThread::run_requests() {
  while (true) {
    std::function<void()> request;
    {
      const std::lock_guard lock(mutex_);
      if (stopping_) return false;
      if (requests_.empty()) return true;
      request = std::move(requests_.front());
      requests_.pop_front();
    }
    request();
  }
}

void EngineThread::wait_until(Clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  requested_.wait_until(lock, deadline, [this] { return stopping_ || !requests_.empty(); });
}

void EngineThread::step() {
  try {
    experiment_->step();
  } catch (
      const std::exception& error) {  // an Instability, or memory that ran out: the state can't be trusted
    halt(error.what());
    return;
  }
  collect_scheduled();
  if (chain_ && experiment_->steps() % settings_.hash_interval == 0) put_hash();
  if (settings_.max_steps_per_second > 0) {
    // A step that came late is not made up for: the limit holds from step to step.
    next_step_ = std::max(next_step_ + period(settings_.max_steps_per_second), Clock::now());
  }
  const std::uint64_t stamp = clock_.nanoseconds(time_of(experiment_->steps()));
  if (stamp >= last_tick_ + kClockTick) {
    outbox_.put_clock(stamp);
    last_tick_ = stamp;
  }
  if (advance_ && ++advance_->done == advance_->asked) {
    collect_events();
    end_advance(true, fmt::format("{} steps done", advance_->asked));
  }
}

void EngineThread::halt(const std::string& reason) {
  fault_ = experiment_->fault().empty() ? reason : experiment_->fault();
  paused_ = true;
  collect_events();
  note("fault", fault_);
  end_advance(false, "the run was halted: " + fault_);
  publish_soon();
}

void EngineThread::end_advance(bool success, const std::string& message) {
  if (!advance_) return;
  std::promise<Outcome> answer = std::move(advance_->answer);
  advance_.reset();
  publish_soon();
  answer.set_value({success, message, experiment_->steps()});
}

void EngineThread::begin_run(double old_time) {
  ++run_;
  fault_.clear();
  last_snapshot_.reset();
  clock_.start_run(old_time, time_of(experiment_->steps()));
  rate_.restart(Clock::now(), experiment_->steps());
  commands_seen_ = 0;
  served_listeners_ = 0;
  next_checkpoint_ = Clock::now();  // who comes back shall not find the run that was left
  collect_commands();
  begin_chain();
  publish_soon();
}

void EngineThread::begin_chain() {
  if (settings_.hash_interval == 0) return;
  chain_.emplace(chip::fingerprint(experiment_->scene().files), seed(), settings_.hash_interval);
  put_hash();
}

void EngineThread::put_hash() {
  if (!chain_ || !fault_.empty() || chain_->has(experiment_->steps(), experiment_->history().size())) return;
  engine::ObserveRequest request;
  request.hash = true;
  const auto snapshot = experiment_->observe(request);
  StateHashNote note;
  note.stamp = clock_.nanoseconds(time_of(snapshot->step));
  note.run = run_;
  note.seed = seed();
  note.record = chain_->add(snapshot->step, *snapshot->state_hash, experiment_->history());
  outbox_.put(std::move(note));
}

void EngineThread::publish_if_due() {
  const Clock::time_point now = Clock::now();
  if (now < next_frame_) return;
  const double rate = moving() ? settings_.publish_rate : std::min(settings_.publish_rate, kIdleRate);
  // On the beat, but a frame that came late is not made up for.
  next_frame_ = std::max(next_frame_ + period(rate), now);
  engine::ObserveRequest request;
  if (beads_wanted_ && now >= next_display_) {
    request.beads = true;
    next_display_ = std::max(next_display_ + period(settings_.display_rate), now);
  }
  collect_events();
  auto frame = make_frame(request);
  last_tick_ = frame->stamp;
  paced_ = false;
  outbox_.put(std::move(frame));
  put_capacitance();
}

void EngineThread::put_capacitance() {
  if (!fault_.empty()) return;
  const std::uint32_t listeners = capacitance_listeners_;
  experiment_->want_readings(listeners > 0);
  std::optional<chip::CapacitanceReading> reading = experiment_->take_reading();
  if (!reading && listeners > served_listeners_) reading = experiment_->sense();
  served_listeners_ = listeners;
  if (!reading || listeners == 0) return;
  CapacitanceNote result;
  result.time = time_of(reading->step);
  result.stamp = clock_.nanoseconds(result.time);
  result.run = run_;
  result.reading = std::move(*reading);
  outbox_.put(std::move(result));
}

std::shared_ptr<const Frame> EngineThread::make_frame(const engine::ObserveRequest& request) {
  auto frame = std::make_shared<Frame>();
  if (fault_.empty()) last_snapshot_ = experiment_->observe(request);
  // A fault before the first look leaves nothing that could be shown.
  frame->snapshot = last_snapshot_ ? last_snapshot_ : std::make_shared<engine::Snapshot>();
  frame->has_beads = fault_.empty() && request.beads;
  frame->stamp = clock_.nanoseconds(time_of(experiment_->steps()));
  frame->run = run_;
  frame->seed = seed();
  frame->kernel = experiment_->simulation().kernel();
  frame->threads = experiment_->simulation().threads();
  frame->electrodes = experiment_->electrodes();
  frame->rail = experiment_->rail();
  frame->body_forces = experiment_->simulation().body_forces();
  for (const auto& droplet : frame->snapshot->droplets) {
    frame->channels.push_back(experiment_->channels_under(droplet));
  }
  frame->paused = paused_;
  frame->fault = fault_;
  frame->checkpoints = checkpoints_;
  frame->checkpoints.wanted = writer_ != nullptr;
  frame->checkpoints.age = std::chrono::duration<double>(Clock::now() - last_checkpoint_).count();
  if (moving()) {
    frame->steps_per_second = rate_.update(Clock::now(), experiment_->steps());
  } else {
    rate_.restart(Clock::now(), experiment_->steps());
  }
  frame->limit = !fault_.empty() ? Limit::fault
                 : !moving()     ? Limit::paused
                 : paced_        ? Limit::max_steps_per_second
                                 : Limit::engine;
  return frame;
}

void EngineThread::collect_commands() {
  const auto& history = experiment_->history();
  for (; commands_seen_ < history.size(); ++commands_seen_) {
    const chip::CommandRecord& record = history[commands_seen_];
    CommandNote command;
    command.time = time_of(record.step);
    command.stamp = clock_.nanoseconds(command.time);
    command.run = run_;
    command.index = static_cast<std::uint32_t>(commands_seen_);
    command.record = record;
    outbox_.put(std::move(command));
    // The history of a restored run was announced when it happened.
    const auto* pattern = std::get_if<chip::LoadPattern>(&record.command);
    if (pattern && record.step == experiment_->steps()) note("pattern", pattern->name);
  }
}

void EngineThread::collect_scheduled() {
  for (const chip::ScheduledReply& played : experiment_->take_scheduled_replies()) {
    const char* verdict = played.reply.success ? "" : "refused, ";
    note("scheduled", fmt::format("{}: {}{}", chip::name_of(played.command), verdict, played.reply.message),
         played.reply.step);
  }
}

void EngineThread::collect_events() {
  std::vector<EventNote> notes;
  const auto add = [this, &notes](std::uint64_t step, const char* kind,
                                  const std::string& message) -> EventNote& {
    EventNote& result = notes.emplace_back();
    result.step = step;
    result.time = time_of(step);
    result.stamp = clock_.nanoseconds(result.time);
    result.run = run_;
    result.kind = kind;
    result.message = message;
    return result;
  };
  for (const engine::DropletEvent& event : experiment_->take_events()) {
    EventNote& result = add(event.step, kind_name(event.kind), describe(event));
    result.before = event.from;
    result.after = event.to;
  }
  for (const engine::MicroparticleEvent& event : experiment_->take_microparticle_events()) {
    const bool picked_up = event.kind == engine::MicroparticleEvent::Kind::picked_up;
    EventNote& result = add(event.step, picked_up ? "picked_up" : "dropped_off", describe(event));
    (picked_up ? result.after : result.before) = {event.droplet};
    result.microparticle = event.microparticle;
  }
  for (const chip::BoardEvent& event : experiment_->take_board_events()) {
    add(event.step, event.kind == chip::BoardEvent::Kind::halted ? "halted" : "fault_injected",
        event.message);
  }
  // At the same step droplets come first: they carry.
  std::stable_sort(notes.begin(), notes.end(),
                   [](const EventNote& a, const EventNote& b) { return a.step < b.step; });
  for (EventNote& result : notes) outbox_.put(std::move(result));
}

void EngineThread::note(const std::string& kind, const std::string& message) {
  note(kind, message, experiment_->steps());
}

void EngineThread::note(const std::string& kind, const std::string& message, std::uint64_t step) {
  EventNote result;
  result.step = step;
  result.time = time_of(result.step);
  result.stamp = clock_.nanoseconds(result.time);
  result.run = run_;
  result.kind = kind;
  result.message = message;
  outbox_.put(std::move(result));
}

double EngineThread::time_of(std::uint64_t step) const {
  return static_cast<double>(step) * experiment_->simulation().parameters().time_step;
}

std::uint64_t EngineThread::seed() const { return experiment_->simulation().parameters().seed; }

}  // namespace dmf::node
