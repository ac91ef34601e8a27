#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controller/neck.h"
#include "controller/operations.h"
#include "yaml/invalid_input.h"

namespace dmf::controller {

namespace {

/// How much more of one side than of the other the droplet may wet when it is stretched: what lies there ends
/// up there.
constexpr double kOffCentre = 0.1;
/// How long it may take to lie in the middle, of what a step may take.
constexpr double kCentring = 0.5;

/// Waits until the droplet lies in the middle, stretches it over three electrodes, then switches the middle
/// one off, so that both ends pull the neck apart (Cho, Moon and Kim 2003, J. Microelectromech. Syst. 12,
/// 70). What does not break is stretched again.
class SplitOperation : public Operation {
 public:
  SplitOperation(const Split& goal, Traffic::Key key, View& view)
      : Operation(key, goal.limits, view.time), middle_(goal.channel), a_(goal.onto[0]), b_(goal.onto[1]) {
    on_ = {middle_};
  }

  Channels claims() const override { return {a_, middle_, b_}; }
  bool is_blocked() const override { return is_blocked_; }
  Channels hold(const Wetting&) const override { return apart_ ? Channels{a_, b_} : Channels{middle_}; }

 protected:
  void advance(View& view) override {
    switch (phase_) {
      case Phase::wait_for_room:
        return wait_for_room(view);
      case Phase::centre:
        return centre(view);
      case Phase::stretch:
        return stretch(view);
      case Phase::pinch:
        return pinch(view);
    }
  }

 private:
  enum class Phase { wait_for_room, centre, stretch, pinch };

  void enter(Phase phase, const View& view, double progress, const std::string& text) {
    phase_ = phase;
    phase_start_ = view.time;
    status_.progress = progress;
    status_.time_left = (phase == Phase::pinch ? 1 : 2) * view.step_times.mean();
    status_.text = text;
  }

  void wait_for_room(View& view) {
    std::string blocked = why_no_room(view, claims(), {middle_});
    for (const Channel side : {a_, b_})
      if (view.dead.count(side)) return fail(fmt::format("electrode {} does not answer", side));
    is_blocked_ = !blocked.empty();
    status_.text = blocked;
    if (obstruction_.is_final(blocked, view, limits_.step_timeout)) return fail(blocked);
    if (is_blocked_) return;
    enter(Phase::centre, view, 0, fmt::format("is centred on electrode {}", middle_));
    off_centre_ = view.time;
    centre(view);
  }

  /// The middle alone draws the droplet in slowly: the side that has less helps.
  void centre(View& view) {
    const double lead = view.wetting.at(a_) - view.wetting.at(b_);
    const bool is_off_centre = std::abs(lead) > kOffCentre;
    if (is_off_centre) off_centre_ = view.time;
    on_ = {middle_};
    if (is_off_centre) on_.insert(lead > 0 ? b_ : a_);
    const bool is_centred = view.time - off_centre_ >= kQuiet * limits_.step_timeout;
    if (!is_centred && view.time - phase_start_ < kCentring * limits_.step_timeout) return;
    enter(Phase::stretch, view, 0.1, fmt::format("stretches over electrodes {}, {} and {}", a_, middle_, b_));
    on_ = claims();
  }

  void stretch(View& view) {
    on_ = claims();
    const double threshold = view.droplets.threshold();
    const bool both = view.wetting.at(a_) >= threshold && view.wetting.at(b_) >= threshold;
    if (!both && view.time - phase_start_ < limits_.step_timeout) return;
    unreached_.clear();
    for (const Channel side : {a_, b_}) {
      if (view.wetting.at(side) < threshold) {
        unreached_ = fmt::format("did not reach electrode {}: {}", side,
                                 why_no_answer(view, middle_, side, view.wetting.at(middle_)).reason);
      }
    }
    // A droplet too small to lie on all three may still be torn by the outer two.
    enter(Phase::pinch, view, 0.5, fmt::format("is pulled apart onto electrodes {} and {}", a_, b_));
    neck_ = Neck();
    on_ = {a_, b_};
  }

  void pinch(View& view) {
    on_ = {a_, b_};
    const Droplet* on_a = view.droplets.on(a_);
    const Droplet* on_b = view.droplets.on(b_);
    const bool broken = neck_.has_broken(view.wetting.at(middle_), view.time, kQuiet * limits_.step_timeout);
    if (on_a && on_b && on_a->id != on_b->id && broken) {
      apart_ = true;
      return succeed(fmt::format("split onto electrodes {} and {}, which cover {:.2f} and {:.2f} electrodes",
                                 a_, b_, on_a->covered, on_b->covered));
    }
    if (view.time - phase_start_ < limits_.step_timeout) return;
    if (++tries_ <= limits_.retries) {
      return enter(Phase::stretch, view, 0.1, fmt::format("stretches again, try {}", tries_ + 1));
    }
    fail(why_not(view));
  }

  std::string why_not(const View& view) const {
    for (const Channel side : {a_, b_}) {
      if (view.droplets.on(side)) continue;
      return unreached_.empty() ? fmt::format("the liquid went away from electrode {}", side) : unreached_;
    }
    return fmt::format("the neck over electrode {} does not break: {:.0f} % of it is wetted", middle_,
                       100 * view.wetting.at(middle_));
  }

  Channel middle_, a_, b_;
  Phase phase_ = Phase::wait_for_room;
  double phase_start_ = 0;  ///< s
  double off_centre_ = 0;   ///< s, when it was last seen to be
  Neck neck_;
  unsigned tries_ = 0;
  std::string unreached_;  ///< why one of both was dry after the last stretching
  Obstruction obstruction_;
  bool is_blocked_ = false;
  bool apart_ = false;
};

/// The first two neighbours on opposite sides that answer and have room.
std::vector<Channel> free_sides(const View& view, Channel middle) {
  std::vector<Channel> any;
  const Channels& neighbours = view.layout.neighbours(middle);
  for (auto a = neighbours.begin(); a != neighbours.end(); ++a) {
    for (auto b = std::next(a); b != neighbours.end(); ++b) {
      if (view.dead.count(*a) || view.dead.count(*b)) continue;
      if (!view.layout.are_opposite(middle, *a, *b)) continue;
      if (why_no_room(view, {*a, *b}, {middle}).empty()) return {*a, *b};
      if (any.empty()) any = {*a, *b};
    }
  }
  return any;
}

}  // namespace

std::unique_ptr<Operation> make_split(const Split& goal, Traffic::Key key, View& view) {
  Split with_sides = goal;
  if (with_sides.onto.empty()) with_sides.onto = free_sides(view, goal.channel);
  if (with_sides.onto.empty()) {
    throw InvalidInput(fmt::format(
        "channel: {}, allowed: one with two neighbours on opposite sides that answer", goal.channel));
  }
  return std::make_unique<SplitOperation>(with_sides, key, view);
}

}  // namespace dmf::controller
