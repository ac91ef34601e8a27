#include <fmt/format.h>

#include "controller/operations.h"
#include "controller/walk.h"
#include "yaml/invalid_input.h"

namespace dmf::controller {

namespace {

/// What may be left on the electrode that the droplet came from, of a whole one, when both are one.
/// Capacitance alone can't tell two droplets side by side from one; but only a droplet that has flowed into
/// the other has left an electrode that is off.
constexpr double kDrained = 0.5;

/// Walks the one droplet onto the electrode of the other, which is held until they are one.
class MergeOperation : public Operation {
 public:
  MergeOperation(const Merge& goal, Traffic::Key key, const Droplet& droplet, const Droplet& other,
                 View& view)
      : Operation(key, goal.limits, view.time),
        into_(goal.into),
        walk_(key, goal.limits, droplet, {goal.channel, {goal.into}, false, 0, {other.id}, 0}, view) {
    on_ = walk_.on();
    on_.insert(into_);
  }

  Channels claims() const override {
    Channels cells = walk_.cells();
    cells.insert(into_);
    return cells;
  }
  Channels walks_on() const override { return walk_.cells(); }
  bool is_blocked() const override { return walk_.is_blocked(); }
  Channels hold(const Wetting& wetting) const override {
    const Channel walker = walk_.hold(wetting);
    return touching_ ? Channels{into_} : Channels{walker, into_};
  }

 protected:
  void advance(View& view) override {
    if (touching_) return wait_for_one(view);
    const Walk::Result result = walk_.update(view);
    on_ = walk_.on();
    on_.insert(into_);
    status_.text = walk_.text();
    if (result == Walk::Result::failed) return fail(walk_.text());
    // The electrode of the other droplet is wetted already: the walk takes its last step for done at once.
    if (result == Walk::Result::arrived) {
      touching_ = true;
      touched_ = view.time;
      from_ = walk_.last_cell();
      return wait_for_one(view);
    }
    const auto done = static_cast<double>(walk_.steps_done());
    const auto left = static_cast<double>(walk_.steps_left(view)) + 1;
    status_.progress = done / (done + left);
    status_.time_left = left * view.step_times.mean();
  }

 private:
  void wait_for_one(View& view) {
    on_ = {into_};
    status_.text = fmt::format("flow together on electrode {}", into_);
    status_.time_left = view.step_times.mean();
    if (view.wetting.at(from_) < kDrained && view.droplets.on(into_))
      return succeed(fmt::format("merged on electrode {}", into_));
    if (view.time - touched_ > limits_.step_timeout * (1 + limits_.retries)) {
      fail(fmt::format("did not merge: {:.0f} % of electrode {} is still wetted ({})",
                       100 * view.wetting.at(from_), from_, why_no_answer(view, from_, into_, 1).reason));
    }
  }

  Channel into_;
  Walk walk_;
  bool touching_ = false;
  double touched_ = 0;  ///< s
  Channel from_ = 0;
};

}  // namespace

std::unique_ptr<Operation> make_merge(const Merge& goal, Traffic::Key key, View& view) {
  const Droplet* droplet = view.droplets.on(goal.channel);
  const Droplet* other = view.droplets.on(goal.into);
  if (!other) {
    throw InvalidInput(
        fmt::format("into: {}, allowed: an electrode with a droplet, {:.0f} % of this one is wetted",
                    goal.into, 100 * view.wetting.at(goal.into)));
  }
  if (other->id == droplet->id)
    throw InvalidInput(
        fmt::format("into: {}, allowed: an electrode of another droplet than {}", goal.into, droplet->id));
  return std::make_unique<MergeOperation>(goal, key, *droplet, *other, view);
}

}  // namespace dmf::controller
