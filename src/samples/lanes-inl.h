// The vectors that hold one float a ray, and small things that Highway lacks. Included once per
// instruction set.
#if defined(MOTES_SAMPLES_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_SAMPLES_LANES_INL_H_
#undef MOTES_SAMPLES_LANES_INL_H_
#else
#define MOTES_SAMPLES_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "samples/samples.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// One float a ray of a packet.
using LaneTag = hn::CappedTag<float, max_lanes>;
using Lanes = hn::Vec<LaneTag>;
using LaneMask = hn::Mask<LaneTag>;

/// Bit l is lane l of the mask.
template <class D>
HWY_INLINE unsigned mask_bits(D d, hn::Mask<D> mask) {
  std::uint8_t bytes[8] = {};  // Highway may write up to 8
  hn::StoreMaskBits(d, mask, bytes);
  return (bytes[0] | static_cast<unsigned>(bytes[1]) << 8) & ((1u << hn::Lanes(d)) - 1);
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
