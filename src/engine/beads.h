#pragma once
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace dmf::engine {

/// 16 bytes that a kernel loads at once.
struct alignas(16) Record {
  float x = 0, y = 0, z = 0;
  float w = 0;
};

/// Starts vectors on a cache line, so that no record straddles two, and leaves room behind them: kernels load
/// whole registers, up to 16 records, from the last element on.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}
  static constexpr std::size_t slack = 16 * sizeof(Record);
  T* allocate(std::size_t n) {
    return static_cast<T*>(::operator new (n * sizeof(T) + slack, std::align_val_t{64}));
  }
  void deallocate(T* p, std::size_t) { ::operator delete (p, std::align_val_t{64}); }
  template <class U>
  bool operator==(const CacheLineAllocator<U>&) const {
    return true;
  }
  template <class U>
  bool operator!=(const CacheLineAllocator<U>&) const {
    return false;
  }
};
template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

/// The moving beads of the liquid, sorted by cell now and then. Ids persist, indices do not.
///
/// Which pass reads and writes what (so that no two threads meet):
///   drift    writes position, velocity (at half step), predicted.xyz
///   density  reads position; writes predicted.w (rho) of its own bead
///   force    reads position, predicted; writes force of its own bead
///   finish   reads force; writes velocity
/// With BAOAB the force pass runs for one part of the forces at a time and writes random or force; the
/// thermostat writes predicted.xyz and velocity between two of them.
struct Beads {
  AlignedVector<Record> position;   ///< x, y, z; w: bits of the bead's noise key of this step (species.h)
  AlignedVector<Record> predicted;  ///< velocity that the pair forces see; w: density rho
  AlignedVector<Record> velocity;   ///< at the end of a step, with BAOAB half a kick before it; w unused
  AlignedVector<Record> force;      ///< at the end of a step, with BAOAB conservative ones only; w unused
  AlignedVector<Record> listed;     ///< position when beads were sorted; w unused
  AlignedVector<Record> random;     ///< sum of the random pair forces: scratch of a BAOAB step
  std::vector<std::uint32_t> id;
  std::vector<std::uint8_t> species;  ///< number of the liquid; empty while all are the first one

  std::size_t size() const { return id.size(); }

  std::uint8_t species_of(std::size_t bead) const { return species.empty() ? 0 : species[bead]; }

  /// Appends a bead at rest forces. Call `Pairs::invalidate()` afterwards.
  void add(const Record& at, const Record& moving, std::uint32_t bead_id, std::uint8_t of_species = 0);

  /// Makes room for `count` more beads, so that adding them one by one does not double the arrays.
  void reserve_more(std::size_t count);

  /// Reorders all arrays but `listed`, which serves as scratch: the bead at order[k] moves to k. Drops beads
  /// whose index is missing from `order`. Call `Pairs::rebuild()` afterwards.
  void reorder(const std::vector<std::uint32_t>& order);

 private:
  std::vector<std::uint32_t> scratch_id_;
  std::vector<std::uint8_t> scratch_species_;
};

}  // namespace dmf::engine
