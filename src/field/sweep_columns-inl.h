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
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <type_traits>

#include "core/aligned.h"
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
inline constexpr int max_thin_pixels = 6;
/// So many pixels of a thin kernel take about as long as one plane of any kernel: measured, lit.
inline constexpr float thin_pixels_per_plane = 16;
/// Planes of a vector: not more than a thin kernel usually reaches, so that others are skipped.
using DepthTag = hn::CappedTag<float, 8>;
using DepthLanes = hn::Vec<DepthTag>;
inline constexpr int depth_lanes = static_cast<int>(hn::MaxLanes(DepthTag()));
inline constexpr std::uint32_t num_depths = ColumnBuffer::planes / depth_lanes;

/// Planes of a slab, an element each: see AreaPlane.
struct AreaPlanes {
  alignas(64) float x[ColumnBuffer::planes], dx[ColumnBuffer::planes];
  alignas(64) float y[ColumnBuffer::planes], dy[ColumnBuffer::planes];
  alignas(64) float z[ColumnBuffer::planes];
  int count = 0;
};

/// Planes `first` to first + count - 1 of the slab; those that are missing lie where no kernel
/// does.
inline AreaPlanes place_planes(const RayBounds& area, const SlabFrame& frame, int first,
                               int count) {
  AreaPlanes planes;
  planes.count = count;
  for (int k = 0; k < ColumnBuffer::planes; ++k) {
    const AreaPlane plane = place_plane(area, frame, first + std::min(k, count - 1));
    planes.x[k] = plane.x;
    planes.dx[k] = plane.dx;
    planes.y[k] = plane.y;
    planes.dy[k] = plane.dy;
    planes.z[k] = k < count ? plane.z : 1e10f;
  }
  return planes;
}

/// Pixels of an area that a kernel may reach.
struct PixelBox {
  std::uint8_t column, row, last_column, last_row;
};

/// Gathered kernels that reach but a few pixels; an element for each vector of planes that one
/// reaches.
struct ThinKernels {
  AlignedVector<std::uint32_t> kernel, box;
  AlignedVector<std::uint32_t> depth;  ///< which vector of planes
  std::size_t size = 0;

  PixelBox box_of(std::size_t i) const { return std::bit_cast<PixelBox>(box[i]); }
  /// Empties the list and makes room for `count`.
  void start(std::size_t count) {
    size = 0;
    if (count + max_lanes <= kernel.size()) return;
    for (auto* array : {&kernel, &box, &depth}) array->resize(2 * (count + max_lanes));
  }
  template <class V, class M>
  HWY_INLINE void append(V kernels, V boxes, std::uint32_t one_depth, M which) {
    const hn::RebindToUnsigned<LaneTag> du;
    hn::StoreU(hn::Compress(kernels, which), du, kernel.data() + size);
    hn::StoreU(hn::Compress(boxes, which), du, box.data() + size);
    hn::StoreU(hn::Set(du, one_depth), du, depth.data() + size);
    size += hn::CountTrue(du, which);
  }
};

/// Lists of thin kernels: those whose boxes fit so many pixels square.
inline constexpr std::array<int, 4> thin_sizes = {2, 3, 4, max_thin_pixels};
using ThinLists = std::array<ThinKernels, thin_sizes.size()>;

inline bool any_kernel(const ThinLists& lists) {
  return std::any_of(lists.begin(), lists.end(), [](const ThinKernels& l) { return l.size != 0; });
}

/// First and last pixel along an axis that kernels may reach on any of the planes, not clipped.
struct PixelSpans {
  Lanes first, last;
};

/// `first`, `step`: place of pixel 0 and distance of pixels, at the first and at the last plane
/// that a kernel reaches.
HWY_INLINE PixelSpans pixel_spans(LaneTag d, Lanes center, Lanes support, const Lanes first[2],
                                  const Lanes step[2]) {
  const Lanes slack = hn::Set(d, 1e-3f);
  const Lanes near = hn::Div(hn::Sub(center, first[0]), step[0]);
  const Lanes far = hn::Div(hn::Sub(center, first[1]), step[1]);
  // Pixels lie closest on the first plane.
  const Lanes half = hn::Add(hn::Abs(hn::Div(support, step[0])), slack);
  return {hn::Ceil(hn::Sub(hn::Min(near, far), half)),
          hn::Floor(hn::Add(hn::Max(near, far), half))};
}

/// Finds the thin ones of the gathered kernels, and sets gathered.plane_support_sq to that of all
/// others that reach the planes, -1 for the rest. Returns how many of those there may be.
HWY_NOINLINE std::size_t find_thin_kernels(const AreaPlanes& planes, GatheredKernels& gathered,
                                           ThinLists& out) {
  const LaneTag d;
  const hn::RebindToSigned<LaneTag> di;
  const hn::RebindToUnsigned<LaneTag> du;
  for (ThinKernels& list : out) list.start(gathered.size * num_depths);
  std::size_t others = 0;
  const int last_plane = planes.count - 1;
  const float thickness = planes.z[last_plane] - planes.z[0];
  const Lanes near = hn::Set(d, planes.z[0]), far = hn::Set(d, planes.z[last_plane]);
  const Lanes per_depth = hn::Set(d, thickness > 0 ? 1 / thickness : 0.0f);
  const Lanes planes_per_depth = hn::Mul(per_depth, hn::Set(d, static_cast<float>(last_plane)));
  const Lanes end = hn::Set(d, static_cast<float>(AreaBuffer::size - 1));
  // A quantity that is linear in depth, at fraction t of the way from the first plane to the last.
  const auto at = [&](const float* values, Lanes t) HWY_ATTR {
    return hn::MulAdd(t, hn::Set(d, values[last_plane] - values[0]), hn::Set(d, values[0]));
  };
  for (std::size_t i = 0; i < gathered.size; i += num_lanes) {
    const Lanes support_sq = hn::Load(d, gathered.support_sq.data() + i);
    const Lanes support = hn::Sqrt(hn::Max(support_sq, hn::Zero(d)));
    const Lanes z = hn::Load(d, gathered.z.data() + i);
    const Lanes first_z = hn::Max(hn::Sub(z, support), near);
    const Lanes last_z = hn::Min(hn::Add(z, support), far);
    const LaneMask reaches =
        hn::And(hn::Ge(support_sq, hn::Zero(d)), hn::Le(hn::Max(first_z, near), last_z));
    const Lanes t[2] = {hn::Mul(hn::Sub(first_z, near), per_depth),
                        hn::Mul(hn::Sub(last_z, near), per_depth)};
    const Lanes x[2] = {at(planes.x, t[0]), at(planes.x, t[1])};
    const Lanes dx[2] = {at(planes.dx, t[0]), at(planes.dx, t[1])};
    const Lanes y[2] = {at(planes.y, t[0]), at(planes.y, t[1])};
    const Lanes dy[2] = {at(planes.dy, t[0]), at(planes.dy, t[1])};
    const PixelSpans columns = pixel_spans(d, hn::Load(d, gathered.x.data() + i), support, x, dx);
    const PixelSpans rows = pixel_spans(d, hn::Load(d, gathered.y.data() + i), support, y, dy);
    // Thin: what it costs pixel by pixel is less than plane by plane.
    const Lanes width = hn::Sub(columns.last, columns.first);
    const Lanes height = hn::Sub(rows.last, rows.first);
    const Lanes num_planes =
        hn::MulAdd(hn::Sub(last_z, first_z), planes_per_depth, hn::Set(d, 1.0f));
    const Lanes one = hn::Set(d, 1.0f), most = hn::Set(d, static_cast<float>(max_thin_pixels - 1));
    const LaneMask fits = hn::Le(hn::Max(width, height), most);
    const LaneMask pays = hn::Le(hn::Mul(hn::Add(width, one), hn::Add(height, one)),
                                 hn::Mul(num_planes, hn::Set(d, thin_pixels_per_plane)));
    const LaneMask thin = hn::And(reaches, hn::And(fits, pays));
    const LaneMask other = hn::AndNot(thin, reaches);
    hn::Store(hn::IfThenElse(other, support_sq, hn::Set(d, -1.0f)), d,
              gathered.plane_support_sq.data() + i);
    others += hn::CountTrue(d, other);

    const auto whole = [&](Lanes v) HWY_ATTR { return hn::BitCast(du, hn::ConvertTo(di, v)); };
    const Lanes first_column = hn::Max(columns.first, hn::Zero(d));
    const Lanes last_column = hn::Min(columns.last, end);
    const Lanes first_row = hn::Max(rows.first, hn::Zero(d)), last_row = hn::Min(rows.last, end);
    const LaneMask in_area =
        hn::And(hn::Le(first_column, last_column), hn::Le(first_row, last_row));
    const auto listed = hn::RebindMask(du, hn::And(thin, in_area));
    const auto box =
        hn::Or(hn::Or(whole(first_column), hn::ShiftLeft<8>(whole(first_row))),
               hn::Or(hn::ShiftLeft<16>(whole(last_column)), hn::ShiftLeft<24>(whole(last_row))));
    const Lanes last_number = hn::Set(d, static_cast<float>(last_plane));
    const Lanes first = hn::Mul(t[0], last_number), last = hn::Mul(t[1], last_number);
    const auto kernel = numbers_from(static_cast<std::uint32_t>(i));
    const Lanes size = hn::Add(hn::Max(width, height), one), rounding = hn::Set(d, 1e-3f);
    for (std::uint32_t depth = 0; depth < num_depths; ++depth) {
      const auto begin = static_cast<float>(depth * depth_lanes);
      const LaneMask in_depth =
          hn::And(hn::Le(hn::Sub(first, rounding), hn::Set(d, begin + depth_lanes - 1)),
                  hn::Ge(hn::Add(last, rounding), hn::Set(d, begin)));
      const auto here = hn::And(listed, hn::RebindMask(du, in_depth));
      float above = 0;
      for (std::size_t l = 0; l < out.size(); ++l) {
        const auto most_pixels = static_cast<float>(thin_sizes[l]);
        const LaneMask fits_list =
            hn::And(hn::Gt(size, hn::Set(d, above)), hn::Le(size, hn::Set(d, most_pixels)));
        out[l].append(kernel, box, depth, hn::And(here, hn::RebindMask(du, fits_list)));
        above = most_pixels;
      }
    }
  }
  return others;
}

/// A kernel's factors in a vector of planes, one for each column and row of its box.
template <int kSize, class C>
struct DepthFactors {
  alignas(64) float column[kSize][depth_lanes], row[kSize][depth_lanes];
  alignas(64) float column_slope[C::gradients ? kSize : 1][depth_lanes];
  alignas(64) float row_slope[C::gradients ? kSize : 1][depth_lanes];
  alignas(64) float slope_z[depth_lanes];

  /// Those of a vector of planes, the one that begins at plane `v`.
  HWY_INLINE void fill(DepthTag d, const GatheredKernels& gathered, std::size_t k,
                       const AreaPlanes& planes, const PixelBox& box, int v) {
    const DepthLanes scale = hn::Set(d, gathered.exponent_scale[k]);
    const DepthLanes peak = hn::Set(d, gathered.peak[k]);
    const DepthLanes slope = hn::Mul(scale, hn::Set(d, 2 / std::numbers::log2e_v<float>));
    const DepthLanes dz = hn::Sub(hn::Load(d, planes.z + v), hn::Set(d, gathered.z[k]));
    const DepthLanes dz_sq = hn::Mul(dz, dz);
    if constexpr (C::gradients) hn::Store(hn::Mul(dz, slope), d, slope_z);
    const auto place = [&](const float* first, const float* step, float center,
                           int pixel) MOTES_INLINE HWY_ATTR {
      const DepthLanes from_first = hn::Sub(hn::Load(d, first + v), hn::Set(d, center));
      return hn::MulAdd(hn::Set(d, static_cast<float>(pixel)), hn::Load(d, step + v), from_first);
    };
    for (int i = 0; i < kSize; ++i) {
      const DepthLanes x = place(planes.x, planes.dx, gathered.x[k], box.column + i);
      hn::Store(hn::Mul(peak, factor_of(d, hn::Mul(scale, hn::Mul(x, x)))), d, column[i]);
      if constexpr (C::gradients) hn::Store(hn::Mul(x, slope), d, column_slope[i]);
    }
    for (int i = 0; i < kSize; ++i) {
      const DepthLanes y = place(planes.y, planes.dy, gathered.y[k], box.row + i);
      hn::Store(factor_of(d, hn::Mul(scale, hn::MulAdd(y, y, dz_sq))), d, row[i]);
      if constexpr (C::gradients) hn::Store(hn::Mul(y, slope), d, row_slope[i]);
    }
  }
};

/// Adds a kernel to a vector of planes of the pixel in column `i` and row `j` of its box; `samples`
/// is the field's channel 0 there. Returns how many samples lie inside of the support, if C::count.
template <int kSize, class C>
HWY_INLINE std::uint64_t add_to_pixel(DepthTag d, const DepthFactors<kSize, C>& factors,
                                      DepthLanes cut, int i, int j, float* samples) {
  const DepthLanes p = hn::Mul(hn::Load(d, factors.column[i]), hn::Load(d, factors.row[j]));
  const DepthLanes magnitude = hn::Abs(p);
  const auto inside = hn::Ge(magnitude, cut);
  hn::Store(add_inside(d, inside, p, hn::Load(d, samples)), d, samples);
  if constexpr (C::gradients) {
    const DepthLanes phi = hn::IfThenElseZero(inside, p);
    const auto add = [&](int channel, const float* slope) MOTES_INLINE HWY_ATTR {
      float* const gradient = samples + channel * depth_lanes;
      hn::Store(hn::MulAdd(phi, hn::Load(d, slope), hn::Load(d, gradient)), d, gradient);
    };
    add(1, factors.column_slope[i]);
    add(2, factors.row_slope[j]);
    add(3, factors.slope_z);
  }
  if constexpr (C::absolute) {
    float* const absolute = samples + 4 * depth_lanes;
    hn::Store(add_inside(d, inside, magnitude, hn::Load(d, absolute)), d, absolute);
  }
  return C::count ? hn::CountTrue(d, inside) : 0;
}

/// Adds thin kernels to the planes of `buffer`, all of them to kSize x kSize pixels: no branch
/// depends on the box.
template <int kSize, class C>
HWY_NOINLINE void add_thin_kernels(const GatheredKernels& gathered, const ThinKernels& list,
                                   const AreaPlanes& planes, const LiveGroups& live,
                                   const SampleLayout& layout, ColumnBuffer& buffer,
                                   EvaluationCounts& counts) {
  const DepthTag d;
  const std::size_t field_floats = static_cast<std::size_t>(layout.channels()) * depth_lanes;
  const std::size_t depth_floats = field_floats * static_cast<std::size_t>(layout.num_fields);
  for (std::size_t n = 0; n < list.size; ++n) {
    const PixelBox box = list.box_of(n);
    const int first_row = box.row / AreaBuffer::group_size;
    const int last_row = box.last_row / AreaBuffer::group_size;
    const GroupBits groups = (2u << box.last_column / AreaBuffer::group_size) -
                             (1u << box.column / AreaBuffer::group_size);
    static_assert(max_thin_pixels <= 2 * AreaBuffer::group_size);
    const int middle_row = (first_row + last_row) / 2;  // so at most three, without a loop
    if (((live.row(first_row) | live.row(middle_row) | live.row(last_row)) & groups) == 0) continue;
    for (const int row : {first_row, middle_row, last_row}) buffer.touched(row) |= groups;
    const std::size_t k = list.kernel[n], depth = list.depth[n];
    const DepthLanes cut = hn::Set(d, gathered.cut[k]);
    DepthFactors<kSize, C> factors;
    factors.fill(d, gathered, k, planes, box, static_cast<int>(depth) * depth_lanes);
    float* row_samples =
        buffer.at(box.row, box.column) + depth * depth_floats + gathered.field[k] * field_floats;
    for (int j = 0; j < kSize; ++j, row_samples += buffer.row_floats()) {
      float* samples = row_samples;
      for (int i = 0; i < kSize; ++i, samples += buffer.pixel_floats()) {
        counts.inside_support += add_to_pixel(d, factors, cut, i, j, samples);
      }
    }
    counts.carried_out += std::uint64_t{kSize * kSize * depth_lanes};
  }
}

/// Adds all thin kernels to the planes of `buffer`.
template <class C>
void sum_columns(const GatheredKernels& gathered, const ThinLists& lists, const AreaPlanes& planes,
                 const LiveGroups& live, const SampleLayout& layout, ColumnBuffer& buffer,
                 EvaluationCounts& counts) {
  unroll<thin_sizes.size()>([&]<std::size_t kList>(std::integral_constant<std::size_t, kList>) {
    add_thin_kernels<thin_sizes[kList], C>(gathered, lists[kList], planes, live, layout, buffer,
                                           counts);
  });
}

/// num_lanes vectors become their transpose.
HWY_INLINE void transpose_block(LaneTag d, Lanes (&v)[num_lanes]) {
  for (int y = 0; y < num_lanes; y += 4) {
    transpose_fours(d, v[y], v[y + 1], v[y + 2], v[y + 3]);
  }
  // Vector 4 y + j now has, in its 128 bits q, the numbers 4 q + j of vectors 4 y to 4 y + 3.
#if HWY_TARGET <= HWY_AVX3
  static_assert(num_lanes == 16);
  constexpr int even = _MM_SHUFFLE(2, 0, 2, 0), odd = _MM_SHUFFLE(3, 1, 3, 1);
  for (int j = 0; j < 4; ++j) {
    const Lanes low = hn::ConcatLowerLower(d, v[4 + j], v[j]);
    const Lanes high = hn::ConcatUpperUpper(d, v[4 + j], v[j]);
    const Lanes low2 = hn::ConcatLowerLower(d, v[12 + j], v[8 + j]);
    const Lanes high2 = hn::ConcatUpperUpper(d, v[12 + j], v[8 + j]);
    v[j] = Lanes{_mm512_shuffle_f32x4(low.raw, low2.raw, even)};
    v[4 + j] = Lanes{_mm512_shuffle_f32x4(low.raw, low2.raw, odd)};
    v[8 + j] = Lanes{_mm512_shuffle_f32x4(high.raw, high2.raw, even)};
    v[12 + j] = Lanes{_mm512_shuffle_f32x4(high.raw, high2.raw, odd)};
  }
#elif HWY_TARGET <= HWY_AVX2
  static_assert(num_lanes == 8);
  for (int j = 0; j < 4; ++j) {
    const Lanes low = hn::ConcatLowerLower(d, v[4 + j], v[j]);
    v[4 + j] = hn::ConcatUpperUpper(d, v[4 + j], v[j]);
    v[j] = low;
  }
#endif
}

/// Moves what a group of pixels holds in `columns`, which is zero there afterwards, to `num_planes`
/// planes of the area, where nothing else may be yet. Planes without any kernel stay untouched.
HWY_NOINLINE void move_group(ColumnBuffer& columns, int row, int column, int num_planes,
                             const SampleLayout& layout, AreaBuffer& area) {
  constexpr int size = AreaBuffer::group_size;
  const LaneTag d;
  const int num_channels = layout.num_fields * layout.channels();
  AreaBuffer::PlaneBits* const touched = area.touched(row, column);
  for (int block = 0; block < group_blocks; ++block) {
    float* const out = area.at(row, column) + static_cast<std::size_t>(block) * area.block_floats();
    float* const first = columns.at(size * row + block * block_rows, size * column);
    const int num_floats = num_channels * ColumnBuffer::planes;
    for (int at = 0; at < num_floats; at += num_lanes) {
      Lanes v[num_lanes];
      for (int pixel = 0; pixel < num_lanes; ++pixel) {
        float* const in = first + static_cast<std::size_t>(pixel / size) * columns.row_floats() +
                          static_cast<std::size_t>(pixel % size) * columns.pixel_floats() + at;
        v[pixel] = hn::Load(d, in);
        hn::Store(hn::Zero(d), d, in);
      }
      transpose_block(d, v);
      // Planes of one channel or, where vectors of planes are shorter, of some in turn.
      for (int part = 0; part < num_lanes / depth_lanes; ++part) {
        const int unit = at / depth_lanes + part;
        const int channel = unit % num_channels, plane = unit / num_channels * depth_lanes;
        AreaBuffer::PlaneBits any = 0;
        float* to =
            out + static_cast<std::size_t>(plane) * area.plane_floats() + channel * num_lanes;
        for (int k = 0; k < std::min(depth_lanes, num_planes - plane); ++k) {
          const Lanes values = v[part * depth_lanes + k];
          hn::Store(values, d, to);
          to += area.plane_floats();
          any |= (hn::AllTrue(d, hn::Eq(values, hn::Zero(d))) ? 0u : 1u) << k;
        }
        touched[channel / layout.channels()] |= any << plane;
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
