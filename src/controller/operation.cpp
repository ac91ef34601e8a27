#include "controller/operation.h"

#include <fmt/format.h>

#include <algorithm>

namespace dmf::controller {

namespace {

/// A footprint that just reaches all four sides of a square pad covers so much of it: who covers less does
/// not reach over to the next.
constexpr double kInscribedCircle = 0.785;

/// A wetted fraction that is told from none: three times the noise, and 1 %.
double visible_fraction(const Layout& layout, Channel channel) {
  const Sensing& sensing = layout.sensing();
  return 0.01 + 3 * sensing.noise /
                    ((sensing.liquid_capacitance - sensing.filler_capacitance) * layout.area(channel));
}

std::string why_no_voltage(const View& view) {
  if (view.rail_is_off) return "the high-voltage rail is off";
  if (view.layout.threshold_voltage() > 0 && view.rail.voltage <= view.layout.threshold_voltage()) {
    return fmt::format("below threshold voltage: the rail has {:g} V, nothing moves up to {:g} V",
                       view.rail.voltage, view.layout.threshold_voltage());
  }
  return "";
}

}  // namespace

void StepTimes::add(double seconds) {
  constexpr unsigned kMemory = 20;  // steps; the guess counts as the first
  count_ = std::min(count_ + 1, kMemory);
  mean_ += (seconds - mean_) / (count_ + 1);
}

bool Obstruction::is_final(const std::string& found, const View& view, double step_timeout) {
  constexpr double kPatience = 0.5;  // of a step: what draws back is in sight after that
  if (found.empty() || !view.alone) {
    since_ = -1;
    return false;
  }
  if (since_ < 0) since_ = view.time;
  return view.time - since_ >= kPatience * step_timeout;
}

void Operation::update(View& view) {
  if (!is_running()) return;
  if (view.rail_is_off) {
    fail("the high-voltage rail is off");
  } else if (limits_.timeout > 0 && view.time - start_ > limits_.timeout) {
    fail(fmt::format("timeout: not done after {:g} s ({})", limits_.timeout, status_.text));
  } else {
    advance(view);
  }
  if (!is_running()) end(view);
}

void Operation::cancel(View& view) {
  if (!is_running()) return;
  status_.state = State::cancelled;
  status_.text = "cancelled";
  end(view);
}

void Operation::end(View& view) {
  on_ = hold(view.wetting);
  status_.time_left = 0;
  view.traffic.leave(key_);
}

void Operation::succeed(const std::string& text) { status_ = {State::succeeded, 1, 0, text}; }

void Operation::fail(const std::string& reason) {
  status_.state = State::failed;
  status_.text = reason;
}

NoAnswer why_no_answer(const View& view, Channel from, Channel to, double covered) {
  if (const std::string no_voltage = why_no_voltage(view); !no_voltage.empty()) return {no_voltage};
  if (view.disabled.count(to)) return {fmt::format("electrode {} is disabled", to), true};
  if (view.wetting.at(to) < visible_fraction(view.layout, to) && covered < kInscribedCircle) {
    return {fmt::format(
        "no overlap with neighbour: {:.0f} % of electrode {} was wetted at most and nothing of {}",
        100 * covered, from, to)};
  }
  return {fmt::format("electrode {} does not answer: stuck or too weak", to), true};
}

std::string why_no_room(const View& view, const Channels& cells, const Channels& own) {
  Channels near;
  for (const Channel cell : cells) near.insert(view.layout.near(cell).begin(), view.layout.near(cell).end());
  for (const Droplet& droplet : view.droplets.droplets()) {
    const bool is_own = std::any_of(droplet.channels.begin(), droplet.channels.end(),
                                    [&](Channel channel) { return own.count(channel) > 0; });
    const bool is_near = std::any_of(droplet.channels.begin(), droplet.channels.end(),
                                     [&](Channel channel) { return near.count(channel) > 0; });
    if (is_near && !is_own) return fmt::format("blocked by droplet {}", droplet.id);
  }
  return "";
}

}  // namespace dmf::controller
