#include "engine/walls/ghosts.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/kernels/lanes-inl.h"
#include "engine/noise-inl.h"
#include "engine/pair_law-inl.h"
#include "engine/species.h"

namespace dmf::engine {
namespace {

std::uint32_t bits_of(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

float float_of(std::uint32_t bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

float coordinate(const Record& record, int axis) {
  return axis == 0 ? record.x : axis == 1 ? record.y : record.z;
}

}  // namespace

Ghosts::Ghosts(const Parameters& parameters)
    : search_(parameters.domain),
      sheared_(parameters.boundaries.shear_rate != 0),
      speed_(parameters.boundaries.shear_rate * parameters.domain.size().z()),
      width_(parameters.domain.size().x()),
      height_(parameters.domain.size().z()),
      law_(liquid_law(parameters.liquid, parameters.time_step)),
      seed_(parameters.seed) {
  if (sheared_) search_.lower_side[2] = search_.upper_side[2] = Side::reflecting;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true})
      if ((upper ? parameters.boundaries.upper_reflection : parameters.boundaries.lower_reflection)[axis] ==
          Reflection::symmetric)
        mirrors_.push_back({axis, upper});
}

void Ghosts::advance(double time, std::uint64_t step) {
  key_ = step_key(seed_, step, Stream::mirror);
  if (!sheared_) return;
  const auto folded = [this](double way) { return way - width_ * std::nearbyint(way / width_); };
  const double moved = folded(folded(speed_ * time) - listed_offset_);
  // Unfolded from where it was listed: images stay in the cells that they were sorted into.
  offset_ = listed_offset_ + moved;
  moved_ = static_cast<float>(std::abs(moved));
}

void Ghosts::wrap(Beads& beads) const {
  if (!sheared_) return;
  const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(beads.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    Record& p = beads.position[i];
    const double periods = std::floor((p.z - search_.lower.z()) / height_);
    if (periods == 0) continue;
    p.z = static_cast<float>(p.z - periods * height_);
    p.x = static_cast<float>(p.x - periods * offset_);
    beads.velocity[i].x = static_cast<float>(beads.velocity[i].x - periods * speed_);
    beads.predicted[i].x = static_cast<float>(beads.predicted[i].x - periods * speed_);
  }
}

void Ghosts::list(const AlignedVector<Record>& listed, double range, bool restored) {
  if (!needed()) return;
  if (restored) {
    offset_ = listed_offset_;
  } else {
    offset_ -= width_ * std::nearbyint(offset_ / width_);
    listed_offset_ = offset_;
  }
  moved_ = 0;
  ghosts_.clear();
  std::vector<Record> places;
  if (sheared_)
    for (const float side : {1.f, -1.f})
      for (std::uint32_t i = 0; i < listed.size(); ++i) {
        const double from_side = side > 0 ? listed[i].z - search_.lower.z() : search_.upper.z() - listed[i].z;
        if (from_side > range) continue;
        const double x = listed[i].x + side * offset_;
        const double fold = -width_ * std::floor((x - search_.lower.x()) / width_);
        ghosts_.push_back(
            {i, {1, 1, 1}, {static_cast<float>(fold), 0, static_cast<float>(side * height_)}, side, 0});
        places.push_back(
            {static_cast<float>(x + fold), listed[i].y, static_cast<float>(listed[i].z + side * height_), 0});
      }
  for (std::size_t m = 0; m < mirrors_.size(); ++m) {
    const auto [axis, upper] = mirrors_[m];
    const double plane = (upper ? search_.upper : search_.lower)[axis];
    const auto mirror = [&, axis = axis](Ghost ghost, Record place) {
      if (std::abs(coordinate(place, axis) - plane) > range) return;
      ghost.sign[axis] = -ghost.sign[axis];
      ghost.shift[axis] = static_cast<float>(2 * plane) - ghost.shift[axis];
      ghost.salt |= 1u << m;
      float& along = axis == 0 ? place.x : axis == 1 ? place.y : place.z;
      along = static_cast<float>(2 * plane) - along;
      ghosts_.push_back(ghost);
      places.push_back(place);
    };
    const std::size_t before = ghosts_.size();
    for (std::uint32_t i = 0; i < listed.size(); ++i) mirror({i, {1, 1, 1}, {0, 0, 0}, 0, 0}, listed[i]);
    for (std::size_t k = 0; k < before; ++k) mirror(ghosts_[k], places[k]);
  }
  if (ghosts_.empty()) return;
  Eigen::Vector3f lower = Eigen::Vector3f::Constant(1e30f), upper = -lower;
  for (const Record& place : places) {
    lower = lower.cwiseMin(Eigen::Vector3f(place.x, place.y, place.z));
    upper = upper.cwiseMax(Eigen::Vector3f(place.x, place.y, place.z));
  }
  grid_.lay(search_, lower, upper, range);
  std::vector<std::uint32_t> order;
  grid_.sort(places.data(), places.size(), order);
  std::vector<Ghost> sorted;
  sorted.reserve(order.size());
  for (const std::uint32_t k : order) sorted.push_back(ghosts_[k]);
  ghosts_.swap(sorted);
}

void Ghosts::append_runs(const Eigen::Vector3f& lower, const Eigen::Vector3f& upper, std::uint32_t beads,
                         std::vector<BeadRun>& runs) const {
  if (ghosts_.empty()) return;
  const std::size_t before = runs.size();
  engine::append_runs(grid_, search_, lower, upper, runs);
  for (std::size_t run = before; run < runs.size(); ++run) {
    runs[run].begin += beads;
    runs[run].end += beads;
  }
}

/// Two beads that see each other mirrored have one noise for both views, another than for each other.
/// The bits that say a bead's species stay.
std::uint32_t Ghosts::key_change(std::uint32_t salt) const {
  return salt == 0 ? 0 : bead_key(key_, salt) & ~species_bits;
}

Record Ghosts::position(std::size_t k, const Beads& beads) const {
  const Ghost& ghost = ghosts_[k];
  const Record& p = beads.position[ghost.source];
  return {ghost.sign[0] * p.x + ghost.shift[0] + ghost.sheared * static_cast<float>(offset_),
          ghost.sign[1] * p.y + ghost.shift[1], ghost.sign[2] * p.z + ghost.shift[2],
          float_of(bits_of(p.w) ^ key_change(ghost.salt))};
}

Record Ghosts::velocity(std::size_t k, const Record& v) const {
  const Ghost& ghost = ghosts_[k];
  return {ghost.sign[0] * v.x + ghost.sheared * static_cast<float>(speed_), ghost.sign[1] * v.y,
          ghost.sign[2] * v.z, v.w};
}

void Ghosts::place(Beads& beads) const {
  const std::size_t count = beads.size();
  const std::ptrdiff_t ghosts = static_cast<std::ptrdiff_t>(ghosts_.size());
  beads.position.resize(count + ghosts_.size());
  beads.predicted.resize(count + ghosts_.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t k = 0; k < ghosts; ++k) {
    beads.position[count + k] = position(k, beads);
    beads.predicted[count + k] = velocity(k, beads.predicted[ghosts_[k].source]);
  }
}

void Ghosts::remove(Beads& beads) const {
  beads.position.resize(beads.size());
  beads.predicted.resize(beads.size());
}

void Ghosts::correct_own_noise(const Beads& beads, AlignedVector<Record>& to) const {
  for (std::size_t k = 0; k < ghosts_.size(); ++k) {
    const Ghost& ghost = ghosts_[k];
    if (ghost.salt == 0) continue;
    const Record &own = beads.position[ghost.source], image = position(k, beads);
    const Vector3d d(own.x - image.x, own.y - image.y, own.z - image.z);
    const double r = std::max(d.norm(), 1e-6);
    if (r >= law_.range() || d.squaredNorm() <= 1e-12) continue;
    const std::uint32_t key = bits_of(own.w), change = key_change(ghost.salt);
    const double given = HWY_NAMESPACE::pair_noise<double>(key, key ^ change);
    const double wanted = std::sqrt(2.0) * HWY_NAMESPACE::pair_noise<double>(mix32(key), change);
    const double force = law_.random_amplitude * HWY_NAMESPACE::random_weight(law_, r) * (wanted - given);
    Record& sum = to[ghost.source];
    sum.x += static_cast<float>(force / r * d.x());
    sum.y += static_cast<float>(force / r * d.y());
    sum.z += static_cast<float>(force / r * d.z());
  }
}

void Ghosts::archive(Archive& archive) {
  if (!sheared_) return;
  archive(listed_offset_);
  if (!(std::abs(listed_offset_) <= width_))
    throw InvalidInput("saved state: images beyond sheared sides that are farther away than a period");
}

}  // namespace dmf::engine
