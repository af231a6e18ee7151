// Groups of 4 x 4 samples as vectors, rows one after the other. Included once per instruction set.
#if defined(MOTES_SAMPLES_SPREAD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_SAMPLES_SPREAD_INL_H_
#undef MOTES_SAMPLES_SPREAD_INL_H_
#else
#define MOTES_SAMPLES_SPREAD_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "samples/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Rows of a group of 4 x 4 samples spread over a vector: block v of the group takes, of four
/// numbers that are one a row, that of each lane's row.
HWY_INLINE Lanes spread_rows(LaneTag d, const float* rows, int v) {
  if constexpr (num_lanes == 4) {
    return hn::Set(d, rows[v]);
  } else {
    alignas(64) static constexpr std::uint8_t order[2][64] = {
        {0, 1, 2,  3,  0,  1,  2,  3,  0,  1,  2,  3,  0,  1,  2,  3,  4,  5,  6,  7, 4,  5,
         6, 7, 4,  5,  6,  7,  4,  5,  6,  7,  8,  9,  10, 11, 8,  9,  10, 11, 8,  9, 10, 11,
         8, 9, 10, 11, 12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15},
        {8,  9,  10, 11, 8,  9,  10, 11, 8,  9,  10, 11, 8,  9,  10, 11,
         12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15}};
    const hn::Repartition<std::uint8_t, LaneTag> bytes;
    const auto four = hn::BitCast(bytes, hn::LoadDup128(d, rows));
    return hn::BitCast(d, hn::TableLookupBytes(four, hn::Load(bytes, order[v])));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
