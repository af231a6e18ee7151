// Transposes small blocks of floats. Included once per instruction set.
#if defined(MOTES_SAMPLES_TRANSPOSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_SAMPLES_TRANSPOSE_INL_H_
#undef MOTES_SAMPLES_TRANSPOSE_INL_H_
#else
#define MOTES_SAMPLES_TRANSPOSE_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "samples/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// In each 128 bits four vectors become their transpose: vector j then has the j-th numbers.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void transpose_fours(D d, V& v0, V& v1, V& v2, V& v3) {
  const hn::RepartitionToWide<D> dw;
  const auto pairs = [&](V a, V b)
                         HWY_ATTR { return hn::BitCast(dw, hn::InterleaveLower(d, a, b)); };
  const auto upper_pairs = [&](V a, V b)
                               HWY_ATTR { return hn::BitCast(dw, hn::InterleaveUpper(d, a, b)); };
  const auto a = pairs(v0, v1), b = pairs(v2, v3);
  const auto c = upper_pairs(v0, v1), e = upper_pairs(v2, v3);
  v0 = hn::BitCast(d, hn::InterleaveLower(dw, a, b));
  v1 = hn::BitCast(d, hn::InterleaveUpper(dw, a, b));
  v2 = hn::BitCast(d, hn::InterleaveLower(dw, c, e));
  v3 = hn::BitCast(d, hn::InterleaveUpper(dw, c, e));
}

/// A vector's numbers, by way of registers: through memory they take longer and more loads.
template <class DU>
HWY_INLINE void extract_numbers(DU, hn::Vec<DU> numbers, std::size_t* out) {
  constexpr std::size_t lanes = hn::MaxLanes(DU());
  if constexpr (lanes > 4) {
    const hn::Half<DU> half;
    extract_numbers(half, hn::LowerHalf(half, numbers), out);
    extract_numbers(half, hn::UpperHalf(half, numbers), out + lanes / 2);
  } else {
    const auto pairs = hn::BitCast(hn::RepartitionToWide<DU>(), numbers);
    for (std::size_t i = 0; i < 2; ++i) {
      const std::uint64_t pair = hn::ExtractLane(pairs, i);
      out[2 * i] = static_cast<std::uint32_t>(pair);
      out[2 * i + 1] = pair >> 32;
    }
  }
}

/// Four floats of each lane: lane l's begin at from + offset[l], a multiple of four. Vector i gets
/// the i-th.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void load_fours(D d, const float* from, const std::size_t* offset,
                           std::array<V, 4>& out) {
  const hn::FixedTag<float, 4> four;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto part = [&](std::size_t block)
                          HWY_ATTR { return hn::Load(four, from + offset[4 * block + i]); };
    if constexpr (hn::MaxLanes(D()) == 16) {
      const hn::Half<D> half;
      out[i] =
          hn::Combine(d, hn::Combine(half, part(3), part(2)), hn::Combine(half, part(1), part(0)));
    } else if constexpr (hn::MaxLanes(D()) == 8) {
      out[i] = hn::Combine(d, part(1), part(0));
    } else {
      out[i] = part(0);
    }
  }
  transpose_fours(d, out[0], out[1], out[2], out[3]);
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
