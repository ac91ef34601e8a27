#include "controller/walk.h"

#include <fmt/format.h>

#include <algorithm>

namespace dmf::controller {

namespace {

/// For how long a droplet is pulled back before the next try, of what a try may take.
constexpr double kPullBack = 0.3;

/// A droplet that has shrunk from its electrodes, or stands between them, still leaves so much of the
/// threshold.
constexpr double kTrace = 0.5;
/// For how long nothing may be sensed of a droplet before it counts as lost, of what a try may take.
constexpr double kLostAfter = 0.3;

/// How long the last electrode may stay wetted after the next one is, of what a try may take. A droplet that
/// is let go while it lies on both is out of reach of the one after; a large one never leaves the last
/// wholly.
constexpr double kTrailing = 0.2;

/// The least number of electrodes that a droplet covers when it reaches out to those around its own: two
/// droplets of one electrode each.
constexpr double kLargeDroplet = 1.8;

}  // namespace

Walk::Walk(Traffic::Key key, const Limits& limits, const Droplet& droplet, const Journey& journey, View& view)
    : key_(key),
      limits_(limits),
      as_given_(journey.as_given),
      last_seen_(view.time),
      wetted_area_(0),
      cell_(journey.from),
      goal_(journey.from),
      last_cell_(journey.from) {
  for (const Channel channel : droplet.channels)
    wetted_area_ += view.wetting.at(channel) * view.layout.area(channel);
  Journey own = journey;
  own.reach = droplet.covered >= kLargeDroplet ? 1 : 0;
  own.may_touch.insert(droplet.id);  // when it merges, the whole may go on under its id
  view.traffic.enter(key, droplet.id, own);
  on_ = {cell_};
}

Channel Walk::hold(const Wetting& wetting) const {
  return wetting.at(goal_) >= wetting.at(cell_) ? goal_ : cell_;
}

std::size_t Walk::steps_left(const View& view) const { return view.traffic.steps_left(key_) + stepping_; }

Walk::Result Walk::update(View& view) {
  goal_ = view.traffic.cell(key_);
  // A droplet that has just been placed, or pulled onto its electrode, wets more of it by and by.
  wetted_area_ = std::max(wetted_area_, view.wetting.at(cell_) * view.layout.area(cell_));
  if (is_lost(view)) {
    text_ = fmt::format("the droplet is lost: no liquid is sensed on and around electrode {}", cell_);
    return Result::failed;
  }
  if (goal_ != cell_) return step(view);
  on_ = {cell_};
  if (view.traffic.is_at_destination(key_)) return Result::arrived;
  const std::string& blocked = view.traffic.blocked(key_);
  is_blocked_ = !blocked.empty();
  text_ = is_blocked_ ? blocked : fmt::format("waits on electrode {}", cell_);
  if (is_blocked_ && !no_answer_.empty()) text_ = no_answer_ + ", and there is no other way: " + blocked;
  return obstruction_.is_final(blocked, view, limits_.step_timeout) ? Result::failed : Result::under_way;
}

bool Walk::is_lost(const View& view) {
  const double threshold = kTrace * view.droplets.threshold();
  const auto is_wetted = [&](Channel channel) { return view.wetting.at(channel) >= threshold; };
  const Channels& around = view.layout.near(cell_);
  if (is_wetted(goal_) || std::any_of(around.begin(), around.end(), is_wetted)) last_seen_ = view.time;
  return view.time - last_seen_ >= kLostAfter * limits_.step_timeout;
}

Walk::Result Walk::step(View& view) {
  is_blocked_ = false;
  if (!stepping_) {
    stepping_ = true;
    pulling_back_ = false;
    step_start_ = try_start_ = view.time;
    tries_ = 1;
    reached_ = -1;
  }
  text_ = fmt::format("from electrode {} to {}{}", cell_, goal_,
                      tries_ > 1 ? fmt::format(", try {}", tries_) : std::string());
  const double needed = limits_.success_threshold * std::min(wetted_area_, view.layout.area(goal_));
  if (view.wetting.at(goal_) * view.layout.area(goal_) >= needed) {
    if (reached_ < 0) reached_ = view.time;
    const bool has_left = view.wetting.at(cell_) < view.droplets.threshold();
    if (has_left || view.time - reached_ >= kTrailing * limits_.step_timeout) {
      view.step_times.add(view.time - step_start_);
      view.traffic.set_arrived(key_);
      last_cell_ = cell_;
      cell_ = goal_;
      stepping_ = false;
      ++steps_done_;
    }
    on_ = {goal_};
    return Result::under_way;
  }
  const double tried_for = view.time - try_start_;
  if (pulling_back_) {
    if (tried_for >= kPullBack * limits_.step_timeout) {
      if (tries_ > limits_.retries) return give_up_step(view);
      pulling_back_ = false;
      try_start_ = view.time;
      ++tries_;
    }
  } else if (view.disabled.count(goal_)) {
    return give_up_step(view);
  } else if (tried_for >= limits_.step_timeout) {
    // A droplet that nothing holds may drift back by itself. Whether it is held there, pulling it back tells.
    if (tries_ > limits_.retries && !has_gone_back(view)) return give_up_step(view);
    pulling_back_ = true;
    try_start_ = view.time;
  }
  on_ = {pulling_back_ ? cell_ : goal_};
  return Result::under_way;
}

bool Walk::has_gone_back(const View& view) const {
  return last_cell_ != cell_ && view.wetting.at(last_cell_) >= view.wetting.at(cell_);
}

Walk::Result Walk::give_up_step(View& view) {
  // Liquid that stays on an electrode which is off is held there: the next one is not at fault.
  const NoAnswer no_answer =
      has_gone_back(view)
          ? NoAnswer{fmt::format("electrode {} does not let go of the droplet: stuck on", last_cell_)}
          : why_no_answer(view, cell_, goal_, std::min(1.0, wetted_area_ / view.layout.area(cell_)));
  text_ = no_answer_ = no_answer.reason;
  if (no_answer.is_electrode) view.dead.insert(goal_);
  if (!no_answer.is_electrode || as_given_) return Result::failed;
  // A weak electrode may have taken it over and not be wetted enough for that.
  cell_ = goal_ = hold(view.wetting);
  view.traffic.turn_back(key_, cell_);
  stepping_ = false;
  on_ = {cell_};
  return Result::under_way;
}

}  // namespace dmf::controller
