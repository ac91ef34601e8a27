#include <fmt/format.h>

#include <algorithm>

#include "controller/neck.h"
#include "controller/operations.h"

namespace dmf::controller {

namespace {

/// From this fraction on an electrode has got hold of the liquid beside it.
constexpr double kTouch = 0.15;

/// Pulls a finger of liquid out of the reservoir, an electrode at a time, then switches its neck off while
/// the reservoir pulls back (Cho, Moon and Kim 2003; Ren, Fair and Pollack 2004, Sens. Actuators B 98, 319).
class DispenseOperation : public Operation {
 public:
  DispenseOperation(const Dispense& goal, Traffic::Key key, const View& view)
      : Operation(key, goal.limits, view.time), goal_(goal) {
    on_ = {goal_.reservoir};
  }

  Channels claims() const override {
    Channels cells(goal_.path.begin(), goal_.path.end());
    cells.insert(goal_.reservoir);
    return cells;
  }
  bool is_blocked() const override { return is_blocked_; }
  Channels hold(const Wetting&) const override {
    return apart_ ? Channels{goal_.reservoir, goal_.path.back()} : Channels{goal_.reservoir};
  }

 protected:
  void advance(View& view) override {
    if (waiting_) return wait_for_room(view);
    if (out_ < goal_.path.size()) return pull_out(view);
    return pinch(view);
  }

 private:
  Channels reservoir_cells(const View& view) const {
    const Droplet* reservoir = view.droplets.on(goal_.reservoir);
    Channels cells = reservoir ? reservoir->channels : Channels{};
    cells.insert(goal_.reservoir);
    return cells;
  }

  void wait_for_room(View& view) {
    for (const Channel channel : goal_.path)
      if (view.dead.count(channel)) return fail(fmt::format("electrode {} does not answer", channel));
    const std::string blocked =
        why_no_room(view, {goal_.path.begin(), goal_.path.end()}, reservoir_cells(view));
    is_blocked_ = !blocked.empty();
    status_.text = blocked;
    if (obstruction_.is_final(blocked, view, limits_.step_timeout)) return fail(blocked);
    if (is_blocked_) return;
    waiting_ = false;
    begin_try(view);
  }

  void begin_try(const View& view) {
    out_ = 0;
    neck_ = Neck();
    start_phase(view);
  }

  void start_phase(const View& view) {
    phase_start_ = view.time;
    const auto left = static_cast<double>(goal_.path.size() + 1 - out_);
    status_.progress = 1 - left / static_cast<double>(goal_.path.size() + 1);
    status_.time_left = left * view.step_times.mean();
  }

  /// The finger as far as it is out, and the electrode that it goes to; the reservoir itself lets go, once
  /// its liquid has got hold of the first: what is left in it may not reach over while it is off.
  void pull_out(View& view) {
    const Channel next = goal_.path[out_];
    on_ = {goal_.path.begin(), goal_.path.begin() + static_cast<std::ptrdiff_t>(out_) + 1};
    if (view.wetting.at(goal_.path.front()) < kTouch) on_.insert(goal_.reservoir);
    status_.text = fmt::format("pulls liquid onto electrode {}", next);
    const bool reached = view.wetting.at(next) >= limits_.success_threshold;
    if (reached) {
      view.step_times.add(view.time - phase_start_);
      ++out_;
      return start_phase(view);
    }
    if (view.disabled.count(next) ||
        view.time - phase_start_ >= limits_.step_timeout * (1 + limits_.retries)) {
      const Channel from = out_ ? goal_.path[out_ - 1] : goal_.reservoir;
      fail(fmt::format("the liquid does not reach electrode {}: {}", next,
                       why_no_answer(view, from, next, view.wetting.at(from)).reason));
    }
  }

  void pinch(View& view) {
    on_ = {goal_.reservoir, goal_.path.back()};
    status_.text = fmt::format("breaks the neck before electrode {}", goal_.path.back());
    const Droplet* droplet = view.droplets.on(goal_.path.back());
    const Droplet* reservoir = view.droplets.on(goal_.reservoir);
    const auto neck = std::min_element(goal_.path.begin(), goal_.path.end() - 1, [&](Channel a, Channel b) {
      return view.wetting.at(a) < view.wetting.at(b);
    });
    const bool broken = neck_.has_broken(view.wetting.at(*neck), view.time, kQuiet * limits_.step_timeout);
    if (droplet && reservoir && droplet->id != reservoir->id && broken) {
      apart_ = true;
      return judge(*droplet);
    }
    if (view.time - phase_start_ < limits_.step_timeout) return;
    if (++tries_ <= limits_.retries) return begin_try(view);
    if (!droplet) return fail(fmt::format("the liquid went back from electrode {}", goal_.path.back()));
    fail("the neck does not break");
  }

  void judge(const Droplet& droplet) {
    const bool enough = droplet.covered >= goal_.least;
    const bool few = goal_.most == 0 || droplet.covered <= goal_.most;
    if (enough && few) {
      return succeed(fmt::format("dispensed a droplet onto electrode {}, it covers {:.2f} electrodes",
                                 goal_.path.back(), droplet.covered));
    }
    fail(fmt::format("volume: the droplet on electrode {} covers {:.2f} electrodes, wanted: {:g} to {}",
                     goal_.path.back(), droplet.covered, goal_.least,
                     goal_.most == 0 ? std::string("any") : fmt::format("{:g}", goal_.most)));
  }

  Dispense goal_;
  bool waiting_ = true;
  std::size_t out_ = 0;     ///< electrodes of the path that the finger has reached
  double phase_start_ = 0;  ///< s
  Neck neck_;
  unsigned tries_ = 0;
  Obstruction obstruction_;
  bool is_blocked_ = false;
  bool apart_ = false;
};

}  // namespace

std::unique_ptr<Operation> make_dispense(const Dispense& goal, Traffic::Key key, View& view) {
  return std::make_unique<DispenseOperation>(goal, key, view);
}

}  // namespace dmf::controller
