// Transposes small blocks of floats. Included once per instruction set.
#if defined(MOTES_SAMPLES_TRANSPOSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_SAMPLES_TRANSPOSE_INL_H_
#undef MOTES_SAMPLES_TRANSPOSE_INL_H_
#else
#define MOTES_SAMPLES_TRANSPOSE_INL_H_
#endif

#include <hwy/highway.h>

#include "samples/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// In each 128 bits four vectors become their transpose: vector j then has the j-th numbers.
HWY_INLINE void transpose_fours(LaneTag d, Lanes& v0, Lanes& v1, Lanes& v2, Lanes& v3) {
  const hn::RepartitionToWide<LaneTag> dw;
  const auto pairs = [&](Lanes a, Lanes b)
                         HWY_ATTR { return hn::BitCast(dw, hn::InterleaveLower(d, a, b)); };
  const auto upper_pairs = [&](Lanes a, Lanes b)
                               HWY_ATTR { return hn::BitCast(dw, hn::InterleaveUpper(d, a, b)); };
  const auto a = pairs(v0, v1), b = pairs(v2, v3);
  const auto c = upper_pairs(v0, v1), e = upper_pairs(v2, v3);
  v0 = hn::BitCast(d, hn::InterleaveLower(dw, a, b));
  v1 = hn::BitCast(d, hn::InterleaveUpper(dw, a, b));
  v2 = hn::BitCast(d, hn::InterleaveLower(dw, c, e));
  v3 = hn::BitCast(d, hn::InterleaveUpper(dw, c, e));
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
