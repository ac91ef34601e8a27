#include "engine/observe/stress_profile.h"

#include <fmt/format.h>

#include "engine/observe/pair_stress-inl.h"

namespace dmf::engine {
namespace {

/// Along one axis, in units of a slab.
class Slabs {
 public:
  Slabs(const StressSlabs& wanted, const Domain& domain)
      : axis_(wanted.axis),
        count_(static_cast<std::ptrdiff_t>(wanted.count)),
        lower_(domain.lower[axis_]),
        thickness_(domain.size()[axis_] / static_cast<double>(count_)),
        periodic_(domain.periodic(axis_)) {}

  double place(const Record& at) const {
    const float along[3] = {at.x, at.y, at.z};
    return (along[axis_] - lower_) / thickness_;
  }
  double length(const Vector3d& apart) const { return apart[axis_] / thickness_; }

  /// The slab that holds a place. What is beyond a closed side belongs to the last slab before it.
  std::size_t holding(double place) const {
    auto slab = static_cast<std::ptrdiff_t>(std::floor(place));
    slab = periodic_ ? ((slab % count_) + count_) % count_ : std::clamp<std::ptrdiff_t>(slab, 0, count_ - 1);
    return static_cast<std::size_t>(slab);
  }

  /// Calls visit(slab, part) for every slab that a line from one place to another touches.
  template <class Visit>
  void divide(double from, double to, Visit visit) const {
    const double lower = std::min(from, to), upper = std::max(from, to);
    double begin = lower;
    for (double edge = std::floor(lower) + 1; edge < upper; edge += 1) {
      visit(holding(0.5 * (begin + edge)), (edge - begin) / (upper - lower));
      begin = edge;
    }
    visit(holding(0.5 * (begin + upper)), upper > lower ? (upper - begin) / (upper - lower) : 1.0);
  }

 private:
  int axis_;
  std::ptrdiff_t count_;
  double lower_, thickness_;
  bool periodic_;
};

}  // namespace

std::vector<SlabStress> stress_profile(const StressSlabs& slabs, const Beads& beads,
                                       const std::vector<NeighbourBlock>& blocks, const Ghosts& ghosts,
                                       const Bonds& bonds, const Parameters& parameters) {
  if (slabs.axis < 0 || slabs.axis > 2)
    throw InvalidInput(fmt::format("stress.axis: {}, allowed: 0 to 2", slabs.axis));
  if (slabs.count < 1 || slabs.count > 100000)
    throw InvalidInput(fmt::format("stress.count: {}, allowed: 1 to 100000", slabs.count));
  const Slabs layers(slabs, parameters.domain);
  std::vector<SlabStress> result(slabs.count);
  std::vector<std::size_t> count(slabs.count), slab_of(beads.size());
  for (std::size_t i = 0; i < beads.size(); ++i) {
    slab_of[i] = layers.holding(layers.place(beads.position[i]));
    const Record& v = beads.velocity[i];
    result[slab_of[i]].velocity += Vector3d(v.x, v.y, v.z);
    ++count[slab_of[i]];
  }
  for (std::size_t k = 0; k < slabs.count; ++k)
    if (count[k] > 0) result[k].velocity /= static_cast<double>(count[k]);

  for (std::size_t i = 0; i < beads.size(); ++i) {
    const Record& v = beads.velocity[i];
    const Vector3d peculiar = Vector3d(v.x, v.y, v.z) - result[slab_of[i]].velocity;
    result[slab_of[i]].pressure += peculiar * peculiar.transpose();
  }
  // The slab's own mean takes one bead's share of the motion.
  for (std::size_t k = 0; k < slabs.count; ++k)
    if (count[k] > 1) {
      result[k].temperature =
          result[k].pressure.trace() / (parameters.dimensions * static_cast<double>(count[k] - 1));
      result[k].pressure *= static_cast<double>(count[k]) / static_cast<double>(count[k] - 1);
    }
  const auto add = [&](std::uint32_t i, const Vector3d& apart, const Eigen::Matrix3d& stress) {
    const double from = layers.place(beads.position[i]);
    layers.divide(from, from - layers.length(apart),
                  [&](std::size_t slab, double part) { result[slab].pressure += part * stress; });
  };
  bonds.for_each_stress(beads, add);
  for (const NeighbourBlock& block : blocks) {
    const auto share = [&](std::uint32_t i, const Vector3d& apart, double force_over_distance) {
      // A pair stands in the rows of both its beads: half of it each time.
      add(i, apart, 0.5 * force_over_distance * apart * apart.transpose());
    };
    for_each_pair_stress<PairForce::conservative>(block, beads, ghosts, parameters, share);
    for_each_pair_stress<PairForce::friction>(block, beads, ghosts, parameters, share);
  }
  const double volume = parameters.domain.size().prod() / static_cast<double>(slabs.count);
  for (std::size_t k = 0; k < slabs.count; ++k) {
    result[k].pressure /= volume;
    result[k].density = static_cast<double>(count[k]) / volume;
  }
  return result;
}

}  // namespace dmf::engine
