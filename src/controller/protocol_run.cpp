#include "controller/protocol_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "yaml/invalid_input.h"

namespace dmf::controller {

namespace {

/// For how long a rail may take to show what it was told, s.
constexpr double kRailPatience = 2;

/// What an operation is taken to last before anything is known of it: as many steps as it has at least.
double guessed_duration(const Step& step) {
  if (const auto* activate = std::get_if<Activate>(&step.work)) return activate->duration;
  if (const auto* wait = std::get_if<Wait>(&step.work)) return wait->duration;
  return Limits{}.step_timeout;
}

}  // namespace

ProtocolRun::ProtocolRun(Protocol protocol, Coordinator& coordinator)
    : protocol_(std::move(protocol)), coordinator_(coordinator) {}

void ProtocolRun::update() {
  if (!is_running()) return;
  const Step& step = protocol_.steps[step_];
  if (!has_begun_) {
    if (!rail_is_set()) return;
    begin();
    if (!is_running()) return;
  }
  if (coordinator_.rail_is_off()) return fail("the high-voltage rail is off");
  const bool done = std::visit([&](const auto& work) { return is_done(work); }, step.work);
  if (!is_running()) return;
  if (done) {
    for (const auto key : keys_) coordinator_.forget(key);
    keys_.clear();
    has_begun_ = false;
    step_progress_ = 0;
    if (++step_ == protocol_.steps.size()) {
      coordinator_.set_manual({});
      status_ = {State::succeeded, 1, 0, fmt::format("{} steps done", protocol_.steps.size())};
      return;
    }
  }
  estimate();
}

bool ProtocolRun::rail_is_set() {
  const Step& step = protocol_.steps[step_];
  const Rail& rail = coordinator_.rail();
  const Rail wanted{step.voltage.value_or(rail.voltage), step.frequency.value_or(rail.frequency), true};
  const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-6 * std::max(1.0, std::abs(b)); };
  const bool asks = step.voltage || step.frequency || (step_ == 0 && !rail.enabled);
  if (!asks ||
      (rail.enabled && same(rail.voltage, wanted.voltage) && same(rail.frequency, wanted.frequency))) {
    wanted_rail_.reset();
    rail_asked_ = -1;
    return true;
  }
  if (rail_asked_ < 0) rail_asked_ = coordinator_.time();
  wanted_rail_ = wanted;
  status_.text = fmt::format("sets the rail to {:g} V, {:g} Hz", wanted.voltage, wanted.frequency);
  if (coordinator_.time() - rail_asked_ > kRailPatience)
    fail(fmt::format("the rail does not take {:g} V, {:g} Hz", wanted.voltage, wanted.frequency));
  return false;
}

void ProtocolRun::begin() {
  has_begun_ = true;
  step_start_ = coordinator_.time();
  try {
    std::visit([&](const auto& work) { begin_work(work); }, protocol_.steps[step_].work);
  } catch (const InvalidInput& refused) {
    fail(refused.what());
  }
}

void ProtocolRun::begin_work(const Activate& work) { coordinator_.set_manual(work.channels); }

void ProtocolRun::begin_work(const Wait&) { coordinator_.set_manual({}); }

void ProtocolRun::begin_work(const Parallel& work) {
  coordinator_.set_manual({});
  for (const Goal& goal : work.goals) keys_.push_back(coordinator_.start(goal));
}

bool ProtocolRun::is_done(const Activate& work) {
  const double elapsed = coordinator_.time() - step_start_;
  step_progress_ = std::min(1.0, elapsed / work.duration);
  step_time_left_ = std::max(0.0, work.duration - elapsed);
  status_.text = fmt::format("electrodes {} on", channels_text(work.channels));
  if (!work.volume_threshold) return elapsed >= work.duration;
  for (const Channel channel : work.channels) {
    const double wetted = coordinator_.wetting().at(channel);
    if (wetted >= *work.volume_threshold) continue;
    if (elapsed >= work.duration) {
      fail(fmt::format("below threshold: {:.0f} % of electrode {} is wetted after {:g} s, wanted: {:.0f} %",
                       100 * wetted, channel, work.duration, 100 * *work.volume_threshold));
    }
    return false;
  }
  return true;
}

bool ProtocolRun::is_done(const Wait& work) {
  const double elapsed = coordinator_.time() - step_start_;
  step_progress_ = std::min(1.0, elapsed / work.duration);
  step_time_left_ = std::max(0.0, work.duration - elapsed);
  status_.text = "waits";
  return elapsed >= work.duration;
}

bool ProtocolRun::is_done(const Parallel& work) {
  bool done = true;
  step_progress_ = 1;
  step_time_left_ = 0;
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const Status status = coordinator_.report(keys_[k]).status;
    if (status.state == State::failed || status.state == State::cancelled) {
      fail(fmt::format("{} from channel {}: {}", name_of(work.goals[k]), channel_of(work.goals[k]),
                       status.text));
      return false;
    }
    if (status.state == State::running) {
      done = false;
      status_.text = status.text;
    }
    step_progress_ = std::min(step_progress_, status.progress);
    step_time_left_ = std::max(step_time_left_, status.time_left);
  }
  return done;
}

void ProtocolRun::estimate() {
  const double count = static_cast<double>(protocol_.steps.size());
  status_.progress = (static_cast<double>(step_) + step_progress_) / count;
  status_.time_left = step_time_left_;
  for (std::size_t later = step_ + 1; later < protocol_.steps.size(); ++later)
    status_.time_left += guessed_duration(protocol_.steps[later]);
}

void ProtocolRun::stop_work() {
  for (const auto key : keys_) {
    coordinator_.cancel(key);
    coordinator_.forget(key);
  }
  keys_.clear();
  wanted_rail_.reset();
  coordinator_.set_manual({});
}

void ProtocolRun::fail(const std::string& reason) {
  stop_work();
  status_.state = State::failed;
  status_.time_left = 0;
  status_.text = fmt::format("step {} ({}): {}", step_ + 1, protocol_.steps[step_].name, reason);
}

void ProtocolRun::cancel() {
  if (!is_running()) return;
  stop_work();
  status_.state = State::cancelled;
  status_.time_left = 0;
  status_.text = fmt::format("cancelled in step {} ({})", step_ + 1, protocol_.steps[step_].name);
}

}  // namespace dmf::controller
