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

}  // namespace

Ghosts::Ghosts(const Parameters& parameters)
    : domain_(parameters.domain),
      search_(parameters.domain),
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

void Ghosts::find_images(const Eigen::Vector3f& lower, const Eigen::Vector3f& upper, double range,
                         double protrusion, std::vector<BoxImage>& found) const {
  found.assign(1, {{}, lower, upper});
  if (sheared_)
    for (const float side : {1.f, -1.f}) {
      const double from_side = side > 0 ? lower.z() - domain_.lower.z() : domain_.upper.z() - upper.z();
      if (from_side > range + protrusion) continue;
      BoxImage beyond = found.front();
      const double x = 0.5 * (lower.x() + upper.x()) + side * listed_offset_;
      const double fold = -width_ * std::floor((x - domain_.lower.x()) / width_);
      beyond.image.shift[0] = static_cast<float>(fold);
      beyond.image.shift[2] = static_cast<float>(side * height_);
      beyond.image.sheared = side;
      for (Eigen::Vector3f* corner : {&beyond.lower, &beyond.upper}) {
        corner->x() = static_cast<float>(corner->x() + side * listed_offset_ + fold);
        corner->z() = static_cast<float>(corner->z() + side * height_);
      }
      found.push_back(beyond);
    }
  for (std::size_t m = 0; m < mirrors_.size(); ++m) {
    const auto [axis, above] = mirrors_[m];
    const double plane = (above ? domain_.upper : domain_.lower)[axis];
    for (std::size_t k = 0, before = found.size(); k < before; ++k) {
      BoxImage behind = found[k];
      if ((above ? plane - behind.upper[axis] : behind.lower[axis] - plane) > range) continue;
      Image& image = behind.image;
      image.sign[axis] = -image.sign[axis];
      image.shift[axis] = static_cast<float>(2 * plane) - image.shift[axis];
      image.salt |= 1u << m;
      const float reflected = static_cast<float>(2 * plane) - behind.upper[axis];
      behind.upper[axis] = static_cast<float>(2 * plane) - behind.lower[axis];
      behind.lower[axis] = reflected;
      found.push_back(behind);
    }
  }
}

void Ghosts::list(const AlignedVector<Record>& listed, double range, double protrusion, bool restored) {
  if (!needed()) return;
  if (restored) {
    offset_ = listed_offset_;
  } else {
    offset_ -= width_ * std::nearbyint(offset_ / width_);
    listed_offset_ = offset_;
  }
  moved_ = 0;
  beads_ = static_cast<std::uint32_t>(listed.size());
  ghosts_.clear();
  std::vector<Record> places;
  std::vector<BoxImage> found;
  for (std::uint32_t i = 0; i < listed.size(); ++i) {
    const Eigen::Vector3f at(listed[i].x, listed[i].y, listed[i].z);
    find_images(at, at, range, protrusion, found);
    for (std::size_t k = 1; k < found.size(); ++k) {
      ghosts_.push_back({i, found[k].image});
      places.push_back({found[k].lower.x(), found[k].lower.y(), found[k].lower.z(), 0});
    }
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

std::vector<std::vector<Ghosts::Patch>> Ghosts::list_body(const std::vector<Patch>& patches, double range,
                                                          std::size_t body_beads) {
  if (!needed()) return {};
  Eigen::Vector3f lower = patches.front().lower, upper = patches.front().upper;
  for (const Patch& patch : patches) {
    lower = lower.cwiseMin(patch.lower);
    upper = upper.cwiseMax(patch.upper);
  }
  std::vector<BoxImage> of_body;
  find_images(lower, upper, range, 0, of_body);
  std::vector<std::vector<Patch>> images;
  for (std::size_t k = 1; k < of_body.size(); ++k) {
    const Image& image = of_body[k].image;
    std::vector<Patch>& of_image = images.emplace_back();
    for (const Patch& patch : patches) {
      const auto first = static_cast<std::uint32_t>(body_beads + of_bodies_.size());
      for (std::uint32_t bead = patch.begin; bead < patch.end; ++bead) of_bodies_.push_back({bead, image});
      Eigen::Vector3f corners[2];
      for (const bool at_upper : {false, true}) {
        const Eigen::Vector3f& corner = at_upper ? patch.upper : patch.lower;
        const Record there = position(image, {corner.x(), corner.y(), corner.z(), 0}, listed_offset_);
        corners[at_upper] = {there.x, there.y, there.z};
      }
      of_image.push_back({first, first + patch.end - patch.begin, corners[0].cwiseMin(corners[1]),
                          corners[0].cwiseMax(corners[1])});
    }
  }
  return images;
}

void Ghosts::append_runs(const Eigen::Vector3f& lower, const Eigen::Vector3f& upper,
                         std::vector<BeadRun>& runs) const {
  if (ghosts_.empty()) return;
  const std::size_t before = runs.size();
  engine::append_runs(grid_, search_, lower, upper, runs);
  for (std::size_t run = before; run < runs.size(); ++run) {
    runs[run].begin += beads_;
    runs[run].end += beads_;
  }
}

/// Two beads that see each other mirrored have one noise for both views, another than for each other.
/// The bits that say a bead's species stay.
std::uint32_t Ghosts::key_change(std::uint32_t salt) const {
  return salt == 0 ? 0 : bead_key(key_, salt) & ~species_bits;
}

Record Ghosts::position(const Image& image, const Record& of, double offset) const {
  return {image.sign[0] * of.x + image.shift[0] + image.sheared * static_cast<float>(offset),
          image.sign[1] * of.y + image.shift[1], image.sign[2] * of.z + image.shift[2], of.w};
}

Record Ghosts::velocity(const Image& image, const Record& of) const {
  return {image.sign[0] * of.x + image.sheared * static_cast<float>(speed_), image.sign[1] * of.y,
          image.sign[2] * of.z, of.w};
}

Record Ghosts::position(std::uint32_t bead, const Beads& beads) const {
  if (bead < beads_) return beads.position[bead];
  const auto& [source, image] = ghost(bead);
  Record at = position(image, beads.position[source], offset_);
  at.w = float_of(bits_of(at.w) ^ key_change(image.salt));
  return at;
}

Record Ghosts::velocity(std::uint32_t bead, const Record& v) const {
  return bead < beads_ ? v : velocity(ghost(bead).image, v);
}

Vector3d Ghosts::force_on_source(std::uint32_t bead, const Vector3d& force) const {
  if (bead < beads_) return force;
  const float* sign = ghost(bead).image.sign;
  return force.cwiseProduct(Vector3d(sign[0], sign[1], sign[2]));
}

void Ghosts::place(Beads& beads, BodyBeads& bodies) const {
  const std::size_t count = beads.size(), of_bodies = bodies.size();
  const std::ptrdiff_t ghosts = static_cast<std::ptrdiff_t>(ghosts_.size());
  beads.position.resize(count + ghosts_.size());
  beads.predicted.resize(count + ghosts_.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t k = 0; k < ghosts; ++k) {
    const auto image = static_cast<std::uint32_t>(count + k);
    beads.position[image] = position(image, beads);
    beads.predicted[image] = velocity(image, beads.predicted[source(image)]);
  }
  bodies.position.resize(of_bodies + of_bodies_.size());
  bodies.moving.resize(of_bodies + of_bodies_.size());
  bodies.key.resize(of_bodies + of_bodies_.size());
  for (std::size_t k = 0; k < of_bodies_.size(); ++k) {
    const auto& [source, image] = of_bodies_[k];
    bodies.position[of_bodies + k] = position(image, bodies.position[source], offset_);
    bodies.moving[of_bodies + k] = velocity(image, bodies.moving[source]);
    bodies.key[of_bodies + k] = bodies.key[source] ^ key_change(image.salt);
  }
}

void Ghosts::remove(Beads& beads, BodyBeads& bodies) const {
  beads.position.resize(beads.size());
  beads.predicted.resize(beads.size());
  bodies.position.resize(bodies.size());
  bodies.moving.resize(bodies.size());
  bodies.key.resize(bodies.size());
}

void Ghosts::correct_own_noise(const Beads& beads, AlignedVector<Record>& to) const {
  for (std::uint32_t k = 0; k < ghosts_.size(); ++k) {
    const Ghost& ghost = ghosts_[k];
    if (ghost.image.salt == 0) continue;
    const Record &own = beads.position[ghost.source], image = position(beads_ + k, beads);
    const Vector3d d(own.x - image.x, own.y - image.y, own.z - image.z);
    const double r = std::max(d.norm(), 1e-6);
    if (r >= law_.range() || d.squaredNorm() <= 1e-12) continue;
    const std::uint32_t key = bits_of(own.w), change = key_change(ghost.image.salt);
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
