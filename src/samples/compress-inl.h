// Moves the lanes of a mask to the front of vectors. Included once per instruction set.
#if defined(MOTES_SAMPLES_COMPRESS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_SAMPLES_COMPRESS_INL_H_
#undef MOTES_SAMPLES_COMPRESS_INL_H_
#else
#define MOTES_SAMPLES_COMPRESS_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "samples/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

#if HWY_TARGET <= HWY_AVX3

/// The lanes of a mask, to be moved to the front of some vectors.
class FrontLanes {
 public:
  HWY_INLINE FrontLanes(LaneTag d, LaneMask which)
      : which_(which), count_(hn::CountTrue(d, which)) {}

  std::size_t count() const { return count_; }

  /// Those lanes of `values` one after the other, and whatever behind them, to `to`: a whole
  /// vector.
  template <class T, class V>
  HWY_INLINE void store(V values, T* to) const {
    const hn::Rebind<T, LaneTag> d;
    hn::StoreU(hn::Compress(values, hn::RebindMask(d, which_)), d, to);
  }

 private:
  LaneMask which_;
  std::size_t count_;
};

#else

/// For each mask the numbers of its lanes, one after the other, in four bits each.
inline constexpr auto front_lanes = [] {
  std::array<std::uint32_t, std::size_t{1} << num_lanes> table{};
  for (std::uint32_t bits = 0; bits < table.size(); ++bits) {
    int at = 0;
    for (std::uint32_t lane = 0; lane < num_lanes; ++lane) {
      if (bits >> lane & 1) table[bits] |= lane << 4 * at++;
    }
  }
  return table;
}();

/// The lanes of a mask, to be moved to the front of some vectors. Highway's own Compress() copies
/// its table at every call (with GCC), and works the order out anew.
class FrontLanes {
 public:
  HWY_INLINE FrontLanes(LaneTag d, LaneMask which) {
    const hn::RebindToUnsigned<LaneTag> du;
    const unsigned bits = mask_bits(d, which);
    count_ = static_cast<std::size_t>(std::popcount(bits));
    alignas(32) static constexpr std::uint32_t place[8] = {0, 4, 8, 12, 16, 20, 24, 28};
    const auto numbers = hn::Shr(hn::Set(du, front_lanes[bits]), hn::Load(du, place));
    order_ = hn::IndicesFromVec(d, hn::And(numbers, hn::Set(du, num_lanes - 1)));
  }

  std::size_t count() const { return count_; }

  /// Those lanes of `values` one after the other, and whatever behind them, to `to`: a whole
  /// vector.
  template <class T, class V>
  HWY_INLINE void store(V values, T* to) const {
    const LaneTag d;
    const auto moved = hn::TableLookupLanes(hn::BitCast(d, values), order_);
    const hn::Rebind<T, LaneTag> dt;
    hn::StoreU(hn::BitCast(dt, moved), dt, to);
  }

 private:
  decltype(hn::IndicesFromVec(LaneTag(), hn::Zero(hn::RebindToUnsigned<LaneTag>()))) order_;
  std::size_t count_;
};

#endif

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
