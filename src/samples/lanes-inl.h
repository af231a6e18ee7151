// The vectors that hold one float a ray, and small things that Highway lacks. Included once per
// instruction set.
#if defined(MOTES_SAMPLES_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_SAMPLES_LANES_INL_H_
#undef MOTES_SAMPLES_LANES_INL_H_
#else
#define MOTES_SAMPLES_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "core/inline.h"
#include "samples/samples.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// One float a ray of a packet.
using LaneTag = hn::CappedTag<float, max_lanes>;
using Lanes = hn::Vec<LaneTag>;
using LaneMask = hn::Mask<LaneTag>;
inline constexpr int num_lanes = static_cast<int>(hn::MaxLanes(LaneTag()));

/// Bit l is lane l of the mask.
template <class D>
HWY_INLINE unsigned mask_bits(D d, hn::Mask<D> mask) {
  std::uint8_t bytes[8] = {};  // Highway may write up to 8
  hn::StoreMaskBits(d, mask, bytes);
  return (bytes[0] | static_cast<unsigned>(bytes[1]) << 8) & ((1u << hn::Lanes(d)) - 1);
}

/// first, first + 1, ... Highway's own goes through memory, number by number.
HWY_INLINE hn::Vec<hn::RebindToUnsigned<LaneTag>> numbers_from(std::uint32_t first) {
  alignas(64) static constexpr std::uint32_t from_zero[max_lanes] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                                     8, 9, 10, 11, 12, 13, 14, 15};
  const hn::RebindToUnsigned<LaneTag> du;
  return hn::Add(hn::Load(du, from_zero), hn::Set(du, first));
}

/// step(0), step(1), ..., step(N - 1), unrolled before the compiler decides what is kept in
/// registers: arrays of vectors that are only indexed so need no memory.
template <std::size_t N, class Step>
HWY_INLINE void unroll(Step&& step) {
  [&]<std::size_t... n>(std::index_sequence<n...>) MOTES_INLINE HWY_ATTR {
    (step(std::integral_constant<std::size_t, n>()), ...);
  }
  (std::make_index_sequence<N>());
}

/// Something may be seen at one of a field's values.
HWY_INLINE bool may_be_seen(LaneTag d, Lanes values, const Visibility& visibility) {
  return !hn::AllFalse(d, hn::And(hn::Gt(values, hn::Set(d, visibility.above)),
                                  hn::Ne(values, hn::Set(d, visibility.hidden))));
}

/// Sets what was touched of the buffer back to zero.
inline void clear_touched(SampleBuffer& buffer) {
  const LaneTag d;
  const std::size_t floats = buffer.layout().floats_per_sample();
  int first_sample = 0;
  for (std::uint64_t& word : buffer.touched_words()) {
    float* const values = buffer.at(first_sample, 0);
    for (std::uint64_t bits = word; bits != 0; bits &= bits - 1) {
      float* const sample = values + static_cast<std::size_t>(std::countr_zero(bits)) * floats;
      hn::Store(hn::Zero(d), d, sample);
      // Most buffers have but one channel; only for more is filling worth a call.
      if (floats > hn::Lanes(d)) std::fill_n(sample, floats, 0.0f);
    }
    word = 0;
    first_sample += 64;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
