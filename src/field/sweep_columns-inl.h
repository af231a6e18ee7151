// The sweep's second shape, for kernels of a few pixels: lanes along depth. Included once per
// instruction set.
//
// A vector of planes for each column and each row of pixels that the kernel reaches holds the same
// factors that sweep-inl.h keeps plane by plane; their product is the kernel along one pixel's ray.
#if defined(MOTES_FIELD_SWEEP_COLUMNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_SWEEP_COLUMNS_INL_H_
#undef MOTES_FIELD_SWEEP_COLUMNS_INL_H_
#else
#define MOTES_FIELD_SWEEP_COLUMNS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>

#include "field/gather-inl.h"
#include "field/sweep-inl.h"
#include "field/sweep_boxes-inl.h"
#include "samples/column_buffer.h"
#include "samples/lanes-inl.h"
#include "samples/transpose-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Pixels of a side of what a thin kernel reaches, at most.
inline constexpr int max_thin_pixels = 8;
/// Planes of a vector: not more than a thin kernel usually reaches.
using DepthTag = hn::CappedTag<float, ColumnBuffer::planes>;
using DepthLanes = hn::Vec<DepthTag>;
inline constexpr int depth_lanes = static_cast<int>(hn::MaxLanes(DepthTag()));
/// So many pixels of a thin kernel take about as long as one plane of any kernel: measured, lit.
inline constexpr float thin_pixels_per_plane = 20;

/// Planes of a batch, an element each: see AreaPlane.
struct AreaPlanes {
  alignas(64) float x[ColumnBuffer::planes], dx[ColumnBuffer::planes];
  alignas(64) float y[ColumnBuffer::planes], dy[ColumnBuffer::planes];
  alignas(64) float z[ColumnBuffer::planes];
};

/// Planes `first` to first + ColumnBuffer::planes - 1 of the slab; those beyond it are the next
/// one's.
inline AreaPlanes place_planes(const RayBounds& area, const SlabFrame& frame, int first) {
  AreaPlanes planes;
  for (int k = 0; k < ColumnBuffer::planes; ++k) {
    const AreaPlane plane = place_plane(area, frame, first + k);
    planes.x[k] = plane.x;
    planes.dx[k] = plane.dx;
    planes.y[k] = plane.y;
    planes.dy[k] = plane.dy;
    planes.z[k] = plane.z;
  }
  return planes;
}

/// What grows evenly with depth, which is relative to the frame.
struct LinearInDepth {
  float at_zero, per_depth;
  HWY_INLINE Lanes at(LaneTag d, Lanes z) const {
    return hn::MulAdd(z, hn::Set(d, per_depth), hn::Set(d, at_zero));
  }
};

/// The area's columns of pixels, or its rows, at any depth of a slab: the place of the first and
/// the distance to the next, which is negative for rows. `steepest`: the most that a ray of the
/// image moves across them, per depth.
struct PixelLines {
  LinearInDepth first, step;
  float steepest;
};

struct AreaPixels {
  PixelLines columns, rows;
};

/// `in_image`: bounds of those of the area's rays that are the image's.
inline AreaPixels place_pixels(const RayBounds& area, const RayBounds& in_image,
                               const SlabFrame& frame) {
  const auto linear = [&](double origin, double direction, double reference) {
    return LinearInDepth{static_cast<float>(origin + frame.reference_depth * direction - reference),
                         static_cast<float>(direction)};
  };
  constexpr double steps = AreaBuffer::size - 1;
  const auto lines = [&](double origin, double direction, double last_origin, double last_direction,
                         double reference, const Range& slopes) {
    return PixelLines{
        linear(origin, direction, reference),
        linear((last_origin - origin) / steps, (last_direction - direction) / steps, 0),
        static_cast<float>(std::max(std::abs(slopes.low), std::abs(slopes.high)))};
  };
  return {lines(area.origin_x.low, area.direction_x.low, area.origin_x.high, area.direction_x.high,
                frame.reference_x, in_image.direction_x),
          lines(area.origin_y.high, area.direction_y.high, area.origin_y.low, area.direction_y.low,
                frame.reference_y, in_image.direction_y)};
}

/// Parts of supports that lie `from` or more before their centres, or behind.
struct SupportParts {
  Lanes radius, from;
  Lanes disc;  ///< radius of the widest disc of a part, `from` away from the centre

  /// How far from its centre rays of up to that slope may pass in it, across the view.
  HWY_INLINE Lanes reach(LaneTag d, float slope) const {
    const float length = std::sqrt(1 + slope * slope);
    const LaneMask widest = hn::Le(from, hn::Mul(radius, hn::Set(d, slope / length)));
    return hn::IfThenElse(widest, hn::Mul(radius, hn::Set(d, length)),
                          hn::MulAdd(from, hn::Set(d, slope), disc));
  }
};

/// How many kernels of either shape may reach a slab.
struct ShapeCounts {
  std::size_t thin = 0, others = 0;
};

/// Tells thin kernels from others: they cover few pixels, and pixel by pixel cost less than plane
/// by plane. Sets support_sq of either shape.
HWY_NOINLINE ShapeCounts find_thin_kernels(const AreaPixels& pixels, const SlabFrame& frame,
                                           GatheredKernels& gathered) {
  const LaneTag d;
  const Lanes near = hn::Set(d, frame.first_depth), per_step = hn::Set(d, 1 / frame.step);
  const Lanes far =
      hn::MulAdd(hn::Set(d, static_cast<float>(frame.count - 1)), hn::Set(d, frame.step), near);
  const Lanes one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f), none = hn::Set(d, -1.0f);
  const Lanes most = hn::Set(d, max_thin_pixels - 0.02f);  // room for rounding
  ShapeCounts counts;
  for (std::size_t i = 0; i < gathered.size; i += num_lanes) {
    const Lanes support_sq = hn::Load(d, &gathered.support_sq[i]);
    const LaneMask there = hn::Ge(support_sq, hn::Zero(d));
    const Lanes z = hn::Load(d, &gathered.z[i]);
    SupportParts whole;
    whole.radius = hn::Sqrt(hn::Max(support_sq, hn::Zero(d)));
    whole.from = hn::Zero(d);
    whole.disc = whole.radius;
    const Lanes dx = pixels.columns.step.at(d, z), dy = hn::Neg(pixels.rows.step.at(d, z));
    const Lanes width = hn::Mul(two, whole.reach(d, pixels.columns.steepest));
    const Lanes height = hn::Mul(two, whole.reach(d, pixels.rows.steepest));
    const LaneMask fits =
        hn::And(hn::Le(width, hn::Mul(most, dx)), hn::Le(height, hn::Mul(most, dy)));
    const Lanes depth =
        hn::Sub(hn::Min(hn::Add(z, whole.radius), far), hn::Max(hn::Sub(z, whole.radius), near));
    const Lanes num_planes = hn::MulAdd(depth, per_step, one);
    const Lanes vectors = hn::MulAdd(num_planes, hn::Set(d, 1.0f / depth_lanes), one);
    const Lanes num_pixels = hn::Div(hn::Mul(width, height), hn::Mul(dx, dy));
    const LaneMask pays = hn::Le(hn::Mul(num_pixels, vectors),
                                 hn::Mul(num_planes, hn::Set(d, thin_pixels_per_plane)));
    const LaneMask thin = hn::And(there, hn::And(fits, pays));
    hn::Store(hn::IfThenElse(thin, none, support_sq), d, &gathered.plane_support_sq[i]);
    hn::Store(hn::IfThenElse(thin, support_sq, none), d, &gathered.thin_support_sq[i]);
    counts.thin += hn::CountTrue(d, thin);
    counts.others += hn::CountTrue(d, hn::AndNot(thin, there));
  }
  return counts;
}

/// Thin kernels by their boxes' columns and rows.
using ThinKernels = SortedKernels<std::size_t{max_thin_pixels * max_thin_pixels}>;

/// First and last pixel of the area along an axis that kernels may reach; `any`: there are such.
struct PixelSpan {
  Lanes first, last;
  LaneMask any;
};

/// Those within `reach` of centres at `center` across the pixels' lines and at depth z.
HWY_INLINE PixelSpan pixel_span(LaneTag d, const PixelLines& lines, Lanes center, Lanes z,
                                Lanes reach) {
  const Lanes per_step = hn::Div(hn::Set(d, 1.0f), lines.step.at(d, z));
  const Lanes middle = hn::Mul(hn::Sub(center, lines.first.at(d, z)), per_step);
  const Lanes half = hn::MulAdd(reach, hn::Abs(per_step), hn::Set(d, 1e-3f));
  const Lanes end = hn::Set(d, static_cast<float>(AreaBuffer::size - 1));
  const Lanes first = hn::Max(hn::Zero(d), hn::Ceil(hn::Sub(middle, half)));
  const Lanes last = hn::Min(end, hn::Floor(hn::Add(middle, half)));
  return {first, last, hn::Le(first, last)};
}

/// Finds the pixels that thin kernels reach in each vector of the planes.
HWY_NOINLINE void find_pixels(const AreaPixels& pixels, const AreaPlanes& planes,
                              const GatheredKernels& gathered, ThinKernels& out) {
  const LaneTag d;
  const hn::RebindToSigned<LaneTag> di;
  const hn::RebindToUnsigned<LaneTag> du;
  out.clear();
  out.reserve(gathered.size * std::size_t{ColumnBuffer::planes / depth_lanes});
  const auto whole = [&](Lanes v) HWY_ATTR { return hn::BitCast(du, hn::ConvertTo(di, v)); };
  const Lanes rounding = hn::Set(d, 1e-3f * (planes.z[1] - planes.z[0]));
  for (std::size_t i = 0; i < gathered.size; i += num_lanes) {
    const Lanes support_sq = hn::Load(d, &gathered.thin_support_sq[i]);
    const Lanes z = hn::Load(d, &gathered.z[i]);
    for (int v = 0; v < ColumnBuffer::planes; v += depth_lanes) {
      const Lanes before = hn::Sub(hn::Set(d, planes.z[v]), z);
      const Lanes behind = hn::Sub(z, hn::Set(d, planes.z[v + depth_lanes - 1]));
      SupportParts parts;
      parts.from = hn::Max(hn::Zero(d), hn::Sub(hn::Max(before, behind), rounding));
      const Lanes disc_sq = hn::NegMulAdd(parts.from, parts.from, support_sq);
      const LaneMask reaches = hn::Gt(disc_sq, hn::Zero(d));
      if (hn::AllFalse(d, reaches)) continue;
      parts.radius = hn::Sqrt(hn::Max(support_sq, hn::Zero(d)));
      parts.disc = hn::Sqrt(hn::Max(disc_sq, hn::Zero(d)));
      const PixelSpan columns = pixel_span(d, pixels.columns, hn::Load(d, &gathered.x[i]), z,
                                           parts.reach(d, pixels.columns.steepest));
      const PixelSpan rows = pixel_span(d, pixels.rows, hn::Load(d, &gathered.y[i]), z,
                                        parts.reach(d, pixels.rows.steepest));
      const auto column = whole(columns.first), last_column = whole(columns.last);
      const auto row = whole(rows.first), last_row = whole(rows.last);
      const LaneMask in_area = hn::And(reaches, hn::And(columns.any, rows.any));
      const auto key = hn::Add(hn::Mul(hn::Sub(last_column, column), hn::Set(du, max_thin_pixels)),
                               hn::Sub(last_row, row));
      out.append(d, in_area, key, numbers_from(static_cast<std::uint32_t>(i)),
                 hn::Set(du, static_cast<std::uint32_t>(v)),
                 box_of(column, row, last_column, last_row));
    }
  }
  out.sort();
}

/// A thin kernel's factors in a vector of planes, one for each column and row of its box.
template <int kColumns, class C>
struct DepthFactors {
  alignas(64) float column[kColumns][depth_lanes], row[max_thin_pixels][depth_lanes];
  // Without gradients nothing is written here.
  alignas(64) float column_slope[kColumns][depth_lanes], row_slope[max_thin_pixels][depth_lanes];
  alignas(64) float slope_z[depth_lanes];

  HWY_INLINE void fill(DepthTag d, const GatheredKernels& gathered, const AreaPlanes& planes,
                       const BoxedKernel& kernel) {
    const std::size_t k = kernel.kernel, first = kernel.plane;
    const DepthLanes scale = hn::Set(d, gathered.exponent_scale[k]);
    const DepthLanes peak = hn::Set(d, gathered.peak[k]);
    const DepthLanes slope = hn::Mul(scale, hn::Set(d, 2 / std::numbers::log2e_v<float>));
    const DepthLanes dz = hn::Sub(hn::Load(d, planes.z + first), hn::Set(d, gathered.z[k]));
    const DepthLanes dz_sq = hn::Mul(dz, dz);
    if constexpr (C::gradients) hn::Store(hn::Mul(dz, slope), d, slope_z);
    // Places of the box's pixels, one after the other.
    const auto place = [&](const float* places, const float* spacings, float center,
                           int pixel) MOTES_INLINE HWY_ATTR {
      const DepthLanes from_first = hn::Sub(hn::Load(d, places + first), hn::Set(d, center));
      return hn::MulAdd(hn::Set(d, static_cast<float>(pixel)), hn::Load(d, spacings + first),
                        from_first);
    };
    for (int i = 0; i < kColumns; ++i) {
      const DepthLanes x = place(planes.x, planes.dx, gathered.x[k], kernel.box.column + i);
      hn::Store(hn::Mul(peak, factor_of(d, hn::Mul(scale, hn::Mul(x, x)))), d, column[i]);
      if constexpr (C::gradients) hn::Store(hn::Mul(x, slope), d, column_slope[i]);
    }
    for (int i = 0; i < kernel.box.rows(); ++i) {
      const DepthLanes y = place(planes.y, planes.dy, gathered.y[k], kernel.box.row + i);
      hn::Store(factor_of(d, hn::Mul(scale, hn::MulAdd(y, y, dz_sq))), d, row[i]);
      if constexpr (C::gradients) hn::Store(hn::Mul(y, slope), d, row_slope[i]);
    }
  }
};

/// Marks the groups of a thin kernel's box; false if no ray is under way in them.
HWY_INLINE bool touch_groups(const BoxedKernel& kernel, const LiveGroups& live,
                             ColumnBuffer& buffer) {
  const KernelBox& box = kernel.box;
  const int first_row = box.row / AreaBuffer::group_size;
  const int last_row = box.last_row / AreaBuffer::group_size;
  const GroupBits groups = (2u << box.last_column / AreaBuffer::group_size) -
                           (1u << box.column / AreaBuffer::group_size);
  static_assert(max_thin_pixels <= 2 * AreaBuffer::group_size);
  const int middle_row = (first_row + last_row) / 2;  // so at most three, without a loop
  if (((live.row(first_row) | live.row(middle_row) | live.row(last_row)) & groups) == 0) {
    return false;
  }
  for (const int row : {first_row, middle_row, last_row}) buffer.touched(row) |= groups;
  return true;
}

/// Where thin kernels are added.
struct ColumnSamples {
  const AreaPlanes& planes;
  const LiveGroups& live;
  std::size_t field_floats;  ///< from a field of a pixel to the next
  ColumnBuffer& buffer;
};

/// Some thin kernels with their factors: worked out for all before the first is added, they do not
/// wait for each other.
template <int kColumns, class C>
struct ThinBatch {
  static constexpr std::size_t most = 8;
  struct Member {
    float* samples;  ///< of the box's first pixel: the field's channel 0
    int rows;
    float cut;
    DepthFactors<kColumns, C> factors;
  };
  Member members[most];
  std::size_t count = 0;

  /// Takes the next ones of `list`, but those without rays under way.
  HWY_INLINE void fill(DepthTag d, const GatheredKernels& gathered, const ColumnSamples& samples,
                       std::span<const BoxedKernel>& list) {
    count = 0;
    for (; !list.empty() && count < most; list = list.subspan(1)) {
      const BoxedKernel& kernel = list[0];
      if (!touch_groups(kernel, samples.live, samples.buffer)) continue;
      Member& out = members[count++];
      out.samples = samples.buffer.at(kernel.box.row, kernel.box.column) + kernel.plane +
                    gathered.field[kernel.kernel] * samples.field_floats;
      out.rows = kernel.box.rows();
      out.cut = gathered.cut[kernel.kernel];
      out.factors.fill(d, gathered, samples.planes, kernel);
    }
  }
};

/// Adds thin kernels whose boxes have kColumns columns.
template <int kColumns, class C>
HWY_NOINLINE void add_thin_kernels(const GatheredKernels& gathered,
                                   std::span<const BoxedKernel> list, const ColumnSamples& samples,
                                   EvaluationCounts& counts) {
  const DepthTag d;
  const std::size_t pixel_floats = samples.buffer.pixel_floats();
  const std::size_t row_floats = samples.buffer.row_floats();
  ThinBatch<kColumns, C> batch;
  while (!list.empty()) {
    batch.fill(d, gathered, samples, list);
    for (std::size_t n = 0; n < batch.count; ++n) {
      const auto& kernel = batch.members[n];
      const DepthFactors<kColumns, C>& factors = kernel.factors;
      // What pixels have in common is kept in registers, which the compiler could not do by itself:
      // factors might be among the samples.
      const DepthLanes cut = hn::Set(d, kernel.cut);
      GradientSlopes<DepthLanes> slopes{cut, cut, cut};
      if constexpr (C::gradients) slopes.z = hn::Load(d, factors.slope_z);
      float* first = kernel.samples;
      for (int j = 0; j < kernel.rows; ++j, first += row_floats) {
        const DepthLanes row = hn::Load(d, factors.row[j]);
        if constexpr (C::gradients) slopes.y = hn::Load(d, factors.row_slope[j]);
        float* pixel = first;
        unroll<kColumns>([&](std::size_t i) MOTES_INLINE HWY_ATTR {
          if constexpr (C::gradients) slopes.x = hn::Load(d, factors.column_slope[i]);
          counts.inside_support +=
              add_to_samples<C>(d, hn::Mul(row, hn::Load(d, factors.column[i])), cut, slopes, pixel,
                                ColumnBuffer::planes);
          pixel += pixel_floats;
        });
      }
      counts.carried_out += static_cast<std::uint64_t>(kernel.rows) * kColumns * depth_lanes;
    }
  }
}

/// Adds thin kernels.
template <class C>
void sum_columns(const GatheredKernels& gathered, const ThinKernels& kernels,
                 const ColumnSamples& samples, EvaluationCounts& counts) {
  unroll<max_thin_pixels>([&](auto i) HWY_ATTR {
    const std::size_t first = i * max_thin_pixels;
    add_thin_kernels<i + 1, C>(gathered, kernels.with_keys(first, first + max_thin_pixels), samples,
                               counts);
  });
}

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
