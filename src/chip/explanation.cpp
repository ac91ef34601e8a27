#include "chip/explanation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "yaml/units.h"

namespace dmf::chip {

namespace {

constexpr double kLongestPiece = 0.25;  // r_c, of a contact line
constexpr double kPiecesInAGap = 8;
constexpr double kThermalWork = 10;    // k_BT, that thermal motion undoes
constexpr double kWhollyUnder = 1e-6;  // of a pad's area that may be left
constexpr double kVoltageStep = 0.1;   // V, to which a needed voltage is rounded up

/// Calls visit(middle, outward) for short pieces of an outline; `outward` is as long as the piece.
template <typename Visit>
void for_each_piece(const Polygon& outline, double piece, const Visit& visit) {
  for (std::size_t i = 0, last = outline.size() - 1; i < outline.size(); last = i++) {
    const Vector2d edge = outline[i] - outline[last];
    const int count = std::max(1, static_cast<int>(std::ceil(edge.norm() / piece)));
    const Vector2d step = edge / count;
    for (int k = 0; k < count; ++k) visit(outline[last] + (k + 0.5) * step, Vector2d(step.y(), -step.x()));
  }
}

/// One droplet on one board.
class Explainer {
 public:
  Explainer(const engine::DropletObservation& droplet, const Board& board, const Scene& scene)
      : droplet_(droplet), board_(board), scene_(scene), law_(scene.electrowetting) {
    for (const auto& corner : droplet.footprint) footprint_.push_back(corner.cast<double>());
    piece_ = std::min(kLongestPiece, scene.layout.gap() / kPiecesInAGap);
  }

  DropletExplanation explain() {
    if (!polygon_fault(footprint_).empty()) {
      result_.message = fmt::format("droplet {} does not touch the plate", droplet_.id);
      return result_;
    }
    footprint_ = counter_clockwise(footprint_);
    for (const std::size_t index : scene_.layout.overlapping(footprint_))
      result_.channels.push_back(electrode(index).channel);
    const LinePull pull = line_pull(footprint_, board_.field(), piece_);
    result_.driving_force = tension() * pull.net;
    for (std::size_t side = 0; side < pull.sides.size(); ++side)
      result_.side_forces[side] = tension() * pull.sides[side];
    find_nearest();
    if (nearest_) {
      result_.nearest_channel = electrode(*nearest_).channel;
      result_.opposing_force = tension() * threshold_number() * front_width();
      find_needed_voltage();
    }
    result_.message = fmt::format("droplet {} {}", droplet_.id, reason());
    return result_;
  }

 private:
  const Electrode& electrode(std::size_t index) const { return scene_.layout.electrodes()[index]; }
  double tension() const { return scene_.parameters.liquid.surface_tension; }
  std::uint32_t channel() const { return electrode(*nearest_).channel; }
  bool reaches() const { return result_.nearest_distance < scene_.layout.gap(); }

  /// Somebody wants a voltage on it, or it has one that nobody wants.
  bool actuated(std::size_t index) const { return board_.is_wanted(index) || board_.voltage(index) > 0; }

  void find_nearest() {
    double smallest_share = 0;
    for (std::size_t index = 0; index < scene_.layout.electrodes().size(); ++index) {
      if (!actuated(index)) continue;
      any_actuated_ = true;
      const Polygon& pad = electrode(index).outline;
      const double share = shared_area(pad, footprint_);
      if (share > (1 - kWhollyUnder) * area(pad)) continue;
      const double away = share > 0 ? 0 : distance(pad, footprint_);
      const bool nearer = !nearest_ || away < result_.nearest_distance ||
                          (away == result_.nearest_distance && share < smallest_share);
      if (!nearer) continue;
      nearest_ = index;
      result_.nearest_distance = away;
      smallest_share = share;
    }
  }

  /// From the footprint to the nearest electrode; zero when it is centred on it.
  Vector2d way() const {
    const Vector2d to = electrode(*nearest_).centroid - centroid(footprint_);
    return to.norm() > 1e-9 ? Vector2d(to.normalized()) : Vector2d(Vector2d::Zero());
  }

  /// eta that the threshold takes off.
  double threshold_number() const {
    const double c = law_.number(law_.reference_voltage) / (law_.reference_voltage * law_.reference_voltage -
                                                            law_.threshold_voltage * law_.threshold_voltage);
    return c * law_.threshold_voltage * law_.threshold_voltage;
  }

  /// Of the contact line that the nearest electrode acts on, across the way to it, r_c.
  double front_width() const {
    const Vector2d to = way();
    double width = 0;
    const auto weigh = [&](const Vector2d& middle, const Vector2d& outward) {
      scene_.layout.weights(middle, [&](std::size_t index, double weight) {
        if (index == *nearest_) width += weight * std::max(0.0, outward.dot(to));
      });
    };
    for_each_piece(footprint_, piece_, weigh);
    return width;
  }

  /// Net force towards the nearest electrode, k_BT / r_c.
  double force_towards(const Board& board) const {
    return tension() * line_pull(footprint_, board.field(), piece_).net.dot(way());
  }

  /// The force that is not lost in thermal motion, k_BT / r_c.
  double least_force() const {
    const double length = bounding_box(footprint_).diagonal().norm();
    return kThermalWork * scene_.parameters.liquid.temperature / length;
  }

  /// The board at rest, had it been given another voltage.
  Board at_voltage(double voltage) const {
    Board trial = board_;
    if (board_.is_driven(*nearest_)) {
      trial.apply(SetElectrodeVoltages{{channel()}, {voltage}});
    } else {
      trial.apply(SetHv{voltage, board_.rail().frequency, true});
    }
    trial.settle();
    return trial;
  }

  void find_needed_voltage() {
    const auto moves = [this](double voltage) { return force_towards(at_voltage(voltage)) > least_force(); };
    double enough = law_.max_voltage;
    if (!reaches() || !moves(enough)) return;
    double too_low = 0;
    while (enough - too_low > 0.01 * kVoltageStep) {
      const double middle = 0.5 * (too_low + enough);
      (moves(middle) ? enough : too_low) = middle;
    }
    result_.needed_voltage = std::min(std::ceil(enough / kVoltageStep) * kVoltageStep, law_.max_voltage);
  }

  bool sits() const { return distance(centroid(footprint_), electrode(*nearest_).outline) == 0; }

  /// The actuated electrode nearest to the footprint of those that it does not reach, in words.
  std::string next_one() const {
    std::optional<std::size_t> next;
    double away = 0;
    for (std::size_t index = 0; index < scene_.layout.electrodes().size(); ++index) {
      if (!actuated(index)) continue;
      const double between = distance(electrode(index).outline, footprint_);
      if (between <= 0 || (next && between >= away)) continue;
      next = index;
      away = between;
    }
    if (!next) return "";
    return fmt::format("; the next one that is, channel {}, is {} away", electrode(*next).channel,
                       in_mm(away));
  }

  std::string in_mm(double reduced) const {
    return fmt::format("{:.3g} mm", reduced * scene_.units.length_m * 1e3);
  }

  std::string would_do() const {
    if (!result_.needed_voltage && sits()) return "";
    if (!result_.needed_voltage) return fmt::format("; no voltage up to {:g} V would do", law_.max_voltage);
    return fmt::format("; {:.4g} V would do", *result_.needed_voltage);
  }

  /// What goes on, from "is ..." or "does not move: ..." on.
  std::string reason() const {
    const RailState& rail = board_.rail();
    if (board_.shows_program())
      return fmt::format("is on a wettability program, which overrides the voltages; {}", force_text());
    if (!any_actuated_) {
      if (!rail.halted.empty()) return "does not move: the rail is halted: " + rail.halted;
      return "does not move: no electrode is actuated";
    }
    if (board_.disconnected()) return "does not move: the chip is disconnected";
    if (!nearest_) return "does not move: it sits on all actuated electrodes";
    if (!reaches()) {
      return fmt::format("does not move: its footprint does not reach channel {} ({} away)", channel(),
                         in_mm(result_.nearest_distance));
    }
    const std::string lack = lack_of_voltage();
    if (!lack.empty()) return "does not move: " + lack;
    if (force_towards(board_) > least_force()) {
      const char* unasked = board_.is_wanted(*nearest_) ? "" : ", which is stuck on";
      return fmt::format("is pulled towards channel {}{}; {}", channel(), unasked, force_text());
    }
    if (board_.charging()) return fmt::format("does not move yet: channel {} is charging", channel());
    if (sits())
      return fmt::format("does not move: it sits on channel {}, which is actuated", channel()) + next_one();
    return fmt::format(
               "does not move: the pull of channel {} at {:.4g} V does not exceed that of the other sides",
               channel(), board_.voltage(*nearest_)) +
           would_do();
  }

  /// What keeps the nearest electrode from pulling at all; empty when nothing does.
  std::string lack_of_voltage() const {
    const RailState& rail = board_.rail();
    const double voltage = board_.voltage(*nearest_);
    const PadFaults& faults = board_.faults(*nearest_);
    if (board_.is_disabled(*nearest_)) return fmt::format("channel {} is disabled", channel());
    if (faults.stuck_off) return fmt::format("channel {} is stuck off", channel());
    if (!rail.enabled && !board_.is_driven(*nearest_)) {
      return (rail.halted.empty() ? "the rail is disabled" : "the rail is halted: " + rail.halted) +
             would_do();
    }
    const double number = law_.number(voltage, rail.frequency);
    const bool weak = faults.strength < 1;
    if (number > 0 && !(weak && force_towards(board_) <= least_force())) return "";
    std::string text = weak ? fmt::format("channel {} has {:g} of its voltage, {:.4g} V", channel(),
                                          faults.strength, voltage)
                            : fmt::format("channel {} is on at {:.4g} V", channel(), voltage);
    if (number <= 0 && voltage > law_.threshold_voltage)
      text += fmt::format(", which acts as less at {:g} Hz", rail.frequency);
    if (number <= 0 && law_.threshold_voltage > 0)
      text += fmt::format(", below the threshold of {:g} V", law_.threshold_voltage);
    return text + would_do();
  }

  std::string force_text() const {
    return fmt::format("driving force ({:.3g}, {:.3g}) N", result_.driving_force.x() * scene_.units.force_N(),
                       result_.driving_force.y() * scene_.units.force_N());
  }

  const engine::DropletObservation& droplet_;
  const Board& board_;
  const Scene& scene_;
  const Electrowetting& law_;
  Polygon footprint_;
  double piece_ = kLongestPiece;  ///< r_c
  std::optional<std::size_t> nearest_;
  bool any_actuated_ = false;
  DropletExplanation result_;
};

}  // namespace

LinePull line_pull(const Polygon& outline, const engine::ContactAngleField& angle, double piece) {
  LinePull pull;
  for_each_piece(outline, piece, [&](const Vector2d& middle, const Vector2d& outward) {
    const double cosine = std::cos(angle(middle.x(), middle.y()) * degree);
    pull.net += cosine * outward;
    const std::array<double, 4> towards{outward.x(), outward.y(), -outward.x(), -outward.y()};
    for (std::size_t side = 0; side < towards.size(); ++side)
      pull.sides[side] += cosine * std::max(0.0, towards[side]);
  });
  return pull;
}

DropletExplanation explain_droplet(const engine::DropletObservation& droplet, const Board& board,
                                   const Scene& scene) {
  return Explainer(droplet, board, scene).explain();
}

}  // namespace dmf::chip
