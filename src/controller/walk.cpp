#include "controller/walk.h"

#include <fmt/format.h>

#include <algorithm>

namespace dmf::controller {

namespace {

/// For how long a droplet is pulled back before the next try, of what a try may take.
constexpr double kPullBack = 0.3;

/// The least number of electrodes that a droplet covers when it reaches out to those around its own: two
/// droplets of one electrode each.
constexpr double kLargeDroplet = 1.8;

}  // namespace

Walk::Walk(Traffic::Key key, const Limits& limits, const Droplet& droplet, const Journey& journey, View& view)
    : key_(key),
      limits_(limits),
      as_given_(journey.as_given),
      wetted_area_(0),
      cell_(journey.from),
      goal_(journey.from),
      last_cell_(journey.from) {
  for (const Channel channel : droplet.channels)
    wetted_area_ += view.wetting.at(channel) * view.layout.area(channel);
  Journey own = journey;
  own.reach = droplet.covered >= kLargeDroplet ? 1 : 0;
  view.traffic.enter(key, droplet.id, own);
  on_ = {cell_};
}

Channel Walk::hold(const Wetting& wetting) const {
  return wetting.at(goal_) >= wetting.at(cell_) ? goal_ : cell_;
}

std::size_t Walk::steps_left(const View& view) const { return view.traffic.steps_left(key_) + stepping_; }

Walk::Result Walk::update(View& view) {
  goal_ = view.traffic.cell(key_);
  if (goal_ != cell_) return step(view);
  on_ = {cell_};
  if (!view.droplets.on(cell_)) {
    text_ = fmt::format("the droplet is lost: no liquid is sensed on electrode {}", cell_);
    return Result::failed;
  }
  if (view.traffic.is_at_destination(key_)) return Result::arrived;
  const std::string& blocked = view.traffic.blocked(key_);
  is_blocked_ = !blocked.empty();
  text_ = is_blocked_ ? blocked : fmt::format("waits on electrode {}", cell_);
  if (is_blocked_ && !no_answer_.empty()) text_ = no_answer_ + ", and there is no other way: " + blocked;
  return is_blocked_ && view.alone ? Result::failed : Result::under_way;
}

Walk::Result Walk::step(View& view) {
  is_blocked_ = false;
  if (!stepping_) {
    stepping_ = true;
    pulling_back_ = false;
    step_start_ = try_start_ = view.time;
    tries_ = 1;
  }
  text_ = fmt::format("from electrode {} to {}{}", cell_, goal_,
                      tries_ > 1 ? fmt::format(", try {}", tries_) : std::string());
  const double needed = limits_.success_threshold * std::min(wetted_area_, view.layout.area(goal_));
  if (view.wetting.at(goal_) * view.layout.area(goal_) >= needed) {
    view.step_times.add(view.time - step_start_);
    view.traffic.set_arrived(key_);
    last_cell_ = cell_;
    cell_ = goal_;
    stepping_ = false;
    ++steps_done_;
    on_ = {cell_};
    return Result::under_way;
  }
  if (!view.droplets.on(cell_) && !view.droplets.on(goal_)) {
    text_ = fmt::format("the droplet is lost: no liquid is sensed on electrodes {} and {}", cell_, goal_);
    return Result::failed;
  }
  const double tried_for = view.time - try_start_;
  if (pulling_back_) {
    if (tried_for >= kPullBack * limits_.step_timeout) {
      pulling_back_ = false;
      try_start_ = view.time;
      ++tries_;
    }
  } else if (view.disabled.count(goal_)) {
    return give_up_step(view);
  } else if (tried_for >= limits_.step_timeout) {
    if (tries_ > limits_.retries) return give_up_step(view);
    pulling_back_ = true;
    try_start_ = view.time;
  }
  on_ = {pulling_back_ ? cell_ : goal_};
  return Result::under_way;
}

Walk::Result Walk::give_up_step(View& view) {
  const NoAnswer no_answer = why_no_answer(view, cell_, goal_);
  text_ = no_answer_ = no_answer.reason;
  if (no_answer.is_electrode) view.dead.insert(goal_);
  if (!no_answer.is_electrode || as_given_) return Result::failed;
  view.traffic.turn_back(key_, cell_);
  goal_ = cell_;
  stepping_ = false;
  on_ = {cell_};
  return Result::under_way;
}

}  // namespace dmf::controller
