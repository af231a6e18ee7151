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

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "field/area_pixels.h"
#include "field/gather-inl.h"
#include "field/sweep-inl.h"
#include "field/sweep_boxes-inl.h"
#include "samples/column_buffer.h"
#include "samples/lanes-inl.h"

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
inline AreaPlanes place_planes(const AreaPixels& pixels, const SlabFrame& frame, int first) {
  AreaPlanes planes;
  for (int k = 0; k < ColumnBuffer::planes; ++k) {
    const AreaPlane plane = place_plane(pixels, frame, first + k);
    planes.x[k] = plane.x;
    planes.dx[k] = plane.dx;
    planes.y[k] = plane.y;
    planes.dy[k] = plane.dy;
    planes.z[k] = plane.z;
  }
  return planes;
}

HWY_INLINE Lanes at_depth(LaneTag d, const LinearInDepth& line, Lanes z) {
  return hn::MulAdd(z, hn::Set(d, static_cast<float>(line.per_depth)),
                    hn::Set(d, static_cast<float>(line.at_zero)));
}

/// Parts of supports that lie `from` or more before their centres, or behind.
struct SupportParts {
  Lanes radius, from;
  Lanes disc;  ///< radius of the widest disc of a part, `from` away from the centre

  /// How far from its centre rays of up to that slope may pass in it, across the view.
  HWY_INLINE Lanes reach(LaneTag d, double steepest) const {
    const auto slope = static_cast<float>(steepest);
    const float length = std::sqrt(1 + slope * slope);
    const LaneMask widest = hn::Le(from, hn::Mul(radius, hn::Set(d, slope / length)));
    return hn::IfThenElse(widest, hn::Mul(radius, hn::Set(d, length)),
                          hn::MulAdd(from, hn::Set(d, slope), disc));
  }
};

/// Tells thin kernels from others: they cover few pixels, and pixel by pixel cost less than plane
/// by plane. Sets support_sq of either.
HWY_NOINLINE void find_thin_kernels(const AreaPixels& pixels, const SlabFrame& frame,
                                    GatheredKernels& gathered) {
  const LaneTag d;
  const Lanes near = hn::Set(d, frame.first_depth), per_step = hn::Set(d, 1 / frame.step);
  const Lanes far =
      hn::MulAdd(hn::Set(d, static_cast<float>(frame.count - 1)), hn::Set(d, frame.step), near);
  const Lanes one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f), none = hn::Set(d, -1.0f);
  const Lanes most = hn::Set(d, max_thin_pixels - 0.02f);  // room for rounding
  gathered.num_thin = gathered.num_others = 0;
  for (std::size_t i = 0; i < gathered.size; i += num_lanes) {
    const Lanes support_sq = hn::Load(d, &gathered.support_sq[i]);
    const LaneMask there = hn::Ge(support_sq, hn::Zero(d));
    const Lanes z = hn::Load(d, &gathered.z[i]);
    SupportParts whole;
    whole.radius = hn::Sqrt(hn::Max(support_sq, hn::Zero(d)));
    whole.from = hn::Zero(d);
    whole.disc = whole.radius;
    const Lanes dx = at_depth(d, pixels.columns.step, z);
    const Lanes dy = hn::Neg(at_depth(d, pixels.rows.step, z));
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
    gathered.num_thin += hn::CountTrue(d, thin);
    gathered.num_others += hn::CountTrue(d, hn::AndNot(thin, there));
  }
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
  const Lanes per_step = hn::Div(hn::Set(d, 1.0f), at_depth(d, lines.step, z));
  const Lanes middle = hn::Mul(hn::Sub(center, at_depth(d, lines.first, z)), per_step);
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
    const DepthLanes slope = hn::Set(d, gathered.minus_inverse_radius_sq[k]);
    const DepthLanes peak = hn::Set(d, gathered.peak[k]);
    const auto share = [&](DepthLanes distance_sq) MOTES_INLINE HWY_ATTR {
      return share_of<typename C::Shape>(d, slope, distance_sq);
    };
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
    const int columns = C::Shape::is_product ? kColumns : kernel.box.columns();
    for (int i = 0; i < columns; ++i) {
      const DepthLanes x = place(planes.x, planes.dx, gathered.x[k], kernel.box.column + i);
      const DepthLanes of_column = share(hn::Mul(x, x));
      hn::Store(C::Shape::is_product ? hn::Mul(peak, of_column) : of_column, d, column[i]);
      if constexpr (C::gradients) hn::Store(hn::Mul(x, slope), d, column_slope[i]);
    }
    for (int i = 0; i < kernel.box.rows(); ++i) {
      const DepthLanes y = place(planes.y, planes.dy, gathered.y[k], kernel.box.row + i);
      hn::Store(share(hn::MulAdd(y, y, dz_sq)), d, row[i]);
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
    int columns, rows;
    float height;
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
      out.columns = kernel.box.columns();
      out.rows = kernel.box.rows();
      out.height = height_of<typename C::Shape>(gathered, kernel.kernel);
      out.factors.fill(d, gathered, samples.planes, kernel);
    }
  }
};

/// Calls each(i) for the columns of a thin kernel: kColumns of them or, if the shape is no product,
/// up to as many.
template <int kColumns, class C, class Each>
HWY_INLINE void for_columns(int columns, Each&& each) {
  if constexpr (C::Shape::is_product) {
    unroll<kColumns>(each);
  } else {
    for (int i = 0; i < columns; ++i) each(static_cast<std::size_t>(i));
  }
}

/// Adds thin kernels whose boxes have kColumns columns, or, as add_narrow_kernels(), up to as many.
template <int kColumns, class C>
HWY_NOINLINE void add_thin_kernels(const typename C::Shape& shape, const GatheredKernels& gathered,
                                   std::span<const BoxedKernel> list, const ColumnSamples& samples,
                                   EvaluationCounts& counts) {
  const DepthTag d;
  const std::size_t pixel_floats = samples.buffer.pixel_floats();
  const std::size_t row_floats = samples.buffer.row_floats();
  const typename C::Shape local = shape;
  ThinBatch<kColumns, C> batch;
  while (!list.empty()) {
    batch.fill(d, gathered, samples, list);
    for (std::size_t n = 0; n < batch.count; ++n) {
      const auto& kernel = batch.members[n];
      const DepthFactors<kColumns, C>& factors = kernel.factors;
      // What pixels have in common is kept in registers, which the compiler could not do by itself:
      // factors might be among the samples.
      const DepthLanes height = hn::Set(d, kernel.height);
      GradientSlopes<DepthLanes> slopes{height, height, height};
      if constexpr (C::gradients) slopes.z = hn::Load(d, factors.slope_z);
      float* first = kernel.samples;
      for (int j = 0; j < kernel.rows; ++j, first += row_floats) {
        const DepthLanes row = hn::Load(d, factors.row[j]);
        if constexpr (C::gradients) slopes.y = hn::Load(d, factors.row_slope[j]);
        float* pixel = first;
        for_columns<kColumns, C>(kernel.columns, [&](std::size_t i) MOTES_INLINE HWY_ATTR {
          if constexpr (C::gradients) slopes.x = hn::Load(d, factors.column_slope[i]);
          counts.inside_support += add_to_samples<C>(d, local, hn::Load(d, factors.column[i]), row,
                                                     height, slopes, pixel, ColumnBuffer::planes);
          pixel += pixel_floats;
        });
      }
      counts.carried_out += static_cast<std::uint64_t>(kernel.rows * kernel.columns * depth_lanes);
    }
  }
}

/// Adds thin kernels, all shapes of boxes in turn.
template <class C>
void sum_columns(const typename C::Shape& shape, const GatheredKernels& gathered,
                 const ThinKernels& kernels, const ColumnSamples& samples,
                 EvaluationCounts& counts) {
  if constexpr (C::Shape::is_product) {
    unroll<max_thin_pixels>([&](auto i) HWY_ATTR {
      const std::size_t first = i * max_thin_pixels;
      add_thin_kernels<i + 1, C>(shape, gathered, kernels.with_keys(first, first + max_thin_pixels),
                                 samples, counts);
    });
  } else {
    constexpr std::size_t all = std::size_t{max_thin_pixels} * max_thin_pixels;
    add_thin_kernels<max_thin_pixels, C>(shape, gathered, kernels.with_keys(0, all), samples,
                                         counts);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
