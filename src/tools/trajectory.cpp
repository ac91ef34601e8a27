#include "tools/trajectory.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace dmf::tools {

double slope_of_parabola(const std::vector<double>& times, const std::vector<double>& values, double time) {
  if (times.size() < 4) return NAN;
  // Time from `time` on, in units of the window: the slope there is the second coefficient, and the matrix is
  // well conditioned.
  const double unit = std::max(1e-9, times.back() - times.front());
  const auto count = static_cast<Eigen::Index>(times.size());
  Eigen::MatrixXd powers(count, 3);
  Eigen::VectorXd right(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double t = (times[static_cast<std::size_t>(k)] - time) / unit;
    powers.row(k) << 1, t, t * t;
    right(k) = values[static_cast<std::size_t>(k)];
  }
  const Eigen::Vector3d fit = powers.colPivHouseholderQr().solve(right);
  return fit(1) / unit;
}

Trajectory::Trajectory(const std::vector<TransportRecord>& records, int microparticle) {
  for (TransportRecord record : records) {
    if (record.microparticle != microparticle) continue;
    if (microparticle == 0) record.x = record.droplet_x, record.z = record.droplet_z;
    records_.push_back(record);
  }
}

double Trajectory::first_pass(double x, double TransportRecord::*place) const {
  for (std::size_t k = 1; k < records_.size(); ++k) {
    const TransportRecord &before = records_[k - 1], &after = records_[k];
    if (before.*place < x && after.*place >= x)
      return before.time + (x - before.*place) / (after.*place - before.*place) * (after.time - before.time);
  }
  return NAN;
}

double Trajectory::time_at(double x) const { return first_pass(x, &TransportRecord::x); }
double Trajectory::droplet_time_at(double x) const { return first_pass(x, &TransportRecord::droplet_x); }

double Trajectory::time_picked_up() const {
  for (const TransportRecord& record : records_)
    if (record.picked_up > 0) return record.time;
  return NAN;
}

std::optional<std::size_t> Trajectory::drop_off() const {
  std::optional<std::size_t> found;
  for (std::size_t k = 0; k < records_.size(); ++k) {
    const bool lost = records_[k].carrier != records_[k].droplet;
    // Without an event too, when the satellite that kept it has merged into the droplet.
    if (!lost) found.reset();
    if (lost && records_[k].dropped_off > 0) found = k;
  }
  return found;
}

double Trajectory::time_dropped_off() const {
  const auto k = drop_off();
  return k ? records_[*k].time : NAN;
}

double Trajectory::x_dropped_off() const {
  const auto k = drop_off();
  return k ? records_[*k].x : NAN;
}

std::vector<TransportRecord> Trajectory::way_before_drop_off() const {
  std::vector<TransportRecord> way;
  const auto last = drop_off();
  if (!last) return way;
  const double end = records_[*last].x - spared_way;
  for (std::size_t k = 0; k <= *last && records_[k].x <= end; ++k)
    if (records_[k].x >= end - fitted_way) way.push_back(records_[k]);
  return way;
}

double Trajectory::critical_velocity() const {
  std::vector<double> times, places;
  for (const TransportRecord& record : way_before_drop_off()) {
    times.push_back(record.time);
    places.push_back(record.x);
  }
  return times.empty() ? NAN : slope_of_parabola(times, places, times.back());
}

double Trajectory::velocity_before_drop_off() const {
  const std::vector<TransportRecord> way = way_before_drop_off();
  if (way.size() < 2) return NAN;
  return (way.back().x - way.front().x) / (way.back().time - way.front().time);
}

double Trajectory::drive_before_drop_off() const {
  const std::vector<TransportRecord> way = way_before_drop_off();
  double sum = 0;
  for (const TransportRecord& record : way) sum += record.drive_x;
  return way.empty() ? NAN : sum / static_cast<double>(way.size());
}

double Trajectory::held_with() const {
  const double end = time_dropped_off() - letting_go, start = end - held_window;
  double sum = 0, count = 0;
  for (const TransportRecord& record : records_)
    if (record.time > start && record.time <= end) sum += record.drive_x, count += 1;
  return start >= time_picked_up() ? sum / count : NAN;
}

double Trajectory::time_fastest() const {
  double fastest = -1, found = NAN;
  std::size_t from = 0, to = 0;
  for (const TransportRecord& middle : records_) {
    if (middle.time < fastest_window / 2) continue;
    if (middle.time > records_.back().time - fastest_window / 2) break;
    while (records_[from].time < middle.time - fastest_window / 2) ++from;
    while (to < records_.size() && records_[to].time <= middle.time + fastest_window / 2) ++to;
    std::vector<double> times, values;
    for (std::size_t k = from; k < to; ++k)
      times.push_back(records_[k].time), values.push_back(records_[k].x);
    const double slope = slope_of_parabola(times, values, middle.time);
    if (slope > fastest) fastest = slope, found = middle.time;
  }
  return found;
}

double Trajectory::time_lifted(double lift) const {
  const auto standing = std::find_if(records_.begin(), records_.end(), [](const TransportRecord& record) {
    return record.contact_fraction > 0;
  });
  if (standing == records_.end()) return NAN;
  for (auto record = standing; record != records_.end(); ++record)
    if (record->z > standing->z + lift) return record->time;
  return NAN;
}

double Trajectory::mean(double from_time, double TransportRecord::*value) const {
  double sum = 0, count = 0;
  for (const TransportRecord& record : records_)
    if (record.time > from_time && std::isfinite(record.*value)) sum += record.*value, count += 1;
  return count > 0 ? sum / count : NAN;
}

double Trajectory::last_before(double time, double TransportRecord::*value) const {
  double found = NAN;
  for (const TransportRecord& record : records_)
    if (record.time <= time) found = record.*value;
  return found;
}

double Trajectory::mean_height() const { return mean(time_picked_up(), &TransportRecord::height); }
double Trajectory::contact_fraction() const {
  return mean(time_picked_up(), &TransportRecord::contact_fraction);
}

double Trajectory::final_x() const {
  return records_.empty() ? NAN : mean(0.9 * records_.back().time, &TransportRecord::x);
}
double Trajectory::final_droplet_x() const {
  return records_.empty() ? NAN : mean(0.9 * records_.back().time, &TransportRecord::droplet_x);
}
double Trajectory::final_height() const {
  return records_.empty() ? NAN : mean(0.9 * records_.back().time, &TransportRecord::height);
}

double Trajectory::x_at(double time) const { return last_before(time, &TransportRecord::x); }
double Trajectory::droplet_x_at(double time) const { return last_before(time, &TransportRecord::droplet_x); }

bool Trajectory::carried_at_end() const {
  return !records_.empty() && records_.back().carrier > 0 &&
         records_.back().carrier == records_.back().droplet;
}

}  // namespace dmf::tools
