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
HWY_INLINE Lanes square_root(Lanes a) { return hn::Sqrt(a.v); }
HWY_INLINE Lanes nearest_integer(Lanes a) { return hn::Round(a.v); }
HWY_INLINE Mask operator<(Lanes a, Lanes b) { return hn::Lt(a.v, b.v); }
HWY_INLINE Lanes zero_unless(Mask mask, Lanes a) { return hn::IfThenElseZero(mask, a.v); }
HWY_INLINE float sum(Lanes a) { return hn::GetLane(hn::SumOfLanes(FloatTag(), a.v)); }
HWY_INLINE Mask first_lanes(std::size_t count) { return hn::FirstN(FloatTag(), count); }
HWY_INLINE Mask both(Mask a, Mask b) { return hn::And(a, b); }
HWY_INLINE std::size_t count(Mask mask) { return hn::CountTrue(FloatTag(), mask); }
HWY_INLINE Lanes load_lanes(const float* from) { return hn::LoadU(FloatTag(), from); }

struct UnsignedLanes {
  UnsignedVector v;
  UnsignedLanes() = default;
  HWY_INLINE UnsignedLanes(UnsignedVector vector) : v(vector) {}  // NOLINT
  HWY_INLINE explicit UnsignedLanes(std::uint32_t value) : v(hn::Set(UnsignedTag(), value)) {}
};
HWY_INLINE UnsignedLanes operator+(UnsignedLanes a, UnsignedLanes b) { return hn::Add(a.v, b.v); }
HWY_INLINE UnsignedLanes operator*(UnsignedLanes a, UnsignedLanes b) { return hn::Mul(a.v, b.v); }
HWY_INLINE UnsignedLanes operator^(UnsignedLanes a, UnsignedLanes b) { return hn::Xor(a.v, b.v); }
HWY_INLINE UnsignedLanes operator>>(UnsignedLanes a, int bits) { return hn::ShiftRightSame(a.v, bits); }
HWY_INLINE UnsignedLanes bits_of(Lanes a) { return hn::BitCast(UnsignedTag(), a.v); }
HWY_INLINE UnsignedLanes load_lanes(const std::uint32_t* from) { return hn::LoadU(UnsignedTag(), from); }
HWY_INLINE Mask different(UnsignedLanes a, UnsignedLanes b) {
  return hn::RebindMask(FloatTag(), hn::Ne(a.v, b.v));
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

#if HWY_TARGET == HWY_SCALAR

/// One lane: nothing to transpose.
HWY_INLINE void load_records(const void* records, const std::uint32_t* offsets, Lanes& a, Lanes& b, Lanes& c,
                             Lanes& d) {
  const float* record = reinterpret_cast<const float*>(static_cast<const char*>(records) + offsets[0]);
  a = Lanes(record[0]);
  b = Lanes(record[1]);
  c = Lanes(record[2]);
  d = Lanes(record[3]);
}
HWY_INLINE std::size_t append(UnsignedLanes values, Mask mask, std::uint32_t* to) {
  *to = hn::GetLane(values.v);
  return count(mask);
}

#else

/// Appends the lanes in the mask to `to`, in order; writes up to lane_count entries past it.
/// @returns the number appended.
HWY_INLINE std::size_t append(UnsignedLanes values, Mask mask, std::uint32_t* to) {
  if constexpr (lane_count <= 8) {
    // Highway 1.0.3 copies its table to the stack at every Compress when built with GCC: four fifths of the
    // time.
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(FloatTag(), mask, bits);
    const hn::Rebind<std::uint8_t, UnsignedTag> bytes;
    const auto order = hn::PromoteTo(UnsignedTag(), hn::LoadU(bytes, selected_lanes.order[bits[0]]));
    hn::StoreU(hn::TableLookupLanes(values.v, hn::IndicesFromVec(UnsignedTag(), order)), UnsignedTag(), to);
    return selected_lanes.count[bits[0]];
  } else {
    // Register compress plus plain store: the compressing store is microcode on AMD processors.
    const auto selected = hn::RebindMask(UnsignedTag(), mask);
    hn::StoreU(hn::Compress(values.v, selected), UnsignedTag(), to);
    return hn::CountTrue(UnsignedTag(), selected);
  }
}

/// One register of the records (16 bytes each) at byte offsets offsets[0], offsets[4], offsets[8], ...
template <class Tag>
HWY_INLINE hn::Vec<Tag> load_every_fourth(Tag tag, const char* records, const std::uint32_t* offsets) {
  if constexpr (hn::MaxLanes(Tag()) == 4) {
    return hn::LoadU(tag, reinterpret_cast<const float*>(records + offsets[0]));
  } else {
    const hn::Half<Tag> half;
    return hn::Combine(tag, load_every_fourth(half, records, offsets + hn::MaxLanes(half)),
                       load_every_fourth(half, records, offsets));
  }
}

/// Loads lane_count records {a, b, c, d} of 16 bytes and turns them into four registers of one field each.
/// Whole loads plus a transposition: about a sixth of the time of four gathers.
HWY_INLINE void load_records(const void* records, const std::uint32_t* offsets, Lanes& a, Lanes& b, Lanes& c,
                             Lanes& d) {
  const char* base = static_cast<const char*>(records);
  const FloatTag df;
  const hn::RepartitionToWide<FloatTag> dw;
  const FloatVector r0 = load_every_fourth(df, base, offsets);
  const FloatVector r1 = load_every_fourth(df, base, offsets + 1);
  const FloatVector r2 = load_every_fourth(df, base, offsets + 2);
  const FloatVector r3 = load_every_fourth(df, base, offsets + 3);
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
