#pragma once
#include <optional>
#include <vector>

#include "tools/transport.h"

namespace dmf::tools {

/// What the records of one microparticle say of its way. Reduced units; NaN for what has not happened.
class Trajectory {
 public:
  /// @param microparticle  its id; 0: the droplet of a scene without, whose centroid then counts as x.
  Trajectory(const std::vector<TransportRecord>& records, int microparticle);

  /// When it first passes x on its way to +x, linear between records, tau.
  double time_at(double x) const;
  double droplet_time_at(double x) const;  ///< the same of the largest droplet's centroid
  double time_picked_up() const;
  double time_dropped_off() const;  ///< by the droplet that did not take it up again
  double x_dropped_off() const;
  /// Velocity at the drop-off by Lan's way (4.2.1): the slope of a parabola fitted to the trajectory before
  /// it. Fitted over the last `fitted_way` that ends `spared_way` before the place of drop-off, where the
  /// droplet is already letting go.
  double critical_velocity() const;
  /// The mean over the same way. Scatters less than the slope at the end of a parabola.
  double velocity_before_drop_off() const;
  /// Mean force of the liquid along x over the same way, k_BT / r_c: with what it was held until then.
  double drive_before_drop_off() const;
  /// The last force of the liquid along x that held it, k_BT / r_c: the mean over `held_window` that ends
  /// `letting_go` before the drop-off, for as long can the droplet draw out the thread that breaks.
  double held_with() const;
  static constexpr double held_window = 500.0, letting_go = 500.0;  ///< tau
  static constexpr double fitted_way = 8.0, spared_way = 0.5;       ///< r_c
  /// When it is fastest: the largest slope of parabolas fitted over `fastest_window`. That is where the
  /// trajectory turns from concave to convex.
  double time_fastest() const;
  static constexpr double fastest_window = 600.0;  ///< tau
  /// When its centre first stands `lift` r_c higher than it does on the wall.
  double time_lifted(double lift = 0.5) const;
  // Means from the pickup on, every step counted.
  double mean_height() const;  ///< of the centre over the wall plane
  double contact_fraction() const;
  // Means over the last tenth of the run.
  double final_x() const;
  double final_droplet_x() const;
  double final_height() const;
  // Of the last record before that time.
  double x_at(double time) const;
  double droplet_x_at(double time) const;
  bool carried_at_end() const;  ///< by the largest droplet

 private:
  std::optional<std::size_t> drop_off() const;
  std::vector<TransportRecord> way_before_drop_off() const;  ///< empty: not dropped off
  double first_pass(double x, double TransportRecord::*place) const;
  double mean(double from_time, double TransportRecord::*value) const;
  double last_before(double time, double TransportRecord::*value) const;

  std::vector<TransportRecord> records_;
};

/// x(t) = a + b t + c t^2 by least squares. @returns its slope at `time`; NaN for fewer than 4 points.
double slope_of_parabola(const std::vector<double>& times, const std::vector<double>& values, double time);

}  // namespace dmf::tools
