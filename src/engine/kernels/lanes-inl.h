// The only place where Highway operations stand: lanes that read like numbers. Compiled per instruction set.
#if defined(DMF_ENGINE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DMF_ENGINE_LANES_INL_H
#undef DMF_ENGINE_LANES_INL_H
#else
#define DMF_ENGINE_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "engine/beads.h"
#include "engine/kernels/selected_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace dmf::engine::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using UnsignedTag = hn::RebindToUnsigned<FloatTag>;
using SignedTag = hn::RebindToSigned<FloatTag>;
using FloatVector = hn::Vec<FloatTag>;
using UnsignedVector = hn::Vec<UnsignedTag>;
using Mask = hn::Mask<FloatTag>;

constexpr std::size_t lane_count = hn::MaxLanes(FloatTag());

struct Lanes {
  FloatVector v;
  Lanes() = default;
  HWY_INLINE Lanes(FloatVector vector) : v(vector) {}  // NOLINT: reads as a number
  HWY_INLINE explicit Lanes(float value) : v(hn::Set(FloatTag(), value)) {}
  HWY_INLINE explicit Lanes(int value) : Lanes(static_cast<float>(value)) {}
};
HWY_INLINE Lanes operator+(Lanes a, Lanes b) { return hn::Add(a.v, b.v); }
HWY_INLINE Lanes operator-(Lanes a, Lanes b) { return hn::Sub(a.v, b.v); }
HWY_INLINE Lanes operator*(Lanes a, Lanes b) { return hn::Mul(a.v, b.v); }
HWY_INLINE Lanes operator/(Lanes a, Lanes b) { return hn::Div(a.v, b.v); }
HWY_INLINE Lanes maximum(Lanes a, Lanes b) { return hn::Max(a.v, b.v); }
HWY_INLINE Lanes absolute(Lanes a) { return hn::Abs(a.v); }
HWY_INLINE Lanes square_root(Lanes a) { return hn::Sqrt(a.v); }
HWY_INLINE Lanes nearest_integer(Lanes a) { return hn::Round(a.v); }
HWY_INLINE Mask operator<(Lanes a, Lanes b) { return hn::Lt(a.v, b.v); }
HWY_INLINE Lanes zero_unless(Mask mask, Lanes a) { return hn::IfThenElseZero(mask, a.v); }
HWY_INLINE Mask first_lanes(std::size_t count) { return hn::FirstN(FloatTag(), count); }
HWY_INLINE Mask both(Mask a, Mask b) { return hn::And(a, b); }
HWY_INLINE Lanes load_lanes(const float* from) { return hn::LoadU(FloatTag(), from); }
HWY_INLINE void store_lanes(Lanes a, float* to) { hn::StoreU(a.v, FloatTag(), to); }

struct UnsignedLanes {
  UnsignedVector v;
  UnsignedLanes() = default;
  HWY_INLINE UnsignedLanes(UnsignedVector vector) : v(vector) {}  // NOLINT
  HWY_INLINE explicit UnsignedLanes(std::uint32_t value) : v(hn::Set(UnsignedTag(), value)) {}
};
HWY_INLINE UnsignedLanes operator+(UnsignedLanes a, UnsignedLanes b) { return hn::Add(a.v, b.v); }
HWY_INLINE UnsignedLanes operator*(UnsignedLanes a, UnsignedLanes b) { return hn::Mul(a.v, b.v); }
HWY_INLINE UnsignedLanes operator^(UnsignedLanes a, UnsignedLanes b) { return hn::Xor(a.v, b.v); }
HWY_INLINE UnsignedLanes operator&(UnsignedLanes a, UnsignedLanes b) { return hn::And(a.v, b.v); }
HWY_INLINE UnsignedLanes operator>>(UnsignedLanes a, int bits) { return hn::ShiftRightSame(a.v, bits); }
HWY_INLINE UnsignedLanes bits_of(Lanes a) { return hn::BitCast(UnsignedTag(), a.v); }
HWY_INLINE UnsignedLanes load_lanes(const std::uint32_t* from) { return hn::LoadU(UnsignedTag(), from); }
HWY_INLINE void store_lanes(UnsignedLanes a, std::uint32_t* to) { hn::StoreU(a.v, UnsignedTag(), to); }
/// The numbers at whole lanes of indices.
HWY_INLINE UnsignedLanes gather(const std::uint32_t* numbers, const std::uint32_t* indices) {
  return hn::GatherIndex(UnsignedTag(), numbers, hn::BitCast(SignedTag(), hn::LoadU(UnsignedTag(), indices)));
}
HWY_INLINE UnsignedLanes lane_numbers() { return hn::Iota(UnsignedTag(), 0); }

/// Two's complement bits as a number in [-2^31, 2^31).
template <class Real, class Unsigned>
Real from_signed_bits(Unsigned bits);
template <>
HWY_INLINE Lanes from_signed_bits<Lanes, UnsignedLanes>(UnsignedLanes bits) {
  return hn::ConvertTo(FloatTag(), hn::BitCast(SignedTag(), bits.v));
}
template <>
HWY_INLINE double from_signed_bits<double, std::uint32_t>(std::uint32_t bits) {
  return static_cast<double>(static_cast<std::int32_t>(bits));
}
HWY_INLINE double maximum(double a, double b) { return std::max(a, b); }
HWY_INLINE double square_root(double a) { return std::sqrt(a); }

/// Eight numbers that lanes look up in registers.
class LaneTable {
 public:
  /// @param numbers  on a cache line; 16 may be read.
#if HWY_TARGET == HWY_SCALAR
  HWY_INLINE explicit LaneTable(const float* numbers) : numbers_(numbers) {}
  HWY_INLINE Lanes operator[](UnsignedLanes index) const { return Lanes(numbers_[hn::GetLane(index.v)]); }

 private:
  const float* numbers_;
#else
  HWY_INLINE explicit LaneTable(const float* numbers)
      : first_(hn::Load(FloatTag(), numbers)), second_(hn::Load(FloatTag(), numbers + 8 - half)) {}
  /// @param index  below 8.
  HWY_INLINE Lanes operator[](UnsignedLanes index) const {
    if constexpr (lane_count >= 8) {
      return hn::TableLookupLanes(first_, hn::IndicesFromVec(FloatTag(), index.v));
    } else {
      const UnsignedTag tag;
      const auto order = hn::IndicesFromVec(FloatTag(), hn::And(index.v, hn::Set(tag, 3)));
      const Mask in_first = hn::RebindMask(FloatTag(), hn::Lt(index.v, hn::Set(tag, 4)));
      return hn::IfThenElse(in_first, hn::TableLookupLanes(first_, order),
                            hn::TableLookupLanes(second_, order));
    }
  }

 private:
  static constexpr std::size_t half = lane_count >= 8 ? 8 : 4;  ///< a second register only where one is short
  FloatVector first_, second_;
#endif
};

/// `number` sums at once over terms k = 0, 1, 2, ..., added a register at a time. Whatever the width of a
/// register, term k goes to partial sum k mod 16 and the partial sums are added in one order: every
/// instruction set gives the same bits.
template <int number>
class LaneSums {
 public:
  HWY_INLINE LaneSums() {
    for (Lanes(&part)[number] : parts_)
      for (Lanes& sum : part) sum = Lanes(0);
  }
  /// Terms k to k + lane_count - 1, one register for each sum. @param k  a multiple of lane_count.
  template <class... Terms>
  HWY_INLINE void add(std::size_t k, Terms... terms) {
    static_assert(sizeof...(Terms) == number, "a register for each sum");
    Lanes* sum = parts_[k / lane_count % part_count];
    ((*sum = *sum + terms, ++sum), ...);
  }
  HWY_INLINE float total(int which) const {
    Lanes parts[part_count];
    for (std::size_t p = 0; p < part_count; ++p) parts[p] = parts_[p][which];
    for (std::size_t half = part_count / 2; half > 0; half /= 2)
      for (std::size_t p = 0; p < half; ++p) parts[p] = parts[p] + parts[p + half];
    return sum_by_halves(FloatTag(), parts[0].v);
  }

 private:
  static constexpr std::size_t part_count = 16 / lane_count;

  template <class Tag>
  static HWY_INLINE float sum_by_halves(Tag tag, hn::Vec<Tag> a) {
    constexpr std::size_t lanes = hn::MaxLanes(Tag());
    if constexpr (lanes == 1) {
      return hn::GetLane(a);
    } else if constexpr (lanes == 4) {
      float lane[4];
      hn::StoreU(a, tag, lane);
      return (lane[0] + lane[2]) + (lane[1] + lane[3]);
#if HWY_TARGET != HWY_SCALAR
    } else {
      const hn::Half<Tag> half;
      return sum_by_halves(half, hn::Add(hn::LowerHalf(half, a), hn::UpperHalf(half, a)));
#endif
    }
  }

  Lanes parts_[part_count][number];
};

/// Lanes picked by a mask, to be appended to arrays.
class Selection {
 public:
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_AVX3
  HWY_INLINE explicit Selection(Mask mask) : mask_(mask), count_(hn::CountTrue(FloatTag(), mask)) {}
  HWY_INLINE FloatVector front(FloatVector a) const { return hn::Compress(a, mask_); }
  HWY_INLINE UnsignedVector front(UnsignedVector a) const {
    return hn::Compress(a, hn::RebindMask(UnsignedTag(), mask_));
  }
#else
  // Highway 1.0.3 copies its table to the stack at every Compress when built with GCC: four fifths of the
  // time.
  HWY_INLINE explicit Selection(Mask mask) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(FloatTag(), mask, bits);
    const hn::Rebind<std::uint8_t, UnsignedTag> bytes;
    order_ = hn::PromoteTo(UnsignedTag(), hn::LoadU(bytes, selected_lanes.order[bits[0]]));
    count_ = selected_lanes.count[bits[0]];
  }
  HWY_INLINE FloatVector front(FloatVector a) const {
    return hn::TableLookupLanes(a, hn::IndicesFromVec(FloatTag(), order_));
  }
  HWY_INLINE UnsignedVector front(UnsignedVector a) const {
    return hn::TableLookupLanes(a, hn::IndicesFromVec(UnsignedTag(), order_));
  }
#endif
  HWY_INLINE std::size_t count() const { return count_; }

 private:
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_AVX3
  Mask mask_;
#else
  UnsignedVector order_;
#endif
  std::size_t count_;
};

/// Appends the selected lanes to `to`, in order. Writes up to lane_count entries past them: register compress
/// plus plain store, because the compressing store is microcode on AMD processors.
HWY_INLINE void append(Lanes values, const Selection& selected, float* to) {
  hn::StoreU(selected.front(values.v), FloatTag(), to);
}
HWY_INLINE void append(UnsignedLanes values, const Selection& selected, std::uint32_t* to) {
  hn::StoreU(selected.front(values.v), UnsignedTag(), to);
}
/// Values below 2^16.
HWY_INLINE void append(UnsignedLanes values, const Selection& selected, std::uint16_t* to) {
  const hn::Rebind<std::uint16_t, SignedTag> narrow;
  hn::StoreU(hn::DemoteTo(narrow, hn::BitCast(SignedTag(), selected.front(values.v))), narrow, to);
}

/// First three fields of lane_count records in a row.
HWY_INLINE void load_consecutive(const Record* records, Lanes& x, Lanes& y, Lanes& z) {
  FloatVector w;
  hn::LoadInterleaved4(FloatTag(), &records->x, x.v, y.v, z.v, w);
}

/// Indices of the records that load_records() loads: named one by one ...
struct BeadIndices {
  const std::uint32_t* indices;
  HWY_INLINE std::uint32_t operator[](std::size_t lane) const { return indices[lane]; }
  HWY_INLINE BeadIndices from(std::size_t k) const { return {indices + k}; }
};

/// ... or by slot.
struct SlotsOfBeads {
  const std::uint16_t* slots;
  const std::uint32_t* bead_in_slot;
  HWY_INLINE std::uint32_t operator[](std::size_t lane) const { return bead_in_slot[slots[lane]]; }
  HWY_INLINE SlotsOfBeads from(std::size_t k) const { return {slots + k, bead_in_slot}; }
};

#if HWY_TARGET == HWY_SCALAR

/// One lane: nothing to transpose.
template <class Indices>
HWY_INLINE void load_records(const Record* records, Indices indices, Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  const Record& record = records[indices[0]];
  a = Lanes(record.x);
  b = Lanes(record.y);
  c = Lanes(record.z);
  d = Lanes(record.w);
}

#else

/// One register of the records at indices[0], indices[4], indices[8], ...
template <class Tag, class Indices>
HWY_INLINE hn::Vec<Tag> load_every_fourth(Tag tag, const Record* records, Indices indices, std::size_t lane) {
  if constexpr (hn::MaxLanes(Tag()) == 4) {
    return hn::Load(tag, &records[indices[lane]].x);
  } else {
    const hn::Half<Tag> half;
    return hn::Combine(tag, load_every_fourth(half, records, indices, lane + hn::MaxLanes(half)),
                       load_every_fourth(half, records, indices, lane));
  }
}

/// Loads lane_count records {a, b, c, d} and turns them into four registers of one field each. Whole loads
/// plus a transposition: about a sixth of the time of four gathers.
template <class Indices>
HWY_INLINE void load_records(const Record* records, Indices indices, Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  const FloatTag df;
  const hn::RepartitionToWide<FloatTag> dw;
  const FloatVector r0 = load_every_fourth(df, records, indices, 0);
  const FloatVector r1 = load_every_fourth(df, records, indices, 1);
  const FloatVector r2 = load_every_fourth(df, records, indices, 2);
  const FloatVector r3 = load_every_fourth(df, records, indices, 3);
  const auto ab01 = hn::BitCast(dw, hn::InterleaveLower(df, r0, r1));
  const auto ab23 = hn::BitCast(dw, hn::InterleaveLower(df, r2, r3));
  const auto cd01 = hn::BitCast(dw, hn::InterleaveUpper(df, r0, r1));
  const auto cd23 = hn::BitCast(dw, hn::InterleaveUpper(df, r2, r3));
  a = hn::BitCast(df, hn::InterleaveLower(dw, ab01, ab23));
  b = hn::BitCast(df, hn::InterleaveUpper(dw, ab01, ab23));
  c = hn::BitCast(df, hn::InterleaveLower(dw, cd01, cd23));
  d = hn::BitCast(df, hn::InterleaveUpper(dw, cd01, cd23));
}

#endif

}  // namespace dmf::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
