#pragma once
#include "controller/operation.h"

namespace dmf::controller {

/// Takes a droplet along its way, a step a time: the next electrode is switched on, the last one off, and the
/// step is done when the next one's capacitance has reached a fraction of the droplet's at the start. A step
/// that is not done in time is tried again, after the droplet was pulled back onto its electrode. When that
/// does not help either, a way round the electrode is looked for.
class Walk {
 public:
  enum class Result { under_way, arrived, failed };

  /// @param droplet  as it is sensed when it sets off.
  Walk(Traffic::Key key, const Limits& limits, const Droplet& droplet, const Journey& journey, View& view);

  Result update(View& view);

  const Channels& on() const { return on_; }
  /// The electrode it is on and the one it steps to.
  Channels cells() const { return {cell_, goal_}; }
  Channel last_cell() const { return last_cell_; }  ///< that it was on before
  /// Of both the one that is wetted more.
  Channel hold(const Wetting& wetting) const;
  bool is_blocked() const { return is_blocked_; }
  const std::string& text() const { return text_; }
  std::size_t steps_done() const { return steps_done_; }
  std::size_t steps_left(const View& view) const;

 private:
  bool is_lost(const View& view);
  Result step(View& view);
  /// The electrode that it came from is wetted more than the one it is to be on.
  bool has_gone_back(const View& view) const;
  Result give_up_step(View& view);

  Traffic::Key key_;
  Limits limits_;
  bool as_given_;
  double last_seen_;    ///< s
  double wetted_area_;  ///< m^2, of the droplet where it stood
  Channel cell_, goal_, last_cell_;
  bool stepping_ = false;
  bool pulling_back_ = false;
  double step_start_ = 0, try_start_ = 0;  ///< s
  double reached_ = -1;                    ///< s, when the next electrode was wetted enough; below 0: not yet
  unsigned tries_ = 0;
  Obstruction obstruction_;
  bool is_blocked_ = false;
  std::size_t steps_done_ = 0;
  Channels on_;
  std::string text_;
  std::string no_answer_;  ///< of the electrode that it last had to go round
};

}  // namespace dmf::controller
