// What thin kernels have left in the column buffer, taken for pass 2 group by group: transposed,
// and together with what the other kernels left in the area buffer. Included once per instruction
// set.
#if defined(MOTES_FIELD_TAKE_COLUMNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_TAKE_COLUMNS_INL_H_
#undef MOTES_FIELD_TAKE_COLUMNS_INL_H_
#else
#define MOTES_FIELD_TAKE_COLUMNS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "field/sweep-inl.h"
#include "field/sweep_columns-inl.h"
#include "samples/area_buffer.h"
#include "samples/column_buffer.h"
#include "samples/lanes-inl.h"
#include "samples/transpose-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// The planes of a batch of one block of pixels: a vector each.
struct BatchOfBlock {
  Lanes plane[ColumnBuffer::planes];
};

/// Takes a channel of a block from `in`, its first pixel's, where zeros are left.
HWY_INLINE BatchOfBlock take_channel(LaneTag d, float* in, std::size_t pixel_floats,
                                     std::size_t row_floats) {
  constexpr int size = AreaBuffer::group_size;
  const auto take = [&](auto tag, std::size_t pixel, std::size_t plane) MOTES_INLINE HWY_ATTR {
    float* const at = in + pixel / size * row_floats + pixel % size * pixel_floats + plane;
    const auto values = hn::Load(tag, at);
    hn::Store(hn::Zero(tag), tag, at);
    return values;
  };
  BatchOfBlock out;
#if HWY_TARGET <= HWY_AVX3
  static_assert(num_lanes == 2 * ColumnBuffer::planes);
  const hn::Half<LaneTag> dh;
  // Two pixels a vector, one of an even row of the group and that below it.
  Lanes v[8];
  unroll<8>([&](std::size_t i) MOTES_INLINE HWY_ATTR {
    const std::size_t pixel = i % 4 + i / 4 * 8;
    const auto upper = take(dh, pixel, 0), lower = take(dh, pixel + 4, 0);
    v[i] = hn::Combine(d, lower, upper);
  });
  transpose_fours(d, v[0], v[1], v[2], v[3]);
  transpose_fours(d, v[4], v[5], v[6], v[7]);
  // Vector j now has planes j and 4 + j of row 0, then of row 1; vector 4 + j of rows 2 and 3.
  unroll<4>([&](std::size_t j) MOTES_INLINE HWY_ATTR {
    constexpr int even = _MM_SHUFFLE(2, 0, 2, 0), odd = _MM_SHUFFLE(3, 1, 3, 1);
    // All lanes under a mask: without, the compiler warns of the intrinsic's own.
    constexpr __mmask16 all = 0xffff;
    out.plane[j] = Lanes{_mm512_maskz_shuffle_f32x4(all, v[j].raw, v[4 + j].raw, even)};
    out.plane[4 + j] = Lanes{_mm512_maskz_shuffle_f32x4(all, v[j].raw, v[4 + j].raw, odd)};
  });
#elif HWY_TARGET <= HWY_AVX2
  static_assert(num_lanes == ColumnBuffer::planes);
  Lanes v[num_lanes];
  unroll<num_lanes>([&](std::size_t i) MOTES_INLINE HWY_ATTR { v[i] = take(d, i, 0); });
  transpose_fours(d, v[0], v[1], v[2], v[3]);
  transpose_fours(d, v[4], v[5], v[6], v[7]);
  // Vector j now has planes j and 4 + j of row 0; vector 4 + j of row 1.
  unroll<4>([&](std::size_t j) MOTES_INLINE HWY_ATTR {
    out.plane[j] = hn::ConcatLowerLower(d, v[4 + j], v[j]);
    out.plane[4 + j] = hn::ConcatUpperUpper(d, v[4 + j], v[j]);
  });
#else
  for (std::size_t plane = 0; plane < ColumnBuffer::planes; plane += num_lanes) {
    Lanes v[num_lanes];
    for (std::size_t i = 0; i < num_lanes; ++i) v[i] = take(d, i, plane);
    transpose_fours(d, v[0], v[1], v[2], v[3]);
    for (std::size_t j = 0; j < num_lanes; ++j) out.plane[plane + j] = v[j];
  }
#endif
  return out;
}

/// A group of an area on the planes of a batch, while it is taken from where it was summed.
struct GroupSamples {
  ColumnBuffer& columns;
  AreaBuffer& area;
  int row, column;
  float* out;  ///< laid out like a group of `area`

  float* first_pixel(int block) const {
    constexpr int size = AreaBuffer::group_size;
    return columns.at(size * row + block * block_rows, size * column);
  }
};

/// Takes a channel of a block of the group from the columns, adds what the area holds of it on
/// planes `summed`, and writes both.
HWY_INLINE BatchOfBlock take_block(LaneTag d, const GroupSamples& group, int block, int channel,
                                   AreaBuffer::PlaneBits summed) {
  const AreaBuffer& area = group.area;
  const std::size_t at = static_cast<std::size_t>(block) * area.block_floats() +
                         static_cast<std::size_t>(channel * num_lanes);
  BatchOfBlock batch = take_channel(d, group.first_pixel(block) + channel * ColumnBuffer::planes,
                                    group.columns.pixel_floats(), group.columns.row_floats());
  if (HWY_UNLIKELY(summed != 0)) {
    const float* const sums = group.area.at(group.row, group.column) + at;
    for (std::size_t k = 0; k < ColumnBuffer::planes; ++k) {
      if ((summed >> k & 1) == 0) continue;
      batch.plane[k] = hn::Add(batch.plane[k], hn::Load(d, sums + k * area.plane_floats()));
    }
  }
  float* out = group.out + at;
  unroll<ColumnBuffer::planes>([&](std::size_t k) MOTES_INLINE HWY_ATTR {
    hn::Store(batch.plane[k], d, out);
    out += area.plane_floats();
  });
  return batch;
}

/// The same for a field's values, channel `channel`: bit k tells that plane k may be seen.
HWY_NOINLINE std::uint64_t take_values(const GroupSamples& group, int block, int channel,
                                       AreaBuffer::PlaneBits summed, const Visibility& visibility) {
  const LaneTag d;
  const BatchOfBlock batch = take_block(d, group, block, channel, summed);
  std::uint64_t visible = 0;
  unroll<ColumnBuffer::planes>([&](std::size_t k) MOTES_INLINE HWY_ATTR {
    visible |= std::uint64_t{may_be_seen(d, batch.plane[k], visibility)} << k;
  });
  return visible;
}

/// The same for channels `first` to last - 1, of all blocks.
HWY_NOINLINE void take_channels(const GroupSamples& group, int first, int last,
                                AreaBuffer::PlaneBits summed) {
  for (int block = 0; block < group_blocks; ++block) {
    for (int c = first; c < last; ++c) take_block(LaneTag(), group, block, c, summed);
  }
}

/// Sets channels `first` to last - 1 of a group to zero in the columns.
HWY_NOINLINE void drop_channels(const GroupSamples& group, int first, int last) {
  const DepthTag d;
  constexpr int size = AreaBuffer::group_size;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      float* const at = group.columns.at(size * group.row + y, size * group.column + x);
      for (int i = first * ColumnBuffer::planes; i < last * ColumnBuffer::planes;
           i += depth_lanes) {
        hn::Store(hn::Zero(d), d, at + i);
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
