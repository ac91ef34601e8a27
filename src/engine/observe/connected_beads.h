#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace dmf::engine {

/// Sets of connected beads, each with a root: its first bead. Across periodic sides a set may be wound: every
/// bead knows in which image it stands, seen from the root (in periods, along each axis).
class ConnectedBeads {
 public:
  explicit ConnectedBeads(std::size_t count) : links_(count) {
    for (std::uint32_t bead = 0; bead < count; ++bead) links_[bead].parent = bead;
  }

  using Image = std::array<std::int16_t, 3>;

  bool joined(std::uint32_t first, std::uint32_t second) {
    return links_[first].parent == links_[second].parent || root(first) == root(second);
  }

  /// Joins the sets of two beads that are not joined yet, the second of which stands in `image` seen from the
  /// first.
  void join(std::uint32_t first, std::uint32_t second, const Image& image) {
    const std::uint32_t a = root(first), b = root(second);
    // second's root seen from first's root.
    const Image between = difference(sum(image_of(first), image), image_of(second));
    if (a < b) {
      links_[b] = {a, between};
    } else {
      links_[a] = {b, difference({}, between)};
    }
  }

  /// Afterwards the bead hangs directly on its root.
  std::uint32_t root(std::uint32_t bead) {
    if (links_[bead].parent == bead) return bead;
    std::uint32_t top = bead;
    Image image{};
    while (links_[top].parent != top) {
      image = sum(image, links_[top].image);
      top = links_[top].parent;
    }
    while (links_[bead].parent != top) {
      const Link next = links_[bead];
      links_[bead] = {top, image};
      image = difference(image, next.image);
      bead = next.parent;
    }
    return top;
  }
  /// Of a bead seen from its root; root(bead) must have been called since the last join.
  const Image& image_of(std::uint32_t bead) const { return links_[bead].image; }

 private:
  struct Link {
    std::uint32_t parent;
    Image image{};
  };
  static Image sum(const Image& a, const Image& b) {
    return {std::int16_t(a[0] + b[0]), std::int16_t(a[1] + b[1]), std::int16_t(a[2] + b[2])};
  }
  static Image difference(const Image& a, const Image& b) {
    return {std::int16_t(a[0] - b[0]), std::int16_t(a[1] - b[1]), std::int16_t(a[2] - b[2])};
  }

  std::vector<Link> links_;
};

}  // namespace dmf::engine
